#include "validation/bench/baseline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/json_values.h"
#include "io/text.h"
#include "validation/statistics/students_interval.h"

namespace abbe {
namespace {

constexpr double kSignificance = 0.01;
constexpr double kLeastChange = 0.02;

const JsonValue::Array* array_at(const JsonValue& json, const char* key, Diagnostics& diagnostics) {
  const JsonValue* member = json.find(key);
  const auto* array = member ? std::get_if<JsonValue::Array>(&member->value) : nullptr;
  if (array == nullptr)
    diagnostics.error(json.where, std::string("expected an array \"") + key + "\", as abbe bench writes it",
                      ErrorCode::input);
  return array;
}

double number_at(const JsonValue& json, const char* key, Diagnostics& diagnostics) {
  const JsonValue* member = json.find(key);
  const double* number = member ? std::get_if<double>(&member->value) : nullptr;
  if (number == nullptr)
    diagnostics.error(json.where, std::string("expected a number \"") + key + "\"", ErrorCode::input);
  return number ? *number : 0;
}

BaselineRow read_row(const std::string& suite, const JsonValue& json, Diagnostics& diagnostics) {
  const auto number = [&](const char* key) { return number_at(json, key, diagnostics); };
  const JsonValue* integrator = json.find("integrator");
  return {suite,
          integrator ? read_string(*integrator, diagnostics).value_or("")
                     : integrator_name(Integrator::automatic),
          static_cast<int>(number("spp")),
          static_cast<std::uint64_t>(number("seed")),
          number("cpu_s"),
          number("paths"),
          number("relMSE")};
}

Ratio geometric_mean(const std::vector<double>& logs) {
  const auto n = static_cast<double>(logs.size());
  double mean = 0;
  for (const double l : logs) mean += l / n;
  double squares = 0;
  for (const double l : logs) squares += (l - mean) * (l - mean);
  if (logs.size() < 2) return {std::exp(mean), std::numeric_limits<double>::infinity()};
  return {std::exp(mean),
          std::expm1(half_interval(std::sqrt(squares / (n - 1) / n), n - 1, 1 - kSignificance))};
}

}  // namespace

bool Ratio::changed() const {
  const double size = std::expm1(std::abs(std::log(value)));
  return size > noise && size > kLeastChange;
}

std::optional<std::vector<BaselineRow>> load_baseline(const std::filesystem::path& path,
                                                      Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  std::vector<BaselineRow> rows;
  const auto* suites = array_at(*root, "suites", diagnostics);
  for (std::size_t i = 0; suites && i < suites->size(); ++i) {
    const JsonValue& suite = (*suites)[i];
    const JsonValue* name = suite.find("name");
    const std::string text = name ? read_string(*name, diagnostics).value_or("") : "";
    if (const auto* found = array_at(suite, "rows", diagnostics))
      for (const JsonValue& row : *found) rows.push_back(read_row(text, row, diagnostics));
  }
  if (diagnostics.has_errors()) return std::nullopt;
  return rows;
}

std::vector<BaselineRow> baseline_rows(std::span<const SuiteRun> runs) {
  std::vector<BaselineRow> rows;
  for (const SuiteRun& run : runs)
    for (const BenchRow& row : run.rows)
      rows.push_back({run.suite.name, integrator_name(row.integrator), row.samples, row.seed, row.cpu_s,
                      static_cast<double>(row.paths), row.rel_mse});
  return rows;
}

std::vector<Change> compare_runs(std::span<const BaselineRow> before, std::span<const BaselineRow> after) {
  using Subject = std::pair<std::string, std::string>;  // a suite by an integrator
  const auto subject_of = [](const BaselineRow& row) { return Subject(row.suite, row.integrator); };
  std::vector<Subject> subjects;
  for (const BaselineRow& row : after)
    if (std::find(subjects.begin(), subjects.end(), subject_of(row)) == subjects.end())
      subjects.push_back(subject_of(row));
  std::vector<Change> changes;
  for (const Subject& subject : subjects) {
    std::vector<double> times;
    std::vector<double> errors;
    for (const BaselineRow& now : after) {
      const auto then = std::find_if(before.begin(), before.end(), [&](const BaselineRow& row) {
        return subject_of(row) == subject && subject_of(now) == subject && row.samples == now.samples &&
               row.seed == now.seed;
      });
      if (then == before.end()) continue;
      times.push_back(std::log(now.cpu_s / now.paths) - std::log(then->cpu_s / then->paths));
      if (now.rel_mse > 0 && then->rel_mse > 0) errors.push_back(std::log(now.rel_mse / then->rel_mse));
    }
    if (!times.empty())
      changes.push_back(
          {subject.first, subject.second, times.size(), geometric_mean(times), geometric_mean(errors)});
  }
  return changes;
}

}  // namespace abbe
