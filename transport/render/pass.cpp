#include "transport/render/pass.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include <pmmintrin.h>

#include "io/error.h"
#include "scene/scene_features.h"
#include "transport/path/dimensions.h"
#include "transport/render/threads.h"
#include "transport/technique/path_starts.h"

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
void trace_all(const Plan& plan, int threads, PassCounts& counts, const Batch& batch) {
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
                               const LightPathSampler& samplers, int threads, PassCounts& counts) {
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
                          PassCounts& counts) {
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

Pass::Pass(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples,
           std::uint32_t done, std::uint64_t seed, const AuxiliaryFilms& auxiliary)
    : plan_(plan),
      scene_(plan.scene),
      film_(film),
      auxiliary_(auxiliary),
      crop_(crop.value_or(Crop{0, 0, film.width(), film.height()})),
      displaces_wavelengths_(traits(plan.scene.camera).displaces_wavelengths),
      first_(samples.first),
      last_(samples.last),
      seed_(seed),
      next_(done) {
  tiles_x_ = ceil_div(static_cast<std::uint64_t>(film.width()), kTile);
  tiles_ = tiles_x_ * ceil_div(static_cast<std::uint64_t>(film.height()), kTile);
  photons_ = plan.photons;
  path_interval_ = plan.path_interval;
  sample_by_sample_ = std::ranges::any_of(
      plan.techniques, [](Technique technique) { return traits(technique).merging != Merging::none; });
  repeats_paths_ = std::ranges::any_of(plan.techniques,
                                       [](Technique technique) { return traits(technique).repeats_paths; });
  for (const Technique technique : plan.techniques) stages_.push_back(stage_of(technique));
  // Tiles trace the features of their pixels themselves, so that both have the same finished pixels. Without
  // tiles, features need a stage of their own.
  if (auxiliary_.features != nullptr && std::ranges::none_of(plan.techniques, starts_at_camera))
    stages_.push_back({tiles_, &Pass::trace_tile_features});
  for (const Stage& stage : stages_) items_ += stage.items;
}

Pass::Stage Pass::stage_of(Technique technique) const {
  const std::uint32_t batches = ceil_div(photons_, kPhotonBatch);
  const std::uint32_t all_tiles = tiles_ * static_cast<std::uint32_t>(last_ - first_);
  switch (traits(technique).traces) {
    case TracedPaths::camera:
      return {tiles_, &Pass::render_tile<&Worker::path_tracer>};
    case TracedPaths::light:
      return {batches, &Pass::trace_batch};
    case TracedPaths::both:
      return traits(technique).merging == Merging::none ? Stage{tiles_, &Pass::connect_tile}
                                                        : Stage{all_tiles, &Pass::merge_tile};
    case TracedPaths::photons:
      return {all_tiles, &Pass::gather_tile};
    case TracedPaths::light_by_chance:
      return {batches, &Pass::trace_batch_brutely};
    case TracedPaths::camera_by_chance:
      return {tiles_, &Pass::render_tile<&Worker::adjoint_brute_tracer>};
  }
  throw Error(ErrorCode::internal, "", "no such technique");
}

PassCounts Pass::run(int threads, const std::function<bool()>& pause) {
  if (!sample_by_sample_) return run_until(items_, threads, pause);
  PassCounts total;
  for (bool paused = false; !paused && !finished();) {
    const std::uint32_t sample = next_ / tiles_;
    PassCounts discarded;  // the interrupted run has already counted them
    if (sample_of_cloud_ != sample)
      trace_sample_subpaths(first_ + sample, threads, next_ % tiles_ == 0 ? total : discarded);
    sample_of_cloud_ = sample;
    total += run_until((sample + 1) * tiles_, threads, pause);
    paused = next_ < (sample + 1) * tiles_;
  }
  return total;
}

PassCounts Pass::run_until(std::uint32_t end, int threads, const std::function<bool()>& pause) {
  PassCounts total;
  std::mutex mutex;
  run_on_threads(threads, [&] {
    const PassCounts counts = work(end, pause);
    const std::scoped_lock lock(mutex);
    total += counts;
  });
  next_ = std::min(next_.load(), end);  // each thread has taken one number too many
  return total;
}

void Pass::trace_sample_subpaths(std::uint64_t sample, int threads, PassCounts& counts) {
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

PassCounts Pass::work(std::uint32_t end, const std::function<bool()>& pause) {
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

void Pass::do_item(std::uint32_t item, Worker& worker) {
  for (const Stage& stage : stages_) {
    if (item < stage.items) return (this->*stage.work)(item, worker);
    item -= stage.items;
  }
}

Replicate Pass::replicate(std::uint64_t sample) const {
  const auto replicates = static_cast<std::uint32_t>(film_.replicates());
  return {static_cast<std::uint32_t>(sample % replicates), replicates};
}

bool Pass::is_representable(std::span<const double> values) const {
  return std::all_of(values.begin(), values.end(), [this](double v) { return film_.holds(v); });
}

bool Pass::accept(std::span<const double> values, Worker& worker) const {
  const bool good = is_representable(values);
  if (!good) ++worker.counts.nonfinite;
  return good;
}

std::uint32_t Pass::sequence_index(std::uint64_t sample) const {
  return static_cast<std::uint32_t>(sample / static_cast<std::uint64_t>(film_.replicates()));
}

Pass::Tile Pass::tile(std::uint32_t number) const {
  return {static_cast<int>(number % tiles_x_ * kTile), static_cast<int>(number / tiles_x_ * kTile)};
}

// Random numbers of the wavelengths and the time. All paths of a sample have them in common if they are
// connected or merged across pixels.
std::array<float, 4> Pass::sample_random_numbers(std::uint64_t sample) const {
  return Sampler(seed_, Purpose::sample, 0, 0, sequence_index(sample), replicate(sample)).group(0);
}

// Index of the camera path of a sample at a pixel; empty if the pixel skips the sample. A random phase for
// each pixel and replicate selects the skipped samples, so that the mean over any samples is unbiased.
std::optional<std::uint32_t> Pass::path_index(std::uint64_t sample, int x, int y) const {
  if (repeats_paths_) return 0;
  if (path_interval_ == 1) return sequence_index(sample);
  const float u =
      Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), 0, replicate(sample)).group(kPhaseGroup)[0];
  const std::uint32_t at =
      sequence_index(sample) + static_cast<std::uint32_t>(u * static_cast<float>(path_interval_));
  return at % path_interval_ == 0 ? std::optional(at / path_interval_) : std::nullopt;
}

// Selects the pixels of a tile inside a crop for which `path_index` returns a path.
template <typename PathIndex>
void Pass::select_pixels(const Tile& tile, const Crop& within, std::uint64_t sample, PathIndex path_index,
                         Worker& worker) const {
  constexpr int kEdge = kTile;
  worker.pixels.clear();
  for (int y = std::max(tile.y0, within.y0); y < std::min(tile.y0 + kEdge, within.y1); ++y)
    for (int x = std::max(tile.x0, within.x0); x < std::min(tile.x0 + kEdge, within.x1); ++x)
      if (const std::optional<std::uint32_t> path = path_index(x, y))
        worker.pixels.push_back(
            {x, y, Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), *path, replicate(sample)),
             static_cast<double>(path_interval_)});
}

