#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "sensor/film/crop.h"
#include "sensor/film/feature_film.h"
#include "sensor/film/film.h"
#include "sensor/film/relative_error.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/render/layers.h"
#include "transport/render/mpi_group.h"
#include "transport/render/sample_ranges.h"

namespace abbe {

/// Progress of a render.
struct Progress {
  double fraction_done;   ///< In [0, 1]; an estimate if a time or error limit ends the render.
  std::uint64_t samples;  ///< Finished samples per pixel, including those of an earlier run.
  double rate;            ///< Rate of this run without its planning [samples/s]; 0 before its first sample.
  double elapsed_s;       ///< Time since `render` was called, with its planning.
  double left_s;          ///< Estimated time to the end; NaN while unknown.
  RelativeError error;    ///< Latest estimate of the film's error.
  std::uint64_t error_samples;  ///< Samples per pixel when `error` was estimated.
};

struct RenderResult;

/// State of a pass that was interrupted: it has finished the first items of its samples.
struct UnfinishedPass {
  SampleRange samples;  ///< Samples of the whole pass.
  std::uint32_t items;  ///< Number of finished tiles and photon batches, in their order.
};

/// Options of a render: its limits, its outputs and its callbacks.
struct RenderOptions {
  int threads = 0;                          ///< Number of threads; 0 for one per processor.
  std::optional<double> time_limit_s = {};  ///< Stops after the first pass that ends after this time.
  /// Stops after a pass whose relative error is no larger than this. With `target_planes` = 0 this is the
  /// median error. Otherwise it is the error of the mean over the whole film, the largest of the first
  /// `target_planes` planes. An error that is not yet known (`is_known`) must be four times smaller.
  std::optional<double> target_error = {};
  int target_planes = 0;  ///< Number of planes of the mean for `target_error`; 0 for the median error.
  std::optional<Crop> crop = {};  ///< Restricts the film to these pixels; empty for the whole film.
  bool measure_error = false;  ///< Estimate the final error even if neither a target nor `progress` needs it.
  /// Measure `embree_replay_fraction`, by tracing a few paths again.
  bool measure_replay = false;
  std::optional<SampleRange> samples = {};  ///< Restricts the render to these samples; empty for all.
  std::optional<Layers> layers = {};        ///< Layers into which the film is split in addition.
  /// Features of the first surface hit to record; each once, in the order of `Feature`.
  std::vector<Feature> features = {};
  /// Called with the current result, possibly during a pass:
  /// - once `checkpoint_interval_s` has passed since the last call or the start, but so seldom that the calls
  ///   take at most 1 % of the time;
  /// - once as soon as a stop is requested.
  std::function<void(const RenderResult&)> checkpoint = {};
  double checkpoint_interval_s = 60;  ///< Minimum time between calls of `checkpoint`.
  /// Set to true to stop after the current pass, but not before the first one ends. Whole passes leave the
  /// mean unbiased.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Progress&)> progress = {};  ///< Called after each pass; may be empty.
  /// Called after each pass; `show` then receives the result of all whole passes if this returned true.
  std::function<bool()> viewer_is_ready = {};
  std::function<void(const RenderResult&)> show = {};  ///< Must be set if `viewer_is_ready` is.
  /// Guiding data that pilots trained for the same scene (`IntegratorChoice::guides`); null to train them
  /// first.
  std::shared_ptr<const GuidingData> guides = {};
  MpiGroup mpi_group = {};  ///< The MPI processes that render this film together.
};

/// Work of a render or of a part of it, and what it dropped.
struct WorkCounts {
  std::uint64_t paths = 0;  ///< Camera paths and light paths, without those of pilots.
  std::uint64_t rays = 0;   ///< Rays of these paths, shadow rays included.
  /// Contributions dropped: a value is not finite or too large for the film.
  std::uint64_t nonfinite_samples = 0;
  TruncatedPaths cut = {};  ///< Paths that ended at the maximum depth.

  WorkCounts& operator+=(const WorkCounts& more) {
    paths += more.paths;
    rays += more.rays;
    nonfinite_samples += more.nonfinite_samples;
    cut += more.cut;
    return *this;
  }
};

/// Work and time of a render.
struct RenderStats : WorkCounts {
  double wall_s = 0;       ///< Wall-clock time of this run, with its planning.
  double cpu_s = 0;        ///< CPU time of all threads and processes in this run.
  int threads = 1;         ///< Threads of each process.
  int processes = 1;       ///< Processes whose work these figures add up.
  int path_splitting = 1;  ///< Directions in which a camera path continues from its first scattering vertex.
  std::uint64_t samples_per_pixel = 0;  ///< Finished samples per pixel, with those of an earlier run.
  std::uint64_t samples_before = 0;     ///< Samples of an earlier run. Counts include that run, times do not.
  RelativeError error = {};             ///< Latest estimate; the default if none was needed.
  /// Time that Embree alone takes for logged rays, divided by the time to trace their paths. 0 if not
  /// measured.
  double embree_replay_fraction = 0;
  bool interrupted = false;  ///< True if `RenderOptions::stop` ended the render.
};

/// Films of a render with their samples.
struct RenderResult {
  Film film;             ///< Main film.
  SampleRanges samples;  ///< Samples that every pixel of its crop has.
  RenderStats stats;
  std::optional<UnfinishedPass> unfinished = {};  ///< Only in the result that a checkpoint receives.
  /// Copies of the replicates to which an unfinished pass contributes, from before the pass. Only for films
  /// with photons: no pixel has a sample until all photons of that sample are traced.
  std::shared_ptr<const std::vector<Film>> before_pass = {};
  std::optional<Film> layers = {};           ///< Planes of all layers, one layer after another, if requested.
  std::optional<FeatureFilm> features = {};  ///< If features were requested.
};

/// Renders the scene, or those of its samples that `start` does not have. With fixed samples, the film
/// depends only on scene, data, version and seed, not on threads, processes or interruptions. In an MPI
/// group, rank 0 returns the result and the other processes return films whose sums are 0. Rethrows
/// exceptions of the callbacks. Throws
/// - the Error{scene} of `make_plan`, and Error{scene} if a sum of the film overflows;
/// - Error{resource} if the film does not fit in memory, or more than `MediumStack::kMaxShapes` media nest;
/// - Error{input} if the films of `start` do not have the shape that scene and options require.
[[nodiscard]] RenderResult render(const Scene& scene, const RenderOptions& options,
                                  std::optional<RenderResult> start = {});

/// Number of replicates of the scene's film: enough to estimate a variance, few enough for long sequences. It
/// follows from the samples per pixel, unless a time or error limit ends the render.
[[nodiscard]] int replicate_count(const Scene& scene, const RenderOptions& options);

}  // namespace abbe
