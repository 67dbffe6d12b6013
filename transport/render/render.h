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
#include "transport/path/truncated_paths.h"
#include "transport/plan/plan.h"
#include "transport/render/crew.h"
#include "transport/render/layers.h"
#include "transport/render/sample_ranges.h"

namespace abbe {

/// How far a render has come.
struct Progress {
  double share;           ///< Of the work, in [0, 1]; an estimate where time or error decides.
  std::uint64_t samples;  ///< Finished, per pixel, those of an earlier run too.
  double rate;            ///< Of this run, without its planning [samples/s]; 0 before its first.
  double elapsed_s;
  double left_s;                ///< An estimate; NaN before there is one.
  RelativeError error;          ///< Of the film when it had
  std::uint64_t error_samples;  ///< so many per pixel.
};

struct RenderResult;

/// A pass that is not finished: these samples of the first tiles and photons only.
struct UnfinishedPass {
  SampleRange samples;
  std::uint32_t items;  ///< Tiles and photon batches done, in their order.
};

/// When to stop, and with what.
struct RenderOptions {
  int threads = 0;                          ///< 0: one per processor.
  std::optional<double> time_limit_s = {};  ///< Stops after the first pass that ends then.
  /// Stops after a pass whose relative error is no larger: the median, or that of the means of the first so
  /// many planes over the whole film. An error that is not yet known (`is_known`) must be four times smaller.
  std::optional<double> target_error = {};
  int target_planes = 0;
  std::optional<Crop> crop = {};
  bool measure_error = false;  ///< Also find `error` where neither a target nor progress asks for it.
  bool measure_replay =
      false;  ///< Also find `embree_replay_share`, at the cost of rendering a few paths again.
  std::optional<SampleRange> samples = {};  ///< Only these of the samples the scene asks for.
  std::optional<Layers> layers = {};        ///< Into which the film is also told apart.
  std::vector<Feature> features = {};  ///< Of the first surfaces that are met, each once, in their order.
  /// Called with what is done, maybe amid a pass, once `checkpoint_interval_s` has gone by since the last
  /// call or since the start, and so seldom that the calls take no more than a hundredth of the time; and
  /// once as soon as a stop is asked for.
  std::function<void(const RenderResult&)> checkpoint = {};
  double checkpoint_interval_s = 60;
  const std::atomic<bool>* stop = nullptr;  ///< Stops after the pass that runs, so that the mean is right.
  std::function<void(const Progress&)> progress = {};
  /// Asked after each pass whether `show` is to be called with what is done: whole passes, never a part.
  std::function<bool()> wants_to_see = {};
  std::function<void(const RenderResult&)> show = {};
  /// What pilots have taught of the same scene (`IntegratorChoice::guides`); else they are asked first.
  std::shared_ptr<const Guides> guides = {};
  Crew crew = {};  ///< The processes that render this together.
};

/// What a render did.
struct RenderStats {
  double wall_s = 0;
  double cpu_s = 0;
  int threads = 1;         ///< Of each process.
  int processes = 1;       ///< Of the crew, whose work these figures count.
  int path_splitting = 1;  ///< Into how many a camera path goes on where it first scatters.
  std::uint64_t samples_per_pixel = 0;
  std::uint64_t samples_before = 0;  ///< Of an earlier run: the counts are of these too, the times are not.
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t nonfinite_samples = 0;  ///< Dropped.
  TruncatedPaths cut = {};
  RelativeError error = {};
  double embree_replay_share =
      0;  ///< Time of the logged rays through Embree alone over the time to trace their paths.
  bool interrupted = false;
};

struct RenderResult {
  Film film;
  SampleRanges samples;
  RenderStats stats;
  std::optional<UnfinishedPass> unfinished = {};  ///< Only in what a checkpoint gets.
  /// What the replicates that an unfinished pass adds to held before it, of a film with photons: until all of
  /// a sample's are there, no pixel has the sample.
  std::shared_ptr<const std::vector<Film>> before_pass = {};
  std::optional<Film> layers = {};           ///< Their planes one after another, if some were asked for.
  std::optional<FeatureFilm> features = {};  ///< If some were asked for.
};

/// Renders the scene, or those of its samples that `start` does not have. For fixed samples the film is a
/// pure function of scene, data, version and seed: threads, processes, interruptions and their timing change
/// nothing. Of a crew, the result is that of its first process; the others are left with empty films.
/// Throws Error{resource} when the film does not fit in memory.
[[nodiscard]] RenderResult render(const Scene& scene, const RenderOptions& options,
                                  std::optional<RenderResult> start = {});

/// Replicates of the scene's film: by its samples per pixel, where time or error do not decide; enough for a
/// variance, few enough to leave the sequences long.
[[nodiscard]] int replicate_count(const Scene& scene, const RenderOptions& options);

}  // namespace abbe
