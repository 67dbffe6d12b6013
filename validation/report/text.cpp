// The report in plain text and as JSON.
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "validation/report/matrix.h"
#include "validation/report/report.h"

namespace abbe {
namespace {

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

}  // namespace abbe
