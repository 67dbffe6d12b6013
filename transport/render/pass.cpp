#include "transport/render/pass.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <pmmintrin.h>

#include "io/error.h"
#include "scene/scene_features.h"
#include "transport/path/dimensions.h"
#include "transport/render/threads.h"
#include "transport/technique/features.h"
#include "transport/technique/path_starts.h"
#include "transport/technique/tracers.h"

namespace abbe {
namespace {

constexpr std::uint32_t kTile = 16;
constexpr std::uint32_t kPhotonBatch = 4096;

constexpr std::uint32_t ceil_div(std::uint64_t whole, std::uint32_t piece) {
  return static_cast<std::uint32_t>((whole + piece - 1) / piece);
}

// Returns the sampler of random numbers of one light subpath of a sample, by the index of the subpath.
using LightPathSampler = std::function<Sampler(std::uint64_t path)>;

// Calls `batch(tracer, first, last)` for all light subpaths, on `threads` threads. Each thread has its own
// ray caster and `Tracer`.
template <typename Tracer, typename Batch>
void trace_all(const Plan& plan, int threads, WorkCounts& counts, const Batch& batch) {
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    Tracer tracer(plan, caster);
    for (std::uint64_t first = kBatchSize * next++; first < plan.photons; first = kBatchSize * next++)
      batch(tracer, first, std::min(first + kBatchSize, plan.photons));
    const std::scoped_lock lock(mutex);
    counts.rays += caster.rays();
    counts.cut += caster.truncated();
  });
  counts.paths += plan.photons;
}

// Records light subpaths with all their vertices.
class LightRecorder {
 public:
  LightRecorder(const Plan& plan, RayCaster& caster)
      : plan_(plan), caster_(caster), recorder_(plan.scene, caster) {}

  std::vector<RecordedPath>& record(const std::vector<Sampler>& samplers, const PathPacket& packet,
                                    float time) {
    recorder_.paths().clear();
    for (std::uint32_t i = 0; i < samplers.size(); ++i) {
      RecordedPath& path = recorder_.paths().emplace_back(samplers[i], i);
      path.packet = packet;
      start_from_light(plan_, caster_, time, path);
    }
    recorder_.run();
    return recorder_.paths();
  }

 private:
  const Plan& plan_;
  RayCaster& caster_;
  PathRecorder<TransportMode::power> recorder_;
};

std::vector<Sampler> samplers_of(const LightPathSampler& samplers, std::uint64_t first, std::uint64_t last) {
  std::vector<Sampler> batch_samplers;
  for (std::uint64_t path = first; path < last; ++path) batch_samplers.push_back(samplers(path));
  return batch_samplers;
}

// Traces the plan's light subpaths of one sample, all with the same `packet` and `time`, and returns the
// photons that they deposit. `time` is a fraction of the exposure. The result does not depend on `threads`,
// which is at least 1. Several threads call `samplers` concurrently. Adds paths, rays and truncated paths to
// `counts`. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
PhotonCloud trace_photon_cloud(const Plan& plan, const PathPacket& packet, float time,
                               const LightPathSampler& samplers, int threads, WorkCounts& counts) {
  std::vector<std::vector<Photon>> batches((plan.photons + kBatchSize - 1) / kBatchSize);
  trace_all<PhotonTracer>(
      plan, threads, counts, [&](PhotonTracer& tracer, std::uint64_t first, std::uint64_t last) {
        tracer.trace(samplers_of(samplers, first, last), packet, time, batches[first / kBatchSize]);
      });
  std::vector<Photon> photons;  // in the order of their subpaths, for any number of threads
  for (const std::vector<Photon>& batch : batches) photons.insert(photons.end(), batch.begin(), batch.end());
  return {std::move(photons), plan.photons, packet, time};
}

