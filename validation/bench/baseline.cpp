#include "validation/bench/baseline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/text.h"
#include "validation/statistics.h"

namespace abbe {
namespace {

constexpr double kSignificance = 0.01;
constexpr double kMinChange = 0.02;

// The member of type T; `kind` describes it in the error that is reported if there is none. Null then.
template <typename T>
const T* member_at(const JsonValue& json, const char* key, const char* kind, Diagnostics& diagnostics) {
  const JsonValue* member = json.find(key);
  const T* value = member ? std::get_if<T>(&member->value) : nullptr;
  if (value == nullptr)
    diagnostics.error(json.where, fmt::format("expected {} \"{}\", as abbe bench writes it", kind, key),
                      ErrorCode::input);
  return value;
}

const JsonValue::Array* array_at(const JsonValue& json, const char* key, Diagnostics& diagnostics) {
  return member_at<JsonValue::Array>(json, key, "an array", diagnostics);
}

double number_at(const JsonValue& json, const char* key, Diagnostics& diagnostics) {
  const double* number = member_at<double>(json, key, "a number", diagnostics);
  return number ? *number : 0;
}

std::string string_at(const JsonValue& json, const char* key, Diagnostics& diagnostics) {
  const auto* text = member_at<std::string>(json, key, "a string", diagnostics);
  return text ? *text : "";
}

// Numbers outside the range of int are clamped; no run has such counts.
int count(double number) {
  return static_cast<int>(std::clamp<double>(number, 0, std::numeric_limits<int>::max()));
}

// Width and height of the film; 0 if the file has no number.
std::array<int, 2> resolution_at(const JsonValue& suite, Diagnostics& diagnostics) {
  std::array<int, 2> edges{};
  const JsonValue::Array* entries = array_at(suite, "resolution", diagnostics);
  for (std::size_t i = 0; entries && i < std::min(entries->size(), edges.size()); ++i)
    if (const double* number = std::get_if<double>(&(*entries)[i].value)) edges[i] = count(*number);
  return edges;
}

BaselineSuite read_suite(const JsonValue& json, int threads, Diagnostics& diagnostics) {
  const auto [width, height] = resolution_at(json, diagnostics);
  return {string_at(json, "name", diagnostics),
          {width, height, string_at(json, "scene_sha256", diagnostics),
           count(number_at(json, "reference_spp", diagnostics)), threads},
          json.where};
}

BaselineRow read_row(const std::string& suite, const JsonValue& json, Diagnostics& diagnostics) {
  const auto number = [&](const char* key) { return number_at(json, key, diagnostics); };
  return {suite,
          json.find("integrator") ? string_at(json, "integrator", diagnostics)
                                  : integrator_name(Integrator::automatic),
          count(number("spp")),
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

// The differing conditions, by the names of a `bench.json`.
std::vector<std::string> differences(const BenchConditions& then, const BenchConditions& now) {
  std::vector<std::string> all;
  const auto compare = [&all](std::string_view name, const auto& got, const auto& allowed) {
    if (got != allowed) all.push_back(fmt::format("{} (got {}, allowed {})", name, got, allowed));
  };
  const auto resolution = [](const BenchConditions& of) { return fmt::format("{}x{}", of.width, of.height); };
  compare("resolution", resolution(then), resolution(now));
  compare("scene_sha256", then.scene_sha256, now.scene_sha256);
  compare("reference_spp", then.reference_samples, now.reference_samples);
  compare("threads", then.threads, now.threads);
  return all;
}

}  // namespace

bool Ratio::changed() const {
  const double size = std::expm1(std::abs(std::log(value)));
  return size > noise && size > kMinChange;
}

std::optional<Baseline> load_baseline(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  Baseline baseline;
  const int threads = count(number_at(*root, "threads", diagnostics));
  const auto* suites = array_at(*root, "suites", diagnostics);
  for (std::size_t i = 0; suites && i < suites->size(); ++i) {
    const JsonValue& suite = (*suites)[i];
    baseline.suites.push_back(read_suite(suite, threads, diagnostics));
    if (const auto* entries = array_at(suite, "rows", diagnostics))
      for (const JsonValue& row : *entries)
        baseline.rows.push_back(read_row(baseline.suites.back().name, row, diagnostics));
  }
  if (diagnostics.has_errors()) return std::nullopt;
  return baseline;
}

void require_comparable(const BaselineSuite& then, const BenchConditions& now, Diagnostics& diagnostics) {
  const std::vector<std::string> different = differences(then.conditions, now);
  if (different.empty()) return;
  diagnostics.error(then.where,
                    fmt::format("suite {} cannot be compared with this run, since its conditions differ: {}",
                                then.name, fmt::join(different, ", ")),
                    ErrorCode::input);
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
  using Subject = std::pair<std::string, std::string>;  // suite and integrator
  const auto subject_of = [](const BaselineRow& row) { return Subject(row.suite, row.integrator); };
  std::vector<Subject> subjects;
  for (const BaselineRow& row : after)
    if (std::ranges::find(subjects, subject_of(row)) == subjects.end()) subjects.push_back(subject_of(row));
  std::vector<Change> changes;
  for (const Subject& subject : subjects) {
    std::vector<double> times;
    std::vector<double> errors;
    for (const BaselineRow& now : after) {
      const auto then = std::ranges::find_if(before, [&](const BaselineRow& row) {
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