// Selects one sample of each pixel of a tile. If the camera moves some wavelengths to other pixels, pixels
// outside the crop take part.
void Pass::select_pixels(const Tile& tile, std::uint64_t sample, Worker& worker) const {
  const Crop within = displaces_wavelengths_ ? Crop{0, 0, film_.width(), film_.height()} : crop_;
  select_pixels(
      tile, within, sample, [&](int x, int y) { return this->path_index(sample, x, y); }, worker);
  worker.counts.paths += worker.pixels.size();
}

// All pixels have light subpaths, also those outside the crop.
void Pass::select_pairs(const Tile& tile, std::uint64_t sample, Worker& worker) const {
  constexpr int kEdge = kTile;
  worker.pairs.clear();
  for (int y = tile.y0; y < std::min(tile.y0 + kEdge, film_.height()); ++y)
    for (int x = tile.x0; x < std::min(tile.x0 + kEdge, film_.width()); ++x)
      worker.pairs.push_back(
          {x, y,
           Sampler(seed_, Purpose::camera, 0, pixel_index(x, y), sequence_index(sample), replicate(sample)),
           photon_sampler(sample, pixel_index(x, y)), is_sampled(x, y)});
}

// Selects photons `first` to `last` of a sample.
void Pass::select_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last,
                          Worker& worker) const {
  worker.photons.clear();
  for (std::uint64_t photon = first; photon < last; ++photon)
    worker.photons.push_back(photon_sampler(sample, photon));
  worker.counts.paths += worker.photons.size();
}