// Traces the plan's light subpaths of one sample and stores them in `light_paths`, replacing its content, to
// be merged within `radius` [m]. Other arguments and errors are as for `trace_photon_cloud`.
void trace_light_subpaths(const Plan& plan, const PathPacket& packet, float time, float radius,
                          const LightPathSampler& samplers, int threads, LightSubpaths& light_paths,
                          WorkCounts& counts) {
  light_paths.begin(plan.photons, packet, time);
  trace_all<LightRecorder>(
      plan, threads, counts, [&](LightRecorder& recorder, std::uint64_t first, std::uint64_t last) {
        light_paths.store(first / kBatchSize,
                          recorder.record(samplers_of(samplers, first, last), packet, time));
      });
  light_paths.finish(radius);
}

}  // namespace

std::vector<Crop> tiles_done(const FilmShape& shape, std::uint32_t items) {
  const std::uint32_t tiles_x = ceil_div(static_cast<std::uint64_t>(shape.width), kTile);
  const auto edge = [](std::uint64_t tiles, int end) {
    return static_cast<int>(std::min(tiles * kTile, static_cast<std::uint64_t>(end)));
  };
  const int top = edge(items / tiles_x, shape.height);
  const Crop pixels = pixels_of(shape);
  std::vector<Crop> done;
  for (const Crop& rows :
       {Crop{0, 0, shape.width, top}, Crop{0, top, edge(items % tiles_x, shape.width),
                                           edge(std::uint64_t{items} / tiles_x + 1, shape.height)}}) {
    const Crop clipped{std::max(rows.x0, pixels.x0), std::max(rows.y0, pixels.y0),
                       std::min(rows.x1, pixels.x1), std::min(rows.y1, pixels.y1)};
    if (clipped.x0 < clipped.x1 && clipped.y0 < clipped.y1) done.push_back(clipped);
  }
  return done;
}

// The work items of a pass, with the films and the random numbers that they use.
class Pass::Items {
 public:
  Items(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples,
        std::uint32_t done, std::uint64_t seed, const AuxiliaryFilms& auxiliary)
      : plan_(plan),
        film_(film),
        auxiliary_(auxiliary),
        crop_(crop.value_or(Crop{0, 0, film.width(), film.height()})),
        displaces_wavelengths_(traits(plan.scene.camera).displaces_wavelengths),
        samples_(samples),
        seed_(seed),
        tiles_x_(ceil_div(static_cast<std::uint64_t>(film.width()), kTile)),
        tiles_(tiles_x_ * ceil_div(static_cast<std::uint64_t>(film.height()), kTile)),
        sample_by_sample_(
            any_technique([](const IntegratorTraits& t) { return t.merging != Merging::none; })),
        repeats_paths_(any_technique([](const IntegratorTraits& t) { return t.repeats_paths; })),
        next_(done) {
    for (const Technique technique : plan.techniques) stages_.push_back(stage_of(technique));
    // Tiles trace the features of their pixels themselves, so that both have the same finished pixels.
    // Without tiles, features need a stage of their own.
    if (auxiliary_.features != nullptr && std::ranges::none_of(plan.techniques, starts_at_camera))
      stages_.push_back({tiles_, &Items::trace_tile_features});
    for (const Stage& stage : stages_) items_ += stage.items;
  }

  WorkCounts run(int threads, const std::function<bool()>& pause) {
    if (!sample_by_sample_) return run_until(items_, threads, pause);
    WorkCounts total;
    for (bool paused = false; !paused && !finished();) {
      const std::uint32_t sample = next_ / tiles_;
      WorkCounts discarded;  // the interrupted run has already counted them
      if (sample_of_light_paths_ != sample)
        trace_sample_subpaths(samples_.first + sample, threads, next_ % tiles_ == 0 ? total : discarded);
      sample_of_light_paths_ = sample;
      total += run_until((sample + 1) * tiles_, threads, pause);
      paused = next_ < (sample + 1) * tiles_;
    }
    return total;
  }

  [[nodiscard]] std::uint32_t done() const { return std::min(next_.load(), items_); }
  [[nodiscard]] bool finished() const { return done() == items_; }

 private:
  // State of one thread, reused for all its items.
  struct Worker {
    Worker(const Plan& plan, const FeatureFilm* features)
        : caster(plan.scene), tracers(plan, caster, 1.0 / static_cast<double>(plan.photons)) {
      if (features != nullptr) feature_tracer.emplace(plan, features->features(), caster);
    }
    Worker(const Worker&) = delete;  // the tracers refer to the caster
    Worker& operator=(const Worker&) = delete;

