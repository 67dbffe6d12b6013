// A validation run, and its report in plain text and as JSON.
#include "validation/report/report.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/data_directory.h"
#include "report/svg.h"

namespace abbe {
namespace {

// Outcomes of the suite `techniques` as a table, with a row for each film and a column for each of
// `kIntegratorNames`. It refers to the outcomes.
struct TechniqueMatrix {
  struct Row {
    std::string film;                   ///< Id of the film's case.
    std::vector<const Outcome*> cells;  ///< Null if the run did not include it.
  };
  std::vector<Row> rows;
  /// Path classes that cells cannot sample, each once. Notes number them from 1.
  std::vector<PathClass> unsampled;
};

// Number of a note, counted from 1.
std::size_t number_of(const TechniqueMatrix& matrix, const PathClass& path_class) {
  const auto found = std::ranges::find(matrix.unsampled, path_class);
  return static_cast<std::size_t>(found - matrix.unsampled.begin()) + 1;
}

template <typename Visit>
void for_each_failure(const TechniqueMatrix& matrix, Visit visit) {
  for (const TechniqueMatrix::Row& row : matrix.rows)
    for (const Outcome* cell : row.cells)
      if (cell != nullptr && !cell->result.passed()) visit(*cell);
}

// Cells of a film must be consecutive.
TechniqueMatrix technique_matrix(const std::vector<Outcome>& outcomes) {
  TechniqueMatrix matrix;
  for (const Outcome& outcome : outcomes) {
    const auto* cell = std::get_if<TechniqueMean>(&outcome.item->method);
    if (cell == nullptr) continue;
    if (matrix.rows.empty() || matrix.rows.back().film != cell->case_id)
      matrix.rows.push_back({cell->case_id, std::vector<const Outcome*>(kIntegratorNames.size())});
    matrix.rows.back().cells.at(static_cast<std::size_t>(cell->integrator)) = &outcome;
    for (const PathClass& path_class : outcome.result.unsampled)
      if (number_of(matrix, path_class) > matrix.unsampled.size()) matrix.unsampled.push_back(path_class);
  }
  return matrix;
}

// Signed deviation in per cent of the reference, such as "+0.31", after the verdict unless the cell passes;
// "lost" with the numbers of its notes for a cell that was not measured; a dash for none.
std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell) {
  if (cell == nullptr) return "–";
  std::string numbers;
  for (const PathClass& path_class : cell->result.unsampled)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number_of(matrix, path_class));
  if (!numbers.empty()) return "lost " + numbers;
  const std::string verdict = cell->result.passed() ? "" : verdict_name(cell->result.verdict) + " ";
  if (cell->result.figures.empty()) return verdict + "no figures";
  const Figure& figure = cell->result.figures.front();
  return fmt::format("{}{:+.2f}", verdict, 100 * figure.deviation() / figure.reference);
}

std::string failure_text(const Outcome& cell) {
  const CaseResult& result = cell.result;
  std::string owned;
  for (const std::string& paths : result.owned) owned += (owned.empty() ? "" : "; ") + paths;
  const std::string deviation =
      result.figures.empty()
          ? "no figures"
          : fmt::format("{:+.3f} ± {:.3f} % of ± {:g} %",
                        100 * result.figures.front().deviation() / result.figures.front().reference,
                        100 * kInterval * result.figures.front().measured.standard_error /
                            result.figures.front().reference,
                        100 * result.margin.value);
  return fmt::format("{} {}: {}, of the paths {}", verdict_name(result.verdict), cell.item->id, deviation,
                     owned);
}

// The table in Markdown, with notes and failures; empty for a matrix without rows.
std::string matrix_text(const TechniqueMatrix& matrix) {
  if (matrix.rows.empty()) return "";
  std::string all = "| film |";
  std::string rule = "\n| --- |";
  for (const char* name : kIntegratorNames) {
    all += fmt::format(" {} |", name);
    rule += " --- |";
  }
  all += rule + "\n";
  for (const TechniqueMatrix::Row& row : matrix.rows) {
    all += fmt::format("| {} |", row.film);
    for (const Outcome* cell : row.cells) all += fmt::format(" {} |", cell_text(matrix, cell));
    all += "\n";
  }
  if (!matrix.unsampled.empty()) all += "\n";
  for (std::size_t i = 0; i < matrix.unsampled.size(); ++i)
    all += fmt::format("{}. `{}\n", i + 1,
                       std::string(matrix.unsampled[i]).replace(matrix.unsampled[i].find(':'), 1, "`:"));
  for_each_failure(matrix, [&](const Outcome& cell) { all += failure_text(cell) + "\n"; });
  return all;
}

