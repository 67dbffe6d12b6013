#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/validation/bench_runs.h"
#include "validation/bench/run.h"

namespace abbe {
namespace {

using test::BenchFolder;
using test::planned_row;

constexpr const char* kBlurred = "blurred";
constexpr const char* kMirrors = "E S (S|D)* L: everything seen in mirrors or through glass";

// An invented render by an integrator, with its error and its trimmed error multiplied.
BenchRow row_by(Integrator integrator, int samples, std::uint64_t seed, double error, double trimmed) {
  BenchRow row = planned_row(samples, seed);
  row.integrator = integrator;
  row.rel_mse *= error;
  row.rel_mse_trimmed *= trimmed;
  return row;
}

// 4 and 16 samples of two seeds by five integrators. Biased and incomplete integrators are the cheapest. Path
// tracing is the cheaper one of the others, but not without outliers.
SuiteRun run_by_all() {
  SuiteRun run = test::planned_run("cornell");
  run.integrators = {{Integrator::automatic, {}, ""},
                     {Integrator::path, {}, ""},
                     {Integrator::light, {kMirrors}, ""},
                     {Integrator::bdpt, {}, ""},
                     {Integrator::sppm, {}, kBlurred}};
  run.rows.clear();
  for (const int samples : {4, 16})
    for (const std::uint64_t seed : {1, 2}) {
      run.rows.push_back(row_by(Integrator::automatic, samples, seed, 0.9, 2.5));
      run.rows.push_back(row_by(Integrator::path, samples, seed, seed == 1 ? 1 : 2, 4));
      run.rows.push_back(row_by(Integrator::light, samples, seed, 0.1, 0.1));
      run.rows.push_back(row_by(Integrator::bdpt, samples, seed, 3, 2));
      run.rows.push_back(row_by(Integrator::sppm, samples, seed, 0.2, 0.2));
    }
  return run;
}

TEST(BenchStanding, CostIsMeanTimeTimesMeanErrorAtTheMostSamples) {
  SuiteRun run = run_by_all();
  for (BenchRow& row : run.rows)
    if (row.samples == 4) row.cpu_s *= 2;  // pilot rays take half of it
  const std::vector<RankingEntry> all = ranking(run);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[1].by.integrator, Integrator::path);
  EXPECT_DOUBLE_EQ(all[1].cost, 1.6 * 1.5 * 0.64 / 16);
  EXPECT_DOUBLE_EQ(all[1].cost_trimmed, 1.6 * 4 * 0.32 / 16);
}

TEST(BenchStanding, MeansAreTakenIntegratorByIntegrator) {
  const std::vector<BenchRow> means = means_over_seeds(run_by_all().rows);
  ASSERT_EQ(means.size(), 10U);
  EXPECT_EQ(means[1].integrator, Integrator::path);
  EXPECT_DOUBLE_EQ(means[1].rel_mse, 1.5 * 0.64 / 4);
}

TEST(BenchStanding, TheBestIsASingleTechniqueThatConvergesToAllLight) {
  const std::vector<RankingEntry> all = ranking(run_by_all());
  ASSERT_NE(best_single(all, &RankingEntry::cost), nullptr);
  EXPECT_EQ(best_single(all, &RankingEntry::cost)->by.integrator, Integrator::path);
  ASSERT_NE(best_single(all, &RankingEntry::cost_trimmed), nullptr);
  EXPECT_EQ(best_single(all, &RankingEntry::cost_trimmed)->by.integrator, Integrator::bdpt);
}

TEST(BenchStanding, AnErrorThatTheReferencesNoiseHidesIsNobodysMeasure) {
  std::vector<RankingEntry> all = ranking(run_by_all());
  all[1].cost = -1e-9;
  EXPECT_EQ(best_single(all, &RankingEntry::cost)->by.integrator, Integrator::bdpt);
  all[3].cost = 0;
  EXPECT_EQ(best_single(all, &RankingEntry::cost), nullptr);
}

TEST(BenchStanding, JsonTellsAllOfThemBesideTheBest) {
  BenchReport report = test::planned_report();
  report.runs = {run_by_all()};
  const nlohmann::json suite = nlohmann::json::parse(json_text(report))["suites"].at(0);
  EXPECT_EQ(suite["rows"][1]["integrator"], "path");
  const nlohmann::json& all = suite["standings"];
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0]["integrator"], "auto");
  EXPECT_NEAR(all[0]["cost"].get<double>(), 1.6 * 0.9 * 0.64 / 16, 1e-12);
  EXPECT_NEAR(all[0]["over_best"].get<double>(), 0.9 / 1.5, 1e-12);
  EXPECT_NEAR(all[0]["over_best_trimmed"].get<double>(), 2.5 / 2, 1e-12);
  EXPECT_FALSE(all[0]["counted"]);
  EXPECT_TRUE(all[1]["counted"]);
  EXPECT_TRUE(all[1]["bias"].is_null());
  EXPECT_EQ(all[2]["unreached"].at(0), kMirrors);
  EXPECT_FALSE(all[2]["counted"]);
  EXPECT_EQ(all[4]["bias"], kBlurred);
  report.runs = {test::planned_run("cornell")};
  EXPECT_TRUE(nlohmann::json::parse(json_text(report))["suites"][0]["standings"][0]["over_best"].is_null());
}

