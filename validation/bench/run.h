#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/unreached.h"
#include "sensor/film/relative_error.h"
#include "validation/bench/suite.h"

namespace abbe {

/// The floor under r^2 of relRMSE that Mitsuba's figures were taken with, in mean^2; pbrt-v4's have the usual
/// one.
inline constexpr double kLowFloor = 0.0025;
inline constexpr double kTrimmedShare = 1e-3;  ///< Left out of `rel_mse_trimmed`.

/// How to measure.
struct BenchSettings {
  std::vector<Integrator> integrators{Integrator::automatic};
  std::vector<int> samples{4, 8, 16, 32, 64};  ///< Per pixel.
  int seeds = 3;                               ///< Renders of each by each integrator, seeds 1 to this.
  int threads = 0;                             ///< 0: one per processor.
  int reference_samples = 0;                   ///< 0: 64 times the largest of `samples`.
  bool quick = false;                          ///< Films of a quarter of the edges.
  std::filesystem::path cache;                 ///< Folder for references and made meshes.
  std::string version;
  std::function<void(const std::string&)> say;  ///< Told each step, if set.
};

/// One render against its reference. Errors are over linear sRGB with the reference's variance subtracted,
/// and may be negative when the reference is not much better than the render.
struct BenchRow {
  Integrator integrator = Integrator::automatic;  ///< As asked for: what `automatic` chose is not told.
  int samples = 0;
  std::uint64_t seed = 0;
  double cpu_s = 0;  ///< Of all threads, from the loaded scene to the film, choosing an integrator included.
  double wall_s = 0;
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  double embree_replay_share = 0;  ///< Of the scene: measured beside the suite's first render.
  double rel_mse = 0;              ///< Floor `kUsualFloor`.
  double rel_mse_trimmed = 0;      ///< Without the largest `kTrimmedShare` of the values.
  double rel_mse_low = 0;          ///< Floor `kLowFloor`.
  double n_mse = 0;                ///< Mean square over the square of the mean.
  double dE00_mean = 0;            ///< As `color_difference`, its exposure fixed by the reference.
  double dE00_p95 = 0;
};

/// An integrator that a suite is rendered by.
struct BenchIntegrator {
  Integrator integrator;
  std::vector<PathClass> unreached;  ///< What it leaves out of the suite's light.
  std::string bias;                  ///< As `bias_of`.
};

/// What times and errors of a suite depend on beside the program, its tables and the machine: runs under
/// other conditions do not compare.
struct BenchConditions {
  int width, height;  ///< Of the film, in pixels.
  std::string scene_sha256;
  int reference_samples;
  int threads;
};

/// The conditions of a suite, whose scene is loaded as for a run. Throws Error{input} with the loader's
/// complaints.
[[nodiscard]] BenchConditions conditions_of(const BenchSuite& suite, const BenchSettings& settings);

/// What a suite gave.
struct SuiteRun {
  BenchSuite suite;
  BenchConditions conditions;
  double load_cpu_s;  ///< Reading the scene and building its acceleration structure.
  std::string reference_key;
  std::vector<BenchIntegrator> integrators;
  std::vector<BenchRow> rows;  ///< By samples, then seed, then integrator, so that integrators take turns.
};

/// Renders a suite at every sample count and seed by every integrator, all of them against the one reference
/// of the suite, which its own integrator renders.
[[nodiscard]] SuiteRun run_suite(const BenchSuite& suite, const BenchSettings& settings);

/// Square root of an error that noise may have made negative: 0 then.
[[nodiscard]] double root_of(double mean_square);

/// The rows of one integrator.
[[nodiscard]] std::vector<BenchRow> rows_of(const std::vector<BenchRow>& rows, Integrator integrator);

/// Mean over the seeds of one integrator's sample count.
[[nodiscard]] std::vector<BenchRow> means_over_seeds(const std::vector<BenchRow>& rows);

}  // namespace abbe