Sampler Pass::photon_sampler(std::uint64_t sample, std::uint64_t photon) const {
  const std::uint64_t number = sequence_index(sample) * photons_ + photon;
  constexpr std::uint64_t kStreamLength = 1U << Sampler::kIndexBits;
  return {seed_,
          Purpose::light,
          0,
          static_cast<std::uint32_t>(number / kStreamLength),
          static_cast<std::uint32_t>(number % kStreamLength),
          replicate(sample)};
}

// Returns the weighted values, stored in the worker.
std::span<const double> Pass::weighted(std::span<const double> values, double weight, Worker& worker) {
  worker.values.assign(values.begin(), values.end());
  for (double& value : worker.values) value *= weight;
  return worker.values;
}

void Pass::deposit(std::uint64_t sample, const FilmPoint& at, std::span<const double> values, double weight,
                   Worker& worker) {
  if (is_requested(at.x, at.y) && accept(weighted(values, weight, worker), worker))
    film_.add(pixel_index(at.x, at.y), static_cast<int>(replicate(sample).number), worker.values);
}

// Adds a contribution to its layer.
void Pass::deposit_to_layer(std::uint64_t sample, const FilmPoint& at, const ContributionInfo& history,
                            std::span<const double> values, double weight, Worker& worker) {
  if (is_requested(at.x, at.y) && is_representable(weighted(values, weight, worker)))
    auxiliary_.layer_sums->add(pixel_index(at.x, at.y), static_cast<int>(replicate(sample).number),
                               worker.values, auxiliary_.layers->layer_of(history) * values.size());
}

Deposit Pass::pixel_deposit(std::uint64_t sample, Worker& worker) {
  return [=, this, &worker](std::uint32_t path, const FilmPoint& at, std::span<const double> values) {
    deposit(sample, at, values, worker.pixels[path].weight, worker);
  };
}

ContributionDeposit Pass::pixel_layer_deposit(std::uint64_t sample, Worker& worker) {
  if (auxiliary_.layers == nullptr) return {};
  return [=, this, &worker](std::uint32_t path, const FilmPoint& at, const ContributionInfo& history,
                            std::span<const double> values) {
    deposit_to_layer(sample, at, history, values, worker.pixels[path].weight, worker);
  };
}

// Light subpaths may end at any pixel of the film; pixels outside the crop discard them.
Deposit Pass::splat_deposit(std::uint64_t sample, Worker& worker) {
  return [=, this, &worker](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    deposit(sample, at, values, 1, worker);
  };
}

ContributionDeposit Pass::splat_layer_deposit(std::uint64_t sample, Worker& worker) {
  if (auxiliary_.layers == nullptr) return {};
  return [=, this, &worker](std::uint32_t, const FilmPoint& at, const ContributionInfo& history,
                            std::span<const double> values) {
    deposit_to_layer(sample, at, history, values, 1, worker);
  };
}