    RayCaster caster;
    Tracers tracers;
    std::optional<FeatureTracer> feature_tracer;  // if features are requested
    std::vector<PixelSample> pixels;
    std::vector<PixelPair> pairs;
    std::vector<Sampler> photons;
    std::vector<double> values;  // weighted film values of one contribution
    WorkCounts counts;
  };

  // The work items of one technique.
  struct Stage {
    std::uint32_t items;
    void (Items::*work)(std::uint32_t item, Worker& worker);
  };
  // Top left pixel of a tile.
  struct Tile {
    int x0, y0;
  };

  template <typename Holds>
  [[nodiscard]] bool any_technique(Holds holds) const {
    return std::ranges::any_of(plan_.techniques, holds, [](Technique one) { return traits(one); });
  }

  [[nodiscard]] Stage stage_of(Technique technique) const {
    const std::uint32_t batches = ceil_div(plan_.photons, kPhotonBatch);
    const std::uint32_t all_tiles = tiles_ * static_cast<std::uint32_t>(samples_.last - samples_.first);
    switch (traits(technique).traces) {
      case TracedPaths::camera:
        return {tiles_, &Items::render_tile<&Tracers::path>};
      case TracedPaths::light:
        return {batches, &Items::trace_batch<&Tracers::light>};
      case TracedPaths::both:
        return traits(technique).merging == Merging::none ? Stage{tiles_, &Items::connect_tile}
                                                          : Stage{all_tiles, &Items::merge_tile};
      case TracedPaths::photons:
        return {all_tiles, &Items::gather_tile};
      case TracedPaths::light_by_chance:
        return {batches, &Items::trace_batch<&Tracers::brute_photon>};
      case TracedPaths::camera_by_chance:
        return {tiles_, &Items::render_tile<&Tracers::adjoint_brute>};
    }
    throw Error(ErrorCode::internal, "", "no such technique");
  }

  WorkCounts run_until(std::uint32_t end, int threads, const std::function<bool()>& pause) {
    WorkCounts total;
    std::mutex mutex;
    run_on_threads(threads, [&] {
      const WorkCounts counts = work(end, pause);
      const std::scoped_lock lock(mutex);
      total += counts;
    });
    next_ = std::min(next_.load(), end);  // each thread has taken one number too many
    return total;
  }

  void trace_sample_subpaths(std::uint64_t sample, int threads, WorkCounts& counts) {
    const LightPathSampler samplers = [&](std::uint64_t path) { return photon_sampler(sample, path); };
    const std::array<float, 4> shared = sample_random_numbers(sample);
    const PathPacket packet = draw_packet(plan_.wavelengths, shared[0]);
    if (!gathers_photons(plan_.techniques.front())) {
      trace_light_subpaths(plan_, packet, shared[1], gather_radius(plan_.gather_radius, sample), samplers,
                           threads, light_paths_, counts);
      return;
    }
    cloud_.reset();  // first, so that only one cloud takes memory
    cloud_ = trace_photon_cloud(plan_, packet, shared[1], samplers, threads, counts);
  }

