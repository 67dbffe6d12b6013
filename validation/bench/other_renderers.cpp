#include "validation/bench/other_renderers.h"

#include <cmath>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/table.h"
#include "io/text.h"

namespace abbe {
namespace {

// The result in a row of the table. Reports errors, and is empty if there is one.
std::optional<OtherRendererResult> read_result(const Table& table, std::size_t row,
                                               Diagnostics& diagnostics) {
  const auto cell = [&](const char* column) -> std::string {
    const std::optional<std::size_t> at = table.column(column);
    return at ? table.rows[row][*at] : "";
  };
  const auto number = [&](const char* column) {
    const std::optional<double> value = parse_number(cell(column));
    if (!value || !(*value > 0))
      diagnostics.error(table.position(row),
                        fmt::format("{}: got \"{}\", allowed numbers above 0", column, cell(column)),
                        ErrorCode::input);
    return value.value_or(1);
  };
  OtherRendererResult other{cell("suite"), cell("rival"), cell("setting"), 0, 0, std::nullopt, 0, 0};
  other.samples = static_cast<int>(number("samples"));
  other.cpu_s = number("cpu_s");
  if (!cell("nrmse").empty()) other.nrmse = number("nrmse");
  other.relrmse = number("relrmse");
  other.floor = number("floor");
  if (other.floor != kUsualFloor && other.floor != kLowFloor)
    diagnostics.error(table.position(row),
                      fmt::format("floor: got {}, allowed {} or {}", other.floor, kUsualFloor, kLowFloor),
                      ErrorCode::input);
  return diagnostics.has_errors() ? std::nullopt : std::optional(other);
}

}  // namespace

std::vector<OtherRendererResult> load_other_renderers() {
  Diagnostics diagnostics;
  const std::optional<Table> table =
      read_table(data_directory() / "bench" / "rivals.csv", TableOrigin::shipped, diagnostics);
  std::vector<OtherRendererResult> other_renderers;
  for (std::size_t row = 0; table && row < table->rows.size(); ++row)
    if (auto other = read_result(*table, row, diagnostics)) other_renderers.push_back(std::move(*other));
  if (diagnostics.has_errors()) throw Error(ErrorCode::input, "rivals", diagnostics.text());
  return other_renderers;
}

std::vector<CurvePoint> error_curve(const std::vector<BenchRow>& rows, double floor) {
  std::vector<CurvePoint> curve;
  for (const BenchRow& mean : means_over_seeds(rows)) {
    const double error = root_of(floor == kLowFloor ? mean.rel_mse_low : mean.rel_mse);
    if (error > 0) curve.push_back({mean.cpu_s, error});
  }
  return curve;
}

std::optional<TimeAtError> time_at_error(std::span<const CurvePoint> curve, double error) {
  if (curve.empty()) return std::nullopt;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const CurvePoint& a = curve[i - 1];
    const CurvePoint& b = curve[i];
    if ((a.error - error) * (b.error - error) > 0 || a.error == b.error) continue;
    const double t = std::log(error / a.error) / std::log(b.error / a.error);
    const double log_a = std::log(a.cpu_s);
    return TimeAtError{std::exp(log_a + t * (std::log(b.cpu_s) - log_a)), false};
  }
  const CurvePoint& end = error > curve.front().error ? curve.front() : curve.back();
  return TimeAtError{end.cpu_s * std::pow(end.error / error, 2), end.error != error};
}

std::vector<EqualError> equal_errors(const SuiteRun& run,
                                     std::span<const OtherRendererResult> other_renderers) {
  std::vector<EqualError> all;
  for (const OtherRendererResult& other : other_renderers) {
    if (other.suite != run.suite.name) continue;
    const std::vector<BenchRow> rows = rows_of(run.rows, run.integrators.front().integrator);
    if (const auto time = time_at_error(error_curve(rows, other.floor), other.relrmse))
      all.push_back({other, *time});
  }
  return all;
}

}  // namespace abbe