TEST(BenchStanding, TextTellsWhoIsNotCountedAndWhy) {
  BenchReport report = test::planned_report();
  report.runs = {run_by_all()};
  const std::string text = readable_text(report);
  for (const char* line :
       {"auto          0.0576 (0.60 times the cost of path); trimmed 0.08 (1.25 times the cost of bdpt)\n",
        "excluded: blurred\n", "excluded: cannot sample E S (S|D)* L: everything seen"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  report.runs = {test::planned_run("cornell")};
  EXPECT_EQ(readable_text(report).find("at the largest sample count"), std::string::npos)
      << "nothing to compare";
}

TEST(BenchStanding, RivalsStandBesideTheFirstIntegrator) {
  const SuiteRun run = run_by_all();
  const auto equal = equal_errors(run, test::planned_report().other_renderers);
  ASSERT_FALSE(equal.empty());
  // relMSE of `auto` is 0.9 * 0.64 / 16 after 1.6 s; that of the other renderer is 0.04.
  EXPECT_NEAR(equal[0].abbe.cpu_s, 1.6 * 0.9, 1e-9);
}

TEST(BenchStanding, ThePlotHasACurveOfEachIntegrator) {
  const LogPlot plot = error_plot(run_by_all(), {});
  ASSERT_EQ(plot.series.size(), 5U);
  EXPECT_EQ(plot.series[3].name, "Abbe bdpt, floor 0.01");
  ASSERT_EQ(plot.series[3].points.size(), 2U);
  EXPECT_NEAR(plot.series[3].points[1].second, std::sqrt(3 * 0.64 / 16), 1e-12);
  EXPECT_NE(plot.series[3].color, plot.series[1].color);
}

TEST(BenchStanding, ABaselineIsComparedIntegratorByIntegrator) {
  const std::vector<SuiteRun> runs{run_by_all()};
  std::vector<BaselineRow> before = baseline_rows(runs);
  for (BaselineRow& row : before)
    if (row.integrator == "bdpt") row.rel_mse *= 2;
  const std::vector<Change> changes = compare_runs(before, baseline_rows(runs));
  ASSERT_EQ(changes.size(), 5U);
  for (const Change& change : changes) {
    EXPECT_EQ(change.pairs, 4U) << change.integrator;
    EXPECT_NEAR(change.rel_mse.value, change.integrator == "bdpt" ? 0.5 : 1, 1e-12) << change.integrator;
  }
}

// A luminous ball in front of a sky. Light tracing cannot sample either, as both are directly visible.
BenchSuite shining() {
  return {"shining",
          "",
          "scenes/glass_sphere.json",
          {{"/sensor/resolution", "[8, 8]"}, {"/shapes/1/material", "\"grey\""}}};
}

BenchSettings few(const std::filesystem::path& cache, std::vector<Integrator> integrators) {
  BenchSettings settings;
  settings.integrators = std::move(integrators);
  settings.samples = {2, 4};
  settings.seeds = 2;
  settings.reference_samples = 16;
  settings.threads = 1;
  settings.cache = cache;
  return settings;
}

TEST(BenchStanding, IntegratorsTakeTurnsAndSayWhatTheyLeaveOut) {
  const BenchFolder folder;
  const SuiteRun run =
      run_suite(shining(), few(folder.path(), {Integrator::automatic, Integrator::light, Integrator::sppm}));
  ASSERT_EQ(run.rows.size(), 12U);
  EXPECT_EQ(run.rows[0].integrator, Integrator::automatic);
  EXPECT_EQ(run.rows[1].integrator, Integrator::light);
  EXPECT_EQ(run.rows[4].integrator, Integrator::light);
  EXPECT_EQ(run.rows[4].seed, 2U);
  EXPECT_NE(run.rows[0].rel_mse, run.rows[1].rel_mse);
  ASSERT_EQ(run.integrators.size(), 3U);
  EXPECT_TRUE(run.integrators[0].unsampled.empty() && run.integrators[0].bias.empty());
  EXPECT_EQ(run.integrators[1].unsampled.size(), 2U);
  EXPECT_NE(run.integrators[2].bias, "");
}

// The light of the Cornell box faces the ceiling, so bidirectional path tracing is cheaper: two paths per
// pixel.
TEST(BenchStanding, AutoIsWhatARenderTakesItFor) {
  const BenchFolder folder;
  const BenchSuite indirect{"indirect",
                            "",
                            "scenes/cornell.json",
                            {{"/sensor/resolution", "[128, 128]"},
                             {"/lights/0/quad/corner", "[343, 450, 227]"},
                             {"/lights/0/quad/edge_u", "[-130, 0, 0]"},
                             {"/lights/0/quad/edge_v", "[0, 0, 105]"}}};
  BenchSettings settings = few(folder.path(), {Integrator::automatic});
  settings.samples = {1};
  settings.seeds = 1;
  settings.reference_samples = 2;
  const SuiteRun run = run_suite(indirect, settings);
  ASSERT_EQ(run.rows.size(), 1U);
  EXPECT_EQ(run.rows[0].paths, 2U * 128 * 128);
}

TEST(BenchStanding, AllAreComparedWithTheReferenceOfTheSuitesOwnIntegrator) {
  const BenchFolder folder;
  const SuiteRun run = run_suite(shining(), few(folder.path(), {Integrator::light}));
  const Scene scene = load_suite(shining(), folder.path(), false);
  EXPECT_EQ(scene.render.integrator, Integrator::automatic);
  const Reference kept = reference_of(scene, folder.path(), "", std::uint64_t{1} << 32, 16, 1);
  EXPECT_TRUE(kept.cached);
  EXPECT_EQ(kept.key, run.reference_key);
  const std::filesystem::path fresh = folder.path() / "fresh";
  EXPECT_EQ(kept.image.find("G")->values,
            reference_of(scene, fresh, "", std::uint64_t{1} << 32, 16, 1).image.find("G")->values);
}

// A reference contains only light that its integrator can sample, so no suite may select an incomplete
// integrator.
TEST(BenchStanding, SuitesLeaveTheIntegratorOpen) {
  for (const BenchSuite& suite : bench_suites()) {
    for (const Override& setting : suite.settings) EXPECT_NE(setting.pointer, "/render/integrator");
  }
}

}  // namespace
}  // namespace abbe