// True if the settings select the case. A quick run of all suites includes only a few cells of the matrix.
bool is_selected(const Case& item, const ValidationSettings& settings) {
  const std::vector<Suite>& suites = settings.suites;
  if (!suites.empty() && std::ranges::find(suites, item.suite) == suites.end()) return false;
  const auto* cell = std::get_if<TechniqueMean>(&item.method);
  if (cell == nullptr || cell->tier == Tier::quick) return true;
  return cell->tier != Tier::never && (!settings.quick || !suites.empty());
}

using Json = nlohmann::ordered_json;

std::string line_of(const Outcome& outcome) {
  const CaseResult& result = outcome.result;
  if (result.figures.empty()) return fmt::format("{:<18} no figures  FAIL\n", outcome.item->id);
  const Figure& worst = result.figures[result.worst];
  const auto [deviation, margin] = deviation_text(outcome, worst);
  return fmt::format("{:<18} {:>5} {:>15.8g} {:>15.8g} {:>10} {:>17} {:>8.0f}% {:>7.2f}  {}\n",
                     outcome.item->id, result.figures.size(), worst.measured.mean, worst.reference, deviation,
                     "± " + margin, 100 * worst_margin_ratio(result), result.cpu_s,
                     verdict_name(result.verdict));
}

Json figure_json(const CaseResult& result, const Figure& figure) {
  return {{"what", figure.what},
          {"reference", figure.reference},
          {"measured", figure.measured.mean},
          {"standard_error", figure.measured.standard_error},
          {"deviation", figure.deviation()},
          {"allowed", result.allowed(figure)}};
}

Json outcome_json(const Outcome& outcome) {
  const CaseResult& result = outcome.result;
  Json json{{"suite", suite_name(outcome.item->suite)},
            {"id", outcome.item->id},
            {"title", outcome.item->title},
            {"source", outcome.item->source},
            {"unit", outcome.item->unit},
            {"passed", result.passed()},
            {"verdict", verdict_name(result.verdict)},
            {"worst_share_of_margin", worst_margin_ratio(result)},
            {"samples_per_pixel", result.samples},
            {"cpu_s", result.cpu_s},
            {"figures", Json::array()},
            {"remarks", Json::array()},
            {"unreached", result.unsampled}};
  if (const auto* cell = std::get_if<TechniqueMean>(&outcome.item->method)) {
    json["film"] = cell->case_id;
    json["technique"] = kIntegratorNames.at(static_cast<std::size_t>(cell->integrator));
    json["paths"] = result.owned;
  }
  for (const Figure& figure : result.figures) json["figures"].push_back(figure_json(result, figure));
  for (const Remark& remark : result.remarks)
    json["remarks"].push_back({{"what", remark.what}, {"value", remark.value}});
  return json;
}

}  // namespace

std::string suite_name(Suite suite) {
  return kSuiteNames.at(static_cast<std::size_t>(suite));
}

std::string verdict_name(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "FAIL" : "UNDECIDED";
}

double worst_margin_ratio(const CaseResult& result) {
  if (!result.measured()) return 0;
  if (result.figures.empty()) return INFINITY;
  const Figure& worst = result.figures[result.worst];
  return std::abs(worst.deviation()) / result.allowed(worst);
}

DeviationText deviation_text(const Outcome& outcome, const Figure& figure) {
  constexpr double kMinPercent = 1e-4;  // smaller margins are printed as fractions
  const Margin margin = figure.margin.value_or(outcome.result.margin);
  if (margin.kind == Margin::Kind::absolute)
    return {
        fmt::format("{:.2g}", figure.deviation()),
        fmt::format("{:.2g}{}{}", margin.value, outcome.item->unit.empty() ? "" : " ", outcome.item->unit)};
  const double relative = figure.deviation() / std::abs(figure.reference);
  if (margin.value < kMinPercent)
    return {fmt::format("{:.2g}", relative), fmt::format("{:.2g} relative", margin.value)};
  return {fmt::format("{:.2g} %", 100 * relative), fmt::format("{:g} %", 100 * margin.value)};
}

ChartSummary chart_summary(const CaseResult& result) {
  ChartSummary summary{result.figures.at(0).measured.mean, 0};
  for (std::size_t i = 1; i < result.figures.size(); ++i)
    summary.worst = std::max(summary.worst, result.figures[i].measured.mean);
  return summary;
}

std::string chart_table(const std::vector<Outcome>& outcomes) {
  std::string head = "| ΔE2000 |";
  std::string rule = "| --- |";
  std::string means = "| mean of 24 patches |";
  std::string worst = "| worst patch |";
  bool empty = true;
  for (const Outcome& outcome : outcomes) {
    const auto* chart = std::get_if<RenderedChart>(&outcome.item->method);
    if (chart == nullptr) continue;
    empty = false;
    const ChartSummary summary = chart_summary(outcome.result);
    head += fmt::format(" {} |", chart->illuminant);
    rule += " --- |";
    means += fmt::format(" {:.3f} |", summary.mean);
    worst += fmt::format(" {:.3f} |", summary.worst);
  }
  return empty ? "" : fmt::format("{}\n{}\n{}\n{}\n", head, rule, means, worst);
}

