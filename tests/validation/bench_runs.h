#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

#include "validation/bench/report.h"

namespace abbe::test {

/// A folder of this process, removed in the destructor.
class BenchFolder {
 public:
  BenchFolder()
      : path_(std::filesystem::temp_directory_path() / ("abbe_bench_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~BenchFolder() { std::filesystem::remove_all(path_); }
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// An invented render with relRMSE 0.8/sqrt(samples) after samples/10 s; at the low floor the error is twice
/// as large.
inline BenchRow planned_row(int samples, std::uint64_t seed) {
  BenchRow row;
  row.samples = samples;
  row.seed = seed;
  row.cpu_s = samples / 10.0;
  row.wall_s = row.cpu_s / 2;
  row.paths = static_cast<std::uint64_t>(samples) * 1000;
  row.rays = row.paths * 5;
  row.embree_replay_fraction = 0.3;
  row.rel_mse = 0.64 / samples;
  row.rel_mse_trimmed = row.rel_mse / 2;
  row.rel_mse_low = 4 * row.rel_mse;
  row.n_mse = 0.09;
  row.dE00_mean = 1.5;
  row.dE00_p95 = 4;
  return row;
}

/// Invented run at 4, 16 and 64 samples per pixel with two seeds each.
inline SuiteRun planned_run(const std::string& suite) {
  SuiteRun run{{suite, "planned", "scene.json"},
               {8, 6, "abc", 1024, 2},
               0.25,
               "def",
               {{Integrator::automatic, {}, ""}},
               {}};
  for (const int samples : {4, 16, 64})
    for (const std::uint64_t seed : {1, 2}) run.rows.push_back(planned_row(samples, seed));
  return run;
}

inline BenchReport planned_report() {
  BenchReport report{{"a \"fast\" CPU", 2, "GCC", "-O3", "2026-01-01T00:00:00Z"}, {}, {}, {}, {}};
  report.settings.version = "1.2.3";
  report.settings.threads = 2;
  report.runs = {planned_run("cornell")};
  report.other_renderers = {{"cornell", "other", "path", 16, 5, 0.3, 0.2, kUsualFloor},
                            {"cornell", "third", "path", 64, 3, std::nullopt, 0.4, kLowFloor},
                            {"prism-spot", "other", "path", 16, 5, 0.3, 0.2, kUsualFloor}};
  return report;
}

}  // namespace abbe::test
