#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/text.h"
#include "tests/validation/bench_runs.h"

namespace abbe {
namespace {

using test::BenchFolder;
using test::planned_report;
using test::planned_run;

TEST(BenchRivals, TheTableLoads) {
  const std::vector<OtherRendererResult> other_renderers = load_other_renderers();
  EXPECT_EQ(other_renderers.size(), 27U);
  const auto find = [&](const std::string& suite, const std::string& name,
                        int samples) -> const OtherRendererResult& {
    for (const OtherRendererResult& other : other_renderers)
      if (other.suite == suite && other.name() == name && other.samples == samples) return other;
    throw Error(ErrorCode::internal, suite, "no such rival");
  };
  const OtherRendererResult& llvm = find("cornell", "Mitsuba 3.8 path llvm_spectral", 256);
  EXPECT_EQ(llvm.cpu_s, 11.8);
  EXPECT_EQ(llvm.nrmse, 0.144);
  EXPECT_EQ(llvm.relrmse, 0.081);
  EXPECT_EQ(llvm.floor, kLowFloor);
  EXPECT_EQ(find("prism-spot", "pbrt-v4 lightpath", 64).floor, kUsualFloor);
  EXPECT_FALSE(find("prism-spot", "pbrt-v4 path (black image)", 64).nrmse);
}

TEST(BenchRivals, TimeAtAnErrorIsInterpolatedInLogarithms) {
  const std::vector<CurvePoint> curve{{1, 0.4}, {2, 0.1}, {8, 0.05}};
  EXPECT_NEAR(time_at_error(curve, 0.2)->cpu_s, std::sqrt(2), 1e-12);
  EXPECT_NEAR(time_at_error(curve, 0.1 / std::sqrt(2))->cpu_s, 4, 1e-12);
  EXPECT_FALSE(time_at_error(curve, 0.2)->extrapolated);
  EXPECT_FALSE(time_at_error(curve, 0.4)->extrapolated);
  EXPECT_FALSE(time_at_error({}, 0.2));
}

TEST(BenchRivals, BeyondTheCurveErrorFallsWithTheRootOfTime) {
  const std::vector<CurvePoint> curve{{1, 0.4}, {2, 0.1}};
  EXPECT_NEAR(time_at_error(curve, 0.05)->cpu_s, 8, 1e-12);
  EXPECT_NEAR(time_at_error(curve, 0.8)->cpu_s, 0.25, 1e-12);
  EXPECT_TRUE(time_at_error(curve, 0.05)->extrapolated);
  EXPECT_TRUE(time_at_error(curve, 0.8)->extrapolated);
}

// At 16 samples the invented run has a relRMSE of 0.2, or 0.4 at the low floor, after 1.6 s.
TEST(BenchRivals, EachIsMetAtItsOwnFloorAndInItsOwnSuite) {
  const BenchReport report = planned_report();
  const auto equal = equal_errors(report.runs.front(), report.other_renderers);
  ASSERT_EQ(equal.size(), 2U);
  EXPECT_NEAR(equal[0].abbe.cpu_s, 1.6, 1e-12);
  EXPECT_NEAR(equal[0].ratio(), 5 / 1.6, 1e-12);
  EXPECT_NEAR(equal[1].abbe.cpu_s, 1.6, 1e-12);
  EXPECT_NEAR(equal[1].ratio(), 3 / 1.6, 1e-12);
}

TEST(BenchReport, MeansAreTakenOverSeeds) {
  SuiteRun run = planned_run("cornell");
  run.rows[0].rel_mse = 0.1;
  run.rows[1].rel_mse = 0.3;
  run.rows[1].cpu_s = 0.6;
  const std::vector<BenchRow> means = means_over_seeds(run.rows);
  ASSERT_EQ(means.size(), 3U);
  EXPECT_DOUBLE_EQ(means[0].rel_mse, 0.2);
  EXPECT_DOUBLE_EQ(means[0].cpu_s, 0.5);
  EXPECT_DOUBLE_EQ(means[2].rel_mse, 0.01);
  EXPECT_EQ(means[2].paths, 64000U);
}

const std::vector<std::string> kColumns{"integrator",
                                        "spp",
                                        "seed",
                                        "cpu_s",
                                        "wall_s",
                                        "paths",
                                        "rays",
                                        "rays_per_cpu_s",
                                        "embree_replay_share",
                                        "relMSE",
                                        "relMSE_trimmed",
                                        "relRMSE_pbrt",
                                        "relRMSE_mitsuba",
                                        "nRMSE",
                                        "dE00_mean",
                                        "dE00_p95"};

TEST(BenchReport, JsonParsesBackWithAllKeys) {
  const nlohmann::json json = nlohmann::json::parse(json_text(planned_report()));
  for (const char* key : {"version", "date", "machine", "threads", "quick", "suites", "baseline"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["machine"]["cpu"], "a \"fast\" CPU");
  for (const char* key : {"cores", "compiler", "flags"}) EXPECT_TRUE(json["machine"].contains(key)) << key;
  const nlohmann::json& suite = json["suites"].at(0);
  for (const char* key : {"name", "description", "resolution", "scene_sha256", "load_cpu_s", "reference_spp",
                          "reference_key", "rows", "standings", "equal_error"})
    EXPECT_TRUE(suite.contains(key)) << key;
  ASSERT_EQ(suite["rows"].size(), 6U);
  EXPECT_EQ(suite["rows"][0].size(), kColumns.size());
  for (const std::string& key : kColumns) EXPECT_TRUE(suite["rows"][0].contains(key)) << key;
  EXPECT_EQ(suite["rows"][2]["relMSE"], 0.04);
  EXPECT_EQ(suite["rows"][2]["relRMSE_mitsuba"], 0.4);
  EXPECT_EQ(suite["rows"][2]["rays_per_cpu_s"], 50000);
  EXPECT_EQ(suite["equal_error"].size(), 2U);
  EXPECT_NEAR(suite["equal_error"][0]["ratio"].get<double>(), 5 / 1.6, 1e-12);
}

TEST(BenchReport, CsvHasARowPerRenderAndTheColumnsOfTheJson) {
  std::istringstream lines(csv_text(planned_report().runs));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> columns{"suite"};
  columns.insert(columns.end(), kColumns.begin(), kColumns.end());
  EXPECT_EQ(split(line, ','), columns);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(lines, line)) rows.push_back(split(line, ','));
  ASSERT_EQ(rows.size(), 6U);
  for (const auto& row : rows) ASSERT_EQ(row.size(), columns.size());
  EXPECT_EQ(rows[5][0], "cornell");
  EXPECT_EQ(rows[5][1], "auto");
  EXPECT_EQ(parse_number(rows[5][2]), 64);
  EXPECT_EQ(parse_number(rows[5][3]), 2);
  EXPECT_EQ(parse_number(rows[5][10]), 0.64 / 64);
}

// A stored run before the invented one. Its CPU times are multiplied by `factor` and by 1 +- `scatter`.
std::vector<BaselineRow> slowed(double factor, double scatter) {
  std::vector<BaselineRow> rows = baseline_rows(planned_report().runs);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].cpu_s *= factor * (1 + (i % 2 == 0 ? scatter : -scatter));
  return rows;
}

Baseline stored_run() {
  const BenchFolder folder;
  const std::filesystem::path path = folder.path() / "bench.json";
  std::ofstream(path) << json_text(planned_report());
  Diagnostics diagnostics;
  const auto run = load_baseline(path, diagnostics);
  EXPECT_TRUE(run) << diagnostics.text();
  return run.value_or(Baseline{});
}

std::vector<BaselineRow> stored() {
  return stored_run().rows;
}

TEST(BenchBaseline, FlagsAPlantedSlowdown) {
  const std::vector<Change> changes = compare_runs(stored(), slowed(1.2, 0.02));
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].suite, "cornell");
  EXPECT_EQ(changes[0].pairs, 6U);
  EXPECT_NEAR(changes[0].cpu_per_path.value, 1.2, 1e-3);
  EXPECT_TRUE(changes[0].cpu_per_path.changed());
  EXPECT_FALSE(changes[0].rel_mse.changed());
}

