#include "validation/bench/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "transport/render/threads.h"
#include "validation/bench/run.h"

namespace abbe {
namespace {

// Adds the curves for one floor: Abbe's integrators, then the other renderers, each in its own colour.
void add_series(LogPlot& plot, const SuiteRun& run, std::span<const OtherRendererResult> other_renderers,
                double floor, std::size_t& color) {
  static const std::vector<std::string> kColors{"#1f77b4", "#2ca02c", "#9467bd",
                                                "#ff7f0e", "#8c564b", "#e377c2"};
  const bool low = floor == kLowFloor;
  for (const BenchIntegrator& by : run.integrators) {
    const bool first = &by == run.integrators.data();
    plot.series.push_back({fmt::format("Abbe {}, floor {:g}", integrator_name(by.integrator), floor),
                           {},
                           first ? "#d62728" : kColors[color++ % kColors.size()],
                           low,
                           low});
    for (const CurvePoint& point : error_curve(rows_of(run.rows, by.integrator), floor))
      plot.series.back().points.emplace_back(point.cpu_s, point.error);
  }
  for (const OtherRendererResult& other : other_renderers) {
    if (other.suite != run.suite.name || other.floor != floor) continue;
    const std::string name = other.name();
    if (plot.series.back().name != name)
      plot.series.push_back({name, {}, kColors[color++ % kColors.size()], low, low});
    plot.series.back().points.emplace_back(other.cpu_s, other.relrmse);
  }
}

std::string rows_text(const SuiteRun& run) {
  std::string all =
      fmt::format("{:<13} {:>6} {:>9} {:>9} {:>11} {:>11} {:>12} {:>7} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}\n",
                  "integrator", "spp", "cpu_s", "wall_s", "paths", "rays", "rays/cpu_s", "replay", "relMSE",
                  "trimmed", "relRMSE", "nRMSE", "dE mean", "dE p95");
  for (const BenchRow& row : means_over_seeds(run.rows))
    all += fmt::format(
        "{:<13} {:>6} {:>9.4g} {:>9.4g} {:>11} {:>11} {:>12.4g} {:>7.3f} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g} "
        "{:>7.2f} "
        "{:>7.2f}\n",
        integrator_name(row.integrator), row.samples, row.cpu_s, row.wall_s, row.paths, row.rays,
        static_cast<double>(row.rays) / row.cpu_s, row.embree_replay_fraction, row.rel_mse,
        row.rel_mse_trimmed, root_of(row.rel_mse), root_of(row.n_mse), row.dE00_mean, row.dE00_p95);
  return all;
}

std::string equal_error_text(const std::vector<EqualError>& all) {
  std::string text;
  for (const EqualError& e : all)
    text += fmt::format("  {:<34} {:>5} spp {:>7.4g} s, relRMSE {:.3g}: Abbe {:.3g} s{}, ratio {:.3g}\n",
                        e.other.name(), e.other.samples, e.other.cpu_s, e.other.relrmse, e.abbe.cpu_s,
                        e.abbe.extrapolated ? " (extrapolated)" : "", e.ratio());
  return text.empty()
             ? ""
             : "time at the error of another renderer, which was measured in a different run:\n" + text;
}

// A cost, and its ratio to the cost of the best single integrator, if there is one.
std::string cost_text(std::span<const RankingEntry> all, const RankingEntry& one,
                      double RankingEntry::*cost) {
  const RankingEntry* best = best_single(all, cost);
  if (best == nullptr) return fmt::format("{:.3g}", one.*cost);
  return fmt::format("{:.3g} ({:.2f} times the cost of {})", one.*cost, one.*cost / best->*cost,
                     integrator_name(best->by.integrator));
}

std::string ranking_text(const SuiteRun& run) {
  const std::vector<RankingEntry> all = ranking(run);
  if (all.size() < 2) return "";
  std::string text = "CPU s x relMSE at the largest sample count:\n";
  for (const RankingEntry& one : all) {
    text += fmt::format("  {:<13} {}; trimmed {}", integrator_name(one.by.integrator),
                        cost_text(all, one, &RankingEntry::cost),
                        cost_text(all, one, &RankingEntry::cost_trimmed));
    if (!one.by.bias.empty()) text += "; excluded: " + one.by.bias;
    if (!one.by.unsampled.empty())
      text += fmt::format("; excluded: cannot sample {}", fmt::join(one.by.unsampled, ", "));
    text += '\n';
  }
  return text;
}

std::string ratio_text(const Ratio& ratio) {
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]{}", ratio.value, ratio.low(), ratio.high(),
                     ratio.changed() ? " CHANGED" : "");
}

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

}  // namespace

std::string readable_text(const BenchReport& report) {
  std::string all = fmt::format("{}, {} processors, {}, {}\n", report.machine.cpu, report.machine.cores,
                                report.machine.compiler, report.machine.date);
  for (const SuiteRun& run : report.runs)
    all += fmt::format("\n{}: {}\n", run.suite.name, run.suite.description) + rows_text(run) +
           ranking_text(run) + equal_error_text(equal_errors(run, report.other_renderers));
  if (!report.changes.empty())
    all += "\nratio to the baseline, with 99 % intervals from the scatter of the renders:\n";
  for (const Change& change : report.changes)
    all += fmt::format("  {:<14} {:<13} CPU time per path {}, relMSE {} ({} renders)\n", change.suite,
                       change.integrator, ratio_text(change.cpu_per_path), ratio_text(change.rel_mse),
                       change.pairs);
  return all;
}

LogPlot error_plot(const SuiteRun& run, std::span<const OtherRendererResult> other_renderers) {
  LogPlot plot{run.suite.name, "CPU time / s", "relRMSE", {}};
  std::size_t color = 0;
  for (const double floor : {kUsualFloor, kLowFloor})
    if (floor == kUsualFloor || std::ranges::any_of(other_renderers, [&](const OtherRendererResult& other) {
          return other.suite == run.suite.name && other.floor == floor;
        }))
      add_series(plot, run, other_renderers, floor, color);
  return plot;
}

std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder,
                                                std::span<const BenchSuite> suites) {
  std::vector<std::filesystem::path> files{folder / "bench.csv", folder / "bench.json"};
  for (const BenchSuite& suite : suites) files.push_back(folder / (suite.name + ".svg"));
  return files;
}

void require_report_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  require_writable(folder / "bench.json");
}

void write_report(const std::filesystem::path& folder, const BenchReport& report) {
  std::vector<BenchSuite> suites;
  for (const SuiteRun& run : report.runs) suites.push_back(run.suite);
  const std::vector<std::filesystem::path> files = report_files(folder, suites);
  write_atomically(files[0], csv_text(report.runs));
  write_atomically(files[1], json_text(report));
  for (std::size_t i = 0; i < suites.size(); ++i)
    write_atomically(files[2 + i], svg(error_plot(report.runs[i], report.other_renderers)));
}

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
  const Machine& machine = report.machine;
  Json json{{"version", report.settings.version},
            {"date", report.machine.date},
            {"machine",
             {{"cpu", machine.cpu},
              {"cores", machine.cores},
              {"compiler", machine.compiler},
              {"flags", machine.flags}}},
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
