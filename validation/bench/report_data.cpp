// CSV and JSON of the report.
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "transport/render/threads.h"
#include "validation/bench/ranking.h"
#include "validation/bench/report.h"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;

// Columns of a render in order; CSV and JSON use the same names.
Json row_json(const BenchRow& row) {
  return {{"integrator", integrator_name(row.integrator)},
          {"spp", row.samples},
          {"seed", row.seed},
          {"cpu_s", row.cpu_s},
          {"wall_s", row.wall_s},
          {"paths", row.paths},
          {"rays", row.rays},
          {"rays_per_cpu_s", static_cast<double>(row.rays) / row.cpu_s},
          {"embree_replay_share", row.embree_replay_fraction},
          {"relMSE", row.rel_mse},
          {"relMSE_trimmed", row.rel_mse_trimmed},
          {"relRMSE_pbrt", root_of(row.rel_mse)},
          {"relRMSE_mitsuba", root_of(row.rel_mse_low)},
          {"nRMSE", root_of(row.n_mse)},
          {"dE00_mean", row.dE00_mean},
          {"dE00_p95", row.dE00_p95}};
}

Json equal_error_json(const EqualError& e) {
  return {{"rival", e.other.renderer}, {"setting", e.other.setting},
          {"spp", e.other.samples},    {"relRMSE", e.other.relrmse},
          {"floor", e.other.floor},    {"rival_cpu_s", e.other.cpu_s},
          {"cpu_s", e.abbe.cpu_s},     {"extrapolated", e.abbe.extrapolated},
          {"ratio", e.ratio()}};
}

// Ratio to the cost of the best single integrator; null if there is none.
Json over_best(std::span<const RankingEntry> all, const RankingEntry& one, double RankingEntry::*cost) {
  const RankingEntry* best = best_single(all, cost);
  return best == nullptr ? Json() : Json(one.*cost / best->*cost);
}

Json ranking_json(const SuiteRun& run) {
  const std::vector<RankingEntry> all = ranking(run);
  Json json = Json::array();
  for (const RankingEntry& one : all)
    json.push_back({{"integrator", integrator_name(one.by.integrator)},
                    {"cost", one.cost},
                    {"cost_trimmed", one.cost_trimmed},
                    {"over_best", over_best(all, one, &RankingEntry::cost)},
                    {"over_best_trimmed", over_best(all, one, &RankingEntry::cost_trimmed)},
                    {"counted", one.is_eligible()},
                    {"unreached", one.by.unsampled},
                    {"bias", one.by.bias.empty() ? Json() : Json(one.by.bias)}});
  return json;
}

Json suite_json(const SuiteRun& run, std::span<const OtherRendererResult> other_renderers) {
  const BenchConditions& conditions = run.conditions;
  Json json{{"name", run.suite.name},
            {"description", run.suite.description},
            {"resolution", {conditions.width, conditions.height}},
            {"scene_sha256", conditions.scene_sha256},
            {"load_cpu_s", run.load_cpu_s},
            {"reference_spp", conditions.reference_samples},
            {"reference_key", run.reference_key},
            {"standings", ranking_json(run)},
            {"rows", Json::array()},
            {"equal_error", Json::array()}};
  for (const BenchRow& row : run.rows) json["rows"].push_back(row_json(row));
  for (const EqualError& e : equal_errors(run, other_renderers))
    json["equal_error"].push_back(equal_error_json(e));
  return json;
}

// JSON has no infinity; an unknown noise is null.
Json ratio_json(const Ratio& ratio) {
  return {{"ratio", ratio.value},
          {"noise", std::isfinite(ratio.noise) ? Json(ratio.noise) : Json()},
          {"changed", ratio.changed()}};
}

Json machine_json(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"compiler", machine.compiler},
          {"flags", machine.flags}};
}

}  // namespace

std::string csv_text(std::span<const SuiteRun> runs) {
  std::string all = "suite";
  const Json names = row_json({});
  for (const auto& [name, value] : names.items()) all += "," + name;
  all += '\n';
  for (const SuiteRun& run : runs)
    for (const BenchRow& row : run.rows) {
      all += run.suite.name;
      for (const Json& value : row_json(row))
        all += "," + (value.is_string() ? value.get<std::string>() : value.dump());
      all += '\n';
    }
  return all;
}

std::string json_text(const BenchReport& report) {
  Json json{{"version", report.settings.version},
            {"date", report.machine.date},
            {"machine", machine_json(report.machine)},
            {"threads", thread_count(report.settings.threads)},
            {"quick", report.settings.quick},
            {"suites", Json::array()},
            {"baseline", Json::array()}};
  for (const SuiteRun& run : report.runs) json["suites"].push_back(suite_json(run, report.other_renderers));
  for (const Change& change : report.changes)
    json["baseline"].push_back({{"suite", change.suite},
                                {"integrator", change.integrator},
                                {"renders", change.pairs},
                                {"cpu_per_path", ratio_json(change.cpu_per_path)},
                                {"relMSE", ratio_json(change.rel_mse)}});
  return json.dump() + "\n";
}

}  // namespace abbe