TEST(BenchBaseline, NoiseAndSmallChangesAreNotFlagged) {
  const auto changed = [](const std::vector<BaselineRow>& now) {
    return compare_runs(stored(), now).at(0).cpu_per_path.changed();
  };
  EXPECT_FALSE(changed(slowed(1, 0)));
  EXPECT_FALSE(changed(slowed(1, 0.02)));
  EXPECT_FALSE(changed(slowed(1.2, 0.3)));
  EXPECT_FALSE(changed(slowed(1.01, 0)));
  EXPECT_FALSE(changed({slowed(1.2, 0).front()})) << "one render says nothing about noise";
}

// Student's t at 99 % for 5 degrees of freedom is 4.0321. The standard deviation of values +-s is s
// sqrt(6/5).
TEST(BenchBaseline, NoiseIsStudentsIntervalOfTheMeanLogarithm) {
  std::vector<BaselineRow> now = stored();
  for (std::size_t i = 0; i < now.size(); ++i) now[i].cpu_s *= std::exp(i % 2 == 0 ? 0.1 : -0.1);
  const double noise = compare_runs(stored(), now).at(0).cpu_per_path.noise;
  EXPECT_NEAR(std::log1p(noise), 4.0321 * 0.1 * std::sqrt(6.0 / 5) / std::sqrt(6), 1e-5);
}