std::size_t ValidationReport::failures() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(outcomes, [](const Outcome& o) { return !o.result.passed(); }));
}

std::size_t ValidationReport::unsampled() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(outcomes, [](const Outcome& o) { return !o.result.measured(); }));
}

ValidationReport validate(const ValidationSettings& settings) {
  const CostMeter meter;
  ValidationReport report{this_machine(), settings.version, data_sha256(), settings.quick, {}, {}};
  for (const Case& item : all_cases()) {
    if (!is_selected(item, settings)) continue;
    if (settings.say) settings.say(fmt::format("{} {}: {}", suite_name(item.suite), item.id, item.title));
    report.outcomes.push_back(
        {&item, run_case(item, {.thorough = !settings.quick, .threads = settings.threads})});
  }
  report.cost = meter.spent();
  return report;
}

std::string readable_text(const ValidationReport& report) {
  std::string all;
  std::optional<Suite> suite;
  for (const Outcome& outcome : report.outcomes) {
    if (outcome.item->suite == Suite::techniques) continue;  // a table below lists this suite
    if (suite != outcome.item->suite) {
      suite = outcome.item->suite;
      all += fmt::format("{}{:<18} {:>5} {:>15} {:>15} {:>10} {:>17} {:>9} {:>7}\n", all.empty() ? "" : "\n",
                         suite_name(*suite), "of", "worst figure", "reference", "deviation", "margin",
                         "of margin", "CPU s");
    }
    all += line_of(outcome);
  }
  if (const std::string matrix = matrix_text(technique_matrix(report.outcomes)); !matrix.empty())
    all += fmt::format("{}{}: deviations [%]\n\n{}", all.empty() ? "" : "\n", suite_name(Suite::techniques),
                       matrix);
  if (const std::string charts = chart_table(report.outcomes); !charts.empty())
    all += "\nrendered charts\n\n" + charts;
  all += "\nnot covered\n";
  for (const Uncovered& gap : uncovered())
    all += fmt::format("  {}: {} ({})\n", suite_name(gap.suite), gap.what, gap.reason);
  const std::size_t measured = report.outcomes.size() - report.unsampled();
  return all + fmt::format("\n{} of {} cases pass; {:.1f} CPU s in all\n", measured - report.failures(),
                           measured, report.cost.cpu_s);
}

std::string json_text(const ValidationReport& report) {
  const Machine& machine = report.machine;
  Json json{{"version", report.version},
            {"data_sha256", report.data_sha256},
            {"machine",
             {{"cpu", machine.cpu},
              {"cores", machine.cores},
              {"compiler", machine.compiler},
              {"flags", machine.flags},
              {"date", machine.date}}},
            {"quick", report.quick},
            {"cases", report.outcomes.size() - report.unsampled()},
            {"failures", report.failures()},
            {"cpu_s", report.cost.cpu_s},
            {"wall_s", report.cost.wall_s},
            {"outcomes", Json::array()},
            {"not_covered", Json::array()}};
  for (const Outcome& outcome : report.outcomes) json["outcomes"].push_back(outcome_json(outcome));
  for (const Uncovered& gap : uncovered())
    json["not_covered"].push_back(
        {{"suite", suite_name(gap.suite)}, {"what", gap.what}, {"reason", gap.reason}});
  return json.dump() + "\n";
}

std::string technique_table_html(const std::vector<Outcome>& outcomes) {
  const TechniqueMatrix matrix = technique_matrix(outcomes);
  if (matrix.rows.empty()) return "";
  std::string all =
      "<p class=\"soft\">Each film by each integrator: the deviation from the closed form in per cent, "
      "“lost” with the number of the note if the integrator cannot sample the light, or a dash if nothing "
      "ran."
      "</p>\n<table class=\"matrix\"><tr><th>film</th>";
  for (const char* name : kIntegratorNames) all += fmt::format("<th class=\"n\">{}</th>", name);
  all += "</tr>\n";
  for (const TechniqueMatrix::Row& row : matrix.rows) {
    all += fmt::format("<tr><td>{}</td>", escaped(row.film));
    for (const Outcome* cell : row.cells)
      all += fmt::format("<td class=\"n {}\">{}</td>",
                         cell == nullptr || !cell->result.measured() ? "soft"
                         : cell->result.passed()                     ? "pass"
                                                                     : "fail",
                         cell_text(matrix, cell));
    all += "</tr>\n";
  }
  all += "</table>\n<ol class=\"soft\">";
  for (const PathClass& path_class : matrix.unsampled) all += fmt::format("<li>{}</li>", escaped(path_class));
  all += "</ol>\n";
  for_each_failure(matrix, [&](const Outcome& cell) {
    all += fmt::format("<p class=\"failure\">{}</p>\n", escaped(failure_text(cell)));
  });
  return all;
}

}  // namespace abbe
