#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "scene/lost_light.h"
#include "scene/scene.h"
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
  int seeds = 3;                ///< Renders per integrator and sample count, with seeds 1 to `seeds`.
  int threads = 0;              ///< 0 for one per processor.
  int reference_samples = 0;    ///< Per pixel; 0 for 64 times the largest of `samples`.
  bool quick = false;           ///< Film edges divided by four.
  std::filesystem::path cache;  ///< Folder for reference images and generated meshes; created if needed.
  std::string version;          ///< For reports and the keys of references.
  std::function<void(const std::string&)> say;  ///< Called with a message for each step, if set.
};

/// One render, compared with its reference. Errors are over linear sRGB with the reference's variance
/// subtracted, and may be negative if the reference is not much better than the render.
struct BenchRow {
  /// Requested integrator; `automatic` is not replaced by the one that the render chose.
  Integrator integrator = Integrator::automatic;
  int samples = 0;
  std::uint64_t seed = 0;
  /// CPU time of all threads, from the loaded scene to the film; includes the choice of an integrator.
  double cpu_s = 0;
  double wall_s = 0;
  std::uint64_t paths = 0;  ///< As `RenderStats` counts them, like `rays`.
  std::uint64_t rays = 0;
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
  std::vector<PathClass> unsampled;
  std::string bias;  ///< As `bias_of` describes it; empty for an unbiased integrator.
};

/// Conditions that determine times and errors of a suite, besides the program, its tables and the machine.
/// Runs with different conditions cannot be compared.
struct BenchConditions {
  int width, height;
  std::string scene_sha256;  ///< Hash of the scene with its settings and files.
  int reference_samples;
  int threads;  ///< Never 0.
};

/// Loads the scene of a suite. Throws the errors of `load_suite`.
[[nodiscard]] BenchConditions conditions_of(const BenchSuite& suite, const BenchSettings& settings);

struct SuiteRun {
  BenchSuite suite;
  BenchConditions conditions;
  double load_cpu_s;          ///< CPU time for reading the scene and building its acceleration structure.
  std::string reference_key;  ///< Text of the `ReferenceKey`.
  std::vector<BenchIntegrator> integrators;  ///< Integrators in the order of the settings.
  /// Sorted by samples, then seed, then integrator, so that the integrators alternate.
  std::vector<BenchRow> rows;
};

/// Renders a suite with every integrator at every sample count and seed, and compares with one reference,
/// which the suite's own integrator renders. Throws the errors of `load_suite`, `reference_of` and
/// `render`. Throws Error{internal} if the sensor has neither X, Y, Z nor R, G, B.
[[nodiscard]] SuiteRun run_suite(const BenchSuite& suite, const BenchSettings& settings);

/// Square root; 0 for an error that noise has made negative.
[[nodiscard]] double root_of(double mean_square);

[[nodiscard]] std::vector<BenchRow> rows_of(const std::vector<BenchRow>& rows, Integrator integrator);

/// Means over the seeds of each integrator and sample count, in the order of their first rows. Paths and rays
/// are those of the first seed; `seed` is 0.
[[nodiscard]] std::vector<BenchRow> means_over_seeds(const std::vector<BenchRow>& rows);

struct RankingEntry {
  BenchIntegrator by;
  /// CPU time [s] times relMSE, both means over the seeds at the last sample count of the run. relMSE is
  /// inversely proportional to time, so the cost is proportional to the time that a given error takes. Not
  /// positive if noise hides the error.
  double cost;
  double cost_trimmed;  ///< Cost with `rel_mse_trimmed` instead of relMSE.

  /// True for an unbiased integrator other than `automatic` that can sample all light paths of the suite.
  [[nodiscard]] bool is_eligible() const;
};

/// Costs of a run's integrators, in the order of the run; integrators without rows are omitted.
[[nodiscard]] std::vector<RankingEntry> ranking(const SuiteRun& run);

/// Eligible entry with the smallest positive `cost`, one of the costs of `RankingEntry`; null if there is
/// none.
[[nodiscard]] const RankingEntry* best_single(std::span<const RankingEntry> all, double RankingEntry::*cost);

/// Converts channels X, Y, Z to linear sRGB (R, G, B) in the same scale, without chromatic adaptation, or
/// copies R, G, B. Other channels and metadata are omitted. Throws Error{internal} if neither set of
/// channels is complete.
[[nodiscard]] Image linear_srgb(const Image& film);

/// Replaces the sensor's channels X, Y, Z by R, G, B of linear sRGB, so that the film records their
/// variances. A scene with other channels remains as it is.
void expose_in_srgb(Scene& scene);

/// Everything that a reference image depends on.
struct ReferenceKey {
  std::string scene_sha256;
  int width, height;
  std::string version;
  std::string data_sha256;
  std::uint64_t seed;
  int samples;

  [[nodiscard]] std::string text() const;
};

struct Reference {
  Image image;      ///< Channels R, G, B, Variance.R, Variance.G and Variance.B, in linear sRGB.
  std::string key;  ///< Text of its `ReferenceKey`.
  bool cached;      ///< True if the image was read from the cache.
};

/// Reference image of the scene by its own integrator, from the file of its key in the folder `cache`, or
/// rendered and written there. The folder is created if needed. Throws Error{output} if the file cannot be
/// written, and the errors of `read_exr` and `render`.
[[nodiscard]] Reference reference_of(const Scene& scene, const std::filesystem::path& cache,
                                     const std::string& version, std::uint64_t seed, int samples,
                                     int threads);

}  // namespace abbe