  WorkCounts work(std::uint32_t end, const std::function<bool()>& pause) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    Worker worker(plan_, auxiliary_.features);
    for (std::uint32_t item = next_++; item < end; item = next_++) {
      do_item(item, worker);
      if (pause()) break;
    }
    worker.counts.rays = worker.caster.rays();
    worker.counts.cut = worker.caster.truncated();
    return worker.counts;
  }

  void do_item(std::uint32_t item, Worker& worker) {
    for (const Stage& stage : stages_) {
      if (item < stage.items) return (this->*stage.work)(item, worker);
      item -= stage.items;
    }
  }

  template <auto tracer>  // member of `Tracers`
  void render_tile(std::uint32_t number, Worker& worker) {
    for (std::uint64_t s = samples_.first; s < samples_.last; ++s) {
      trace_features(tile(number), s, worker);
      select_pixels(tile(number), s, worker);
      (worker.tracers.*tracer).set_layer_sink(layer_deposit(s, plan_.path_interval, worker));
      (worker.tracers.*tracer).trace(worker.pixels, deposit(s, plan_.path_interval, worker));
    }
  }

  void gather_tile(std::uint32_t item, Worker& worker) {
    const std::uint64_t sample = samples_.first + item / tiles_;
    GatherKernel kernel{gather_radius(plan_.gather_radius, sample)};
    if (traits(plan_.techniques.front()).merging == Merging::nearest) {
      const PhotonSettings& settings = plan_.scene.render.photons;
      kernel.nearest = static_cast<std::size_t>(settings.nearest);
      kernel.final_gather = settings.final_gather;
    }
    trace_features(tile(item % tiles_), sample, worker);
    select_pixels(tile(item % tiles_), sample, worker);
    worker.tracers.photon_gatherer.set_layer_sink(layer_deposit(sample, plan_.path_interval, worker));
    worker.tracers.photon_gatherer.trace(worker.pixels, *cloud_, kernel,
                                         deposit(sample, plan_.path_interval, worker));
  }

  void connect_tile(std::uint32_t number, Worker& worker) {
    for (std::uint64_t s = samples_.first; s < samples_.last; ++s) {
      trace_features(tile(number), s, worker);
      select_pairs(tile(number), s, worker);
      worker.counts.paths += worker.pairs.size();  // the light subpaths
      worker.tracers.bidirectional.set_layer_sink(layer_deposit(s, 1, worker));
      worker.tracers.bidirectional.trace(worker.pairs, deposit(s, 1, worker));
    }
  }

  void merge_tile(std::uint32_t item, Worker& worker) {
    const std::uint64_t sample = samples_.first + item / tiles_;
    trace_features(tile(item % tiles_), sample, worker);
    select_pairs(tile(item % tiles_), sample, worker);
    worker.tracers.bidirectional.set_layer_sink(layer_deposit(sample, 1, worker));
    worker.tracers.bidirectional.trace(worker.pairs, light_paths_, deposit(sample, 1, worker));
  }

  void trace_tile_features(std::uint32_t number, Worker& worker) {
    for (std::uint64_t s = samples_.first; s < samples_.last; ++s) trace_features(tile(number), s, worker);
  }

  // Traces the features of a sample in a tile, for all pixels of the crop, with or without a camera path.
  void trace_features(const Tile& tile, std::uint64_t sample, Worker& worker) {
    if (auxiliary_.features == nullptr) return;
    select_pixels(
        tile, crop_, sample, [&](int, int) { return std::optional(sequence_index(sample)); }, worker);
    worker.feature_tracer->trace(worker.pixels, sample == 0,
                                 [this](const PixelSample& at, std::span<const double> values) {
                                   auxiliary_.features->add(pixel_index(at.x, at.y), values);
                                 });
  }

  template <auto tracer>  // member of `Tracers`
  void trace_batch(std::uint32_t batch, Worker& worker) {
    const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
    const std::uint64_t end = std::min(begin + kPhotonBatch, plan_.photons);
    for (std::uint64_t s = samples_.first; s < samples_.last; ++s) {
      const Deposit splat = deposit(s, 1, worker);
      (worker.tracers.*tracer).set_layer_sink(layer_deposit(s, 1, worker));
      for (std::uint64_t first = begin; first < end; first += kBatchSize) {
        select_photons(s, first, std::min<std::uint64_t>(first + kBatchSize, end), worker);
        (worker.tracers.*tracer).trace(worker.photons, splat);
      }
    }
  }

  [[nodiscard]] Tile tile(std::uint32_t number) const {
    return {static_cast<int>(number % tiles_x_ * kTile), static_cast<int>(number / tiles_x_ * kTile)};
  }

  // Selects the pixels of a tile inside a crop for which `path_index` returns a path.
  template <typename PathIndex>
  void select_pixels(const Tile& tile, const Crop& within, std::uint64_t sample, PathIndex path_index,
                     Worker& worker) const {
    constexpr int kEdge = kTile;
    worker.pixels.clear();
    for (int y = std::max(tile.y0, within.y0); y < std::min(tile.y0 + kEdge, within.y1); ++y)
      for (int x = std::max(tile.x0, within.x0); x < std::min(tile.x0 + kEdge, within.x1); ++x)
        if (const std::optional<std::uint32_t> path = path_index(x, y))
          worker.pixels.push_back(
              {x, y, Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), *path, replicate(sample))});
  }

  // Selects one sample of each pixel of a tile. If the camera moves some wavelengths to other pixels, pixels
  // outside the crop take part.
  void select_pixels(const Tile& tile, std::uint64_t sample, Worker& worker) const {
    const Crop within = displaces_wavelengths_ ? Crop{0, 0, film_.width(), film_.height()} : crop_;
    select_pixels(
        tile, within, sample, [&](int x, int y) { return this->path_index(sample, x, y); }, worker);
    worker.counts.paths += worker.pixels.size();
  }

  // All pixels have light subpaths, also those outside the crop. Counts the camera subpaths.
  void select_pairs(const Tile& tile, std::uint64_t sample, Worker& worker) const {
    constexpr int kEdge = kTile;
    worker.pairs.clear();
    for (int y = tile.y0; y < std::min(tile.y0 + kEdge, film_.height()); ++y)
      for (int x = tile.x0; x < std::min(tile.x0 + kEdge, film_.width()); ++x)
        worker.pairs.push_back(
            {x, y,
             Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), sequence_index(sample), replicate(sample)),
             photon_sampler(sample, pixel_index(x, y)), displaces_wavelengths_ || is_requested(x, y)});
    worker.counts.paths +=
        static_cast<std::uint64_t>(std::ranges::count_if(worker.pairs, &PixelPair::exposes_pixel));
  }

  // Selects photons `first` to `last` of a sample.
  void select_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last, Worker& worker) const {
    worker.photons.clear();
    for (std::uint64_t photon = first; photon < last; ++photon)
      worker.photons.push_back(photon_sampler(sample, photon));
    worker.counts.paths += worker.photons.size();
  }

  [[nodiscard]] Sampler photon_sampler(std::uint64_t sample, std::uint64_t photon) const {
    const std::uint64_t number = sequence_index(sample) * plan_.photons + photon;
    constexpr std::uint64_t kStreamLength = 1U << Sampler::kIndexBits;
    return {seed_,
            Purpose::light,
            0,
            static_cast<std::uint32_t>(number / kStreamLength),
            static_cast<std::uint32_t>(number % kStreamLength),
            replicate(sample)};
  }

  // Random numbers of the wavelengths and the time. All paths of a sample have them in common if they are
  // connected or merged across pixels.
  [[nodiscard]] std::array<float, 4> sample_random_numbers(std::uint64_t sample) const {
    return Sampler(seed_, Purpose::sample, 0, 0, sequence_index(sample), replicate(sample)).group(0);
  }

  // Index of the camera path of a sample at a pixel; empty if the pixel skips the sample. A random phase for
  // each pixel and replicate selects the skipped samples, so that the mean over any samples is unbiased.
  [[nodiscard]] std::optional<std::uint32_t> path_index(std::uint64_t sample, int x, int y) const {
    if (repeats_paths_) return 0;
    const std::uint32_t interval = plan_.path_interval;
    if (interval == 1) return sequence_index(sample);
    const float u =
        Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), 0, replicate(sample)).group(kPhaseGroup)[0];
    const std::uint32_t at =
        sequence_index(sample) + static_cast<std::uint32_t>(u * static_cast<float>(interval));
    return at % interval == 0 ? std::optional(at / interval) : std::nullopt;
  }

  [[nodiscard]] Replicate replicate(std::uint64_t sample) const {
    const auto replicates = static_cast<std::uint32_t>(film_.replicates());
    return {static_cast<std::uint32_t>(sample % replicates), replicates};
  }
  [[nodiscard]] std::uint32_t sequence_index(std::uint64_t sample) const {
    return static_cast<std::uint32_t>(sample / static_cast<std::uint64_t>(film_.replicates()));
  }
  [[nodiscard]] bool is_requested(int x, int y) const {
    return x >= crop_.x0 && x < crop_.x1 && y >= crop_.y0 && y < crop_.y1;
  }
  [[nodiscard]] std::uint32_t pixel_index(int x, int y) const {
    return static_cast<std::uint32_t>(y * film_.width() + x);
  }

  // Stores the weighted values in the worker. Returns true if the film can add them.
  [[nodiscard]] bool weight_values(std::span<const double> values, double weight, Worker& worker) const {
    worker.values.assign(values.begin(), values.end());
    for (double& value : worker.values) value *= weight;
    return std::ranges::all_of(worker.values, [this](double v) { return film_.holds(v); });
  }

  // Adds values to the film, times `weight`. Light may end at any pixel; those outside the crop discard it.
  [[nodiscard]] Deposit deposit(std::uint64_t sample, double weight, Worker& worker) {
    return [=, this, &worker](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
      if (!is_requested(at.x, at.y)) return;
      if (weight_values(values, weight, worker))
        film_.add(pixel_index(at.x, at.y), static_cast<int>(replicate(sample).number), worker.values);
      else
        ++worker.counts.nonfinite_samples;
    };
  }

  // Adds contributions to their layers; empty if none are requested.
  [[nodiscard]] ContributionDeposit layer_deposit(std::uint64_t sample, double weight, Worker& worker) {
    if (auxiliary_.layers == nullptr) return {};
    return [=, this, &worker](std::uint32_t, const FilmPoint& at, const ContributionInfo& history,
                              std::span<const double> values) {
      if (is_requested(at.x, at.y) && weight_values(values, weight, worker))
        auxiliary_.layer_sums->add(pixel_index(at.x, at.y), static_cast<int>(replicate(sample).number),
                                   worker.values, auxiliary_.layers->layer_of(history) * values.size());
    };
  }

  const Plan& plan_;
  Film& film_;
  AuxiliaryFilms auxiliary_;
  Crop crop_;
  bool displaces_wavelengths_;  // the camera moves some wavelengths to other pixels
  SampleRange samples_;
  std::uint64_t seed_;
  std::uint32_t tiles_x_;
  std::uint32_t tiles_;
  std::vector<Stage> stages_;
  std::uint32_t items_ = 0;  // of all stages
  bool sample_by_sample_;
  bool repeats_paths_;  // all samples have the same camera paths
  // sample of the pass to which `cloud_` or `light_paths_` belongs
  std::optional<std::uint32_t> sample_of_light_paths_;
  std::optional<PhotonCloud> cloud_;
  LightSubpaths light_paths_;
  std::atomic<std::uint32_t> next_;
};

Pass::Pass(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples,
           std::uint32_t done, std::uint64_t seed, const AuxiliaryFilms& auxiliary)
    : items_(std::make_unique<Items>(plan, film, crop, samples, done, seed, auxiliary)) {}
Pass::~Pass() = default;

WorkCounts Pass::run(int threads, const std::function<bool()>& pause) {
  return items_->run(threads, pause);
}
std::uint32_t Pass::done() const {
  return items_->done();
}
bool Pass::finished() const {
  return items_->finished();
}

std::size_t bytes_of_light_paths(const Scene& scene) {
  constexpr std::size_t kTypicalVertices = 4;
  if (traits(scene.render.integrator).merging == Merging::none) return 0;
  const std::size_t paths = photons_of_sample(scene);
  const std::size_t polarisation_bytes = carries_polarisation(scene) ? sizeof(Polarisation) : 0;
  if (gathers_photons(scene.render.integrator))
    return paths * kTypicalVertices * (sizeof(Photon) + PhotonMap::kBytesOfPoint + polarisation_bytes);
  return paths * (LightSubpaths::kBytesOfPath +
                  kTypicalVertices * (LightSubpaths::kBytesOfVertex + polarisation_bytes));
}

}  // namespace abbe