TEST(BenchBaseline, ChangesOfErrorAreFlaggedToo) {
  std::vector<BaselineRow> now = stored();
  for (BaselineRow& row : now) row.rel_mse *= 0.5;
  const Change change = compare_runs(stored(), now).at(0);
  EXPECT_TRUE(change.rel_mse.changed());
  EXPECT_NEAR(change.rel_mse.value, 0.5, 1e-12);
  EXPECT_FALSE(change.cpu_per_path.changed());
}

TEST(BenchBaseline, OnlyTheSameRendersArePaired) {
  std::vector<BaselineRow> now = stored();
  for (BaselineRow& row : now) row.seed += 100;
  EXPECT_TRUE(compare_runs(stored(), now).empty());
  now = stored();
  for (BaselineRow& row : now) row.suite = "mesh";
  EXPECT_TRUE(compare_runs(stored(), now).empty());
}

TEST(BenchBaseline, RunsUnderOtherConditionsAreRefusedWithWhatDiffers) {
  const Baseline before = stored_run();
  ASSERT_EQ(before.suites.size(), 1U);
  const auto complaint = [&before](const BenchConditions& now) {
    Diagnostics diagnostics;
    require_comparable(before.suites[0], now, diagnostics);
    EXPECT_TRUE(!diagnostics.has_errors() || diagnostics.code() == ErrorCode::input);
    return diagnostics.text();
  };
  EXPECT_EQ(complaint(planned_run("cornell").conditions), "");
  for (const auto& [now, told] : std::vector<std::pair<BenchConditions, std::string>>{
           {{9, 6, "abc", 1024, 2}, "resolution (got 8x6, allowed 9x6)\n"},
           {{8, 7, "abc", 1024, 2}, "resolution (got 8x6, allowed 8x7)\n"},
           {{8, 6, "abd", 1024, 2}, "scene_sha256 (got abc, allowed abd)\n"},
           {{8, 6, "abc", 32, 1}, "reference_spp (got 1024, allowed 32), threads (got 2, allowed 1)\n"}})
    EXPECT_NE(complaint(now).find("/suites/0: error: suite cornell cannot be compared with this run, "
                                  "since its conditions differ: " +
                                  told),
              std::string::npos)
        << complaint(now);
}

TEST(BenchReport, ChangesComeWithTheEndsOfTheirIntervals) {
  BenchReport report = planned_report();
  report.changes = {{"cornell", "auto", 6, {3.5, 1}, {1.25, std::numeric_limits<double>::infinity()}}};
  const std::string text = readable_text(report);
  EXPECT_NE(
      text.find("CPU time per path 3.500 [1.750, 7.000] CHANGED, relMSE 1.250 [0.000, inf] (6 renders)\n"),
      std::string::npos)
      << text;
}

TEST(BenchBaseline, AMalformedFileIsReportedWhereItIsWrong) {
  const BenchFolder folder;
  const std::filesystem::path path = folder.path() / "bench.json";
  std::ofstream(path)
      << R"({"suites": [{"name": "cornell", "rows": [{"spp": 4, "seed": 1, "cpu_s": 1, "paths": 9}]}]})";
  Diagnostics diagnostics;
  EXPECT_FALSE(load_baseline(path, diagnostics));
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
  EXPECT_NE(diagnostics.text().find("/suites/0/rows/0: error: expected a number \"relMSE\""),
            std::string::npos)
      << diagnostics.text();
}

}  // namespace
}  // namespace abbe