// Traces the features of a sample in a tile, for all pixels of the crop, with or without a camera path.
void Pass::trace_features(const Tile& tile, std::uint64_t sample, Worker& worker) {
  if (auxiliary_.features == nullptr) return;
  select_pixels(
      tile, crop_, sample, [&](int, int) { return std::optional(sequence_index(sample)); }, worker);
  worker.feature_tracer->trace(worker.pixels, sample == 0,
                               [this](const PixelSample& at, std::span<const double> values) {
                                 auxiliary_.features->add(pixel_index(at.x, at.y), values);
                               });
}

void Pass::trace_tile_features(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) trace_features(tile(number), s, worker);
}

template <auto tracer>
void Pass::render_tile(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) {
    trace_features(tile(number), s, worker);
    select_pixels(tile(number), s, worker);
    (worker.*tracer).set_layer_sink(pixel_layer_deposit(s, worker));
    (worker.*tracer).trace(worker.pixels, pixel_deposit(s, worker));
  }
}

void Pass::gather_tile(std::uint32_t item, Worker& worker) {
  const std::uint64_t sample = first_ + item / tiles_;
  GatherKernel kernel{gather_radius(plan_.gather_radius, sample)};
  if (traits(plan_.techniques.front()).merging == Merging::nearest) {
    kernel.nearest = static_cast<std::size_t>(scene_.render.photons.nearest);
    kernel.final_gather = scene_.render.photons.final_gather;
  }
  trace_features(tile(item % tiles_), sample, worker);
  select_pixels(tile(item % tiles_), sample, worker);
  worker.photon_gatherer.set_layer_sink(pixel_layer_deposit(sample, worker));
  worker.photon_gatherer.trace(worker.pixels, *cloud_, kernel, pixel_deposit(sample, worker));
}

void Pass::connect_tile(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) {
    trace_features(tile(number), s, worker);
    select_pairs(tile(number), s, worker);
    for (const PixelPair& pair : worker.pairs) worker.counts.paths += pair.exposes_pixel ? 2 : 1;
    worker.bidirectional_tracer.set_layer_sink(splat_layer_deposit(s, worker));
    worker.bidirectional_tracer.trace(worker.pairs, splat_deposit(s, worker));
  }
}

void Pass::merge_tile(std::uint32_t item, Worker& worker) {
  const std::uint64_t sample = first_ + item / tiles_;
  trace_features(tile(item % tiles_), sample, worker);
  select_pairs(tile(item % tiles_), sample, worker);
  for (const PixelPair& pair : worker.pairs) worker.counts.paths += pair.exposes_pixel ? 1 : 0;
  worker.bidirectional_tracer.set_layer_sink(splat_layer_deposit(sample, worker));
  worker.bidirectional_tracer.trace(worker.pairs, light_paths_, splat_deposit(sample, worker));
}

void Pass::trace_batch(std::uint32_t batch, Worker& worker) {
  const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
  const std::uint64_t end = std::min(begin + kPhotonBatch, photons_);
  for (std::uint64_t s = first_; s < last_; ++s) {
    const Deposit deposit = splat_deposit(s, worker);
    worker.light_tracer.set_layer_sink(splat_layer_deposit(s, worker));
    for (std::uint64_t first = begin; first < end; first += kBatchSize) {
      select_photons(s, first, std::min<std::uint64_t>(first + kBatchSize, end), worker);
      worker.light_tracer.trace(worker.photons, deposit);
    }
  }
}

void Pass::trace_batch_brutely(std::uint32_t batch, Worker& worker) {
  const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
  const std::uint64_t end = std::min(begin + kPhotonBatch, photons_);
  for (std::uint64_t s = first_; s < last_; ++s) {
    select_photons(s, begin, end, worker);
    worker.brute_photon_tracer.set_layer_sink(splat_layer_deposit(s, worker));
    worker.brute_photon_tracer.trace(worker.photons, splat_deposit(s, worker));
  }
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
