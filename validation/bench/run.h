#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/lost_light.h"
#include "sensor/film/relative_error.h"
#include "validation/bench/suite.h"

namespace abbe {

/// Floor of relMSE (`ErrorMeasure::floor`) with which Mitsuba's results were computed. The results of pbrt-v4
/// have `kUsualFloor`.
inline constexpr double kLowFloor = 0.0025;
inline constexpr double kTrimmedFraction = 1e-3;  ///< Fraction of values that `rel_mse_trimmed` omits.

/// Settings of a benchmark.
struct BenchSettings {
  /// Integrators that render each suite, at least one. Other renderers are compared with the first.
  std::vector<Integrator> integrators{Integrator::automatic};
  std::vector<int> samples{4, 8, 16, 32, 64};  ///< Samples per pixel of the renders, ascending.
  int seeds = 3;    ///< Renders per integrator and sample count, with seeds 1 to `seeds`.
  int threads = 0;  ///< Number of threads; 0 for one per processor.
  /// Samples per pixel of the reference; 0 for 64 times the largest of `samples`.
  int reference_samples = 0;
  bool quick = false;           ///< Film edges divided by four.
  std::filesystem::path cache;  ///< Folder for reference images and generated meshes; created if needed.
  std::string version;          ///< Version of Abbe, for reports and the keys of references.
  std::function<void(const std::string&)> say;  ///< Called with a message for each step, if set.
};

/// One render, compared with its reference. Errors are over linear sRGB with the reference's variance
/// subtracted. They may be negative if the reference is not much better than the render.
struct BenchRow {
  /// Requested integrator; `automatic` is not replaced by the one that the render chose.
  Integrator integrator = Integrator::automatic;
  int samples = 0;  ///< Samples per pixel.
  std::uint64_t seed = 0;
  /// CPU time of all threads, from the loaded scene to the film; includes the choice of an integrator.
  double cpu_s = 0;
  double wall_s = 0;        ///< Elapsed time of the same work.
  std::uint64_t paths = 0;  ///< Number of paths, as `RenderStats` counts them.
  std::uint64_t rays = 0;   ///< Number of rays, as `RenderStats` counts them.
  /// Fraction of the tracing time that Embree alone takes, as in `RenderStats`. The suite's first render
  /// measures it for all rows.
  double embree_replay_fraction = 0;
  double rel_mse = 0;          ///< relMSE with the floor `kUsualFloor`.
  double rel_mse_trimmed = 0;  ///< relMSE without the largest fraction `kTrimmedFraction` of the values.
  double rel_mse_low = 0;      ///< relMSE with the floor `kLowFloor`.
  double n_mse = 0;            ///< Mean squared error divided by the squared mean of the reference.
  /// Mean CIEDE2000 by `color_difference`, which takes the exposure from the reference. 0 if the reference is
  /// black.
  double dE00_mean = 0;
  double dE00_p95 = 0;  ///< 95th percentile of the same differences over the pixels.
};

/// One of the integrators that render a suite.
struct BenchIntegrator {
  Integrator integrator;
  std::vector<PathClass> unsampled;  ///< Path classes of the suite that this integrator cannot sample.
  std::string bias;                  ///< Bias as `bias_of` describes it; empty for an unbiased integrator.
};

/// Conditions that determine times and errors of a suite, besides the program, its tables and the machine.
/// Runs with different conditions cannot be compared.
struct BenchConditions {
  int width, height;         ///< Size of the film in pixels.
  std::string scene_sha256;  ///< Hash of the scene with its settings and files.
  int reference_samples;     ///< Samples per pixel of the reference.
  int threads;               ///< Number of threads, never 0.
};

/// Loads the scene of a suite and returns its conditions. Throws the errors of `load_suite`.
[[nodiscard]] BenchConditions conditions_of(const BenchSuite& suite, const BenchSettings& settings);

/// Results of one suite.
struct SuiteRun {
  BenchSuite suite;
  BenchConditions conditions;
  double load_cpu_s;          ///< CPU time for reading the scene and building its acceleration structure.
  std::string reference_key;  ///< Text of the `ReferenceKey`.
  std::vector<BenchIntegrator> integrators;  ///< Integrators in the order of the settings.
  /// Sorted by samples, then seed, then integrator, so that the integrators alternate.
  std::vector<BenchRow> rows;
};

/// Renders a suite with every integrator at every sample count and seed. All renders are compared with one
/// reference, which the suite's own integrator renders. Throws the errors of `load_suite`, `reference_of` and
/// `render`. Throws Error{internal} if the sensor has neither X, Y, Z nor R, G, B.
[[nodiscard]] SuiteRun run_suite(const BenchSuite& suite, const BenchSettings& settings);

/// Square root of an error; 0 for an error that noise has made negative.
[[nodiscard]] double root_of(double mean_square);

/// Rows of one integrator, in their order.
[[nodiscard]] std::vector<BenchRow> rows_of(const std::vector<BenchRow>& rows, Integrator integrator);

/// Means over the seeds of each integrator and sample count, in the order of their first rows. Paths and rays
/// are those of the first seed; `seed` is 0.
[[nodiscard]] std::vector<BenchRow> means_over_seeds(const std::vector<BenchRow>& rows);

}  // namespace abbe
