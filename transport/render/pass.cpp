#include "transport/render/pass.h"

#include <pmmintrin.h>

#include <algorithm>
#include <mutex>

#include "io/error.h"
#include "transport/path/dimensions.h"
#include "transport/render/collect.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

constexpr std::uint32_t kTile = 16;
constexpr std::uint32_t kPhotonBatch = 4096;

constexpr std::uint32_t pieces(std::uint64_t whole, std::uint32_t piece) {
  return static_cast<std::uint32_t>((whole + piece - 1) / piece);
}

// Whether the work items of a technique are tiles, not batches of photons.
bool goes_by_tiles(Technique technique) {
  return technique != Technique::light && technique != Technique::photon_brute;
}

}  // namespace

std::vector<Crop> tiles_done(const FilmShape& shape, std::uint32_t items) {
  const std::uint32_t tiles_x = pieces(static_cast<std::uint64_t>(shape.width), kTile);
  const auto edge = [](std::uint64_t tiles, int end) {
    return static_cast<int>(std::min(tiles * kTile, static_cast<std::uint64_t>(end)));
  };
  const int top = edge(items / tiles_x, shape.height);
  const Crop pixels = pixels_of(shape);
  std::vector<Crop> done;
  for (const Crop& rows :
       {Crop{0, 0, shape.width, top}, Crop{0, top, edge(items % tiles_x, shape.width),
                                           edge(std::uint64_t{items} / tiles_x + 1, shape.height)}}) {
    const Crop kept{std::max(rows.x0, pixels.x0), std::max(rows.y0, pixels.y0), std::min(rows.x1, pixels.x1),
                    std::min(rows.y1, pixels.y1)};
    if (kept.x0 < kept.x1 && kept.y0 < kept.y1) done.push_back(kept);
  }
  return done;
}

Pass::Pass(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples,
           std::uint32_t done, std::uint64_t seed, const BesideFilms& beside)
    : plan_(plan),
      scene_(plan.scene),
      film_(film),
      beside_(beside),
      crop_(crop.value_or(Crop{0, 0, film.width(), film.height()})),
      displaces_lanes_(traits(plan.scene.camera).displaces_lanes),
      first_(samples.first),
      last_(samples.last),
      seed_(seed),
      next_(done) {
  tiles_x_ = pieces(static_cast<std::uint64_t>(film.width()), kTile);
  tiles_ = tiles_x_ * pieces(static_cast<std::uint64_t>(film.height()), kTile);
  photons_ = plan.photons;
  path_interval_ = plan.path_interval;
  sample_by_sample_ = uses(plan.techniques, Technique::vcm) ||
                      std::any_of(plan.techniques.begin(), plan.techniques.end(), gathers_photons);
  for (const Technique technique : plan.techniques) stages_.push_back(stage_of(technique));
  // Tiles look at the features of their pixels themselves, so that what is done of them is done of both.
  if (beside_.features != nullptr &&
      std::none_of(plan.techniques.begin(), plan.techniques.end(), goes_by_tiles))
    stages_.push_back({tiles_, &Pass::look_at_tile});
  for (const Stage& stage : stages_) items_ += stage.items;
}

Pass::Stage Pass::stage_of(Technique technique) const {
  const std::uint32_t batches = pieces(photons_, kPhotonBatch);
  const std::uint32_t all_tiles = tiles_ * static_cast<std::uint32_t>(last_ - first_);
  switch (technique) {
    case Technique::path:
      return {tiles_, &Pass::render_tile};
    case Technique::light:
      return {batches, &Pass::trace_batch};
    case Technique::bdpt:
      return {tiles_, &Pass::join_tile};
    case Technique::photon_map:
    case Technique::ppm:
    case Technique::sppm:
      return {all_tiles, &Pass::gather_tile};
    case Technique::vcm:
      return {all_tiles, &Pass::merge_tile};
    case Technique::photon_brute:
      return {batches, &Pass::trace_batch_brutely};
    case Technique::adjoint_brute:
      return {tiles_, &Pass::render_tile_brutely};
  }
  throw Error(ErrorCode::internal, "", "no such technique");
}

PassCounts Pass::run(int threads, const std::function<bool()>& pause) {
  if (!sample_by_sample_) return run_until(items_, threads, pause);
  PassCounts total;
  for (bool paused = false; !paused && !finished();) {
    const std::uint32_t sample = next_ / tiles_;
    PassCounts again;  // by a run that was interrupted, these were counted
    if (left_by_ != sample) collect(first_ + sample, threads, next_ % tiles_ == 0 ? total : again);
    left_by_ = sample;
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
  next_ = std::min(next_.load(), end);  // each thread has asked for one more than there are
  return total;
}

void Pass::collect(std::uint64_t sample, int threads, PassCounts& counts) {
  const LightNumbers numbers = [&](std::uint64_t path) { return photon_sampler(sample, path); };
  const std::array<float, 4> common = numbers_of(sample);
  const PathPacket packet = draw_packet(plan_.wavelengths, common[0]);
  if (uses(plan_.techniques, Technique::vcm)) {
    collect_light_paths(plan_, packet, common[1], gather_radius(plan_.gather_radius, sample), numbers,
                        threads, light_paths_, counts);
    return;
  }
  cloud_.reset();  // first, as both would take their memory
  cloud_ = collect_photons(plan_, packet, common[1], numbers, threads, counts);
}

PassCounts Pass::work(std::uint32_t end, const std::function<bool()>& pause) {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  Worker worker(plan_, beside_.features);
  for (std::uint32_t item = next_++; item < end; item = next_++) {
    do_item(item, worker);
    if (pause()) break;
  }
  worker.counts.rays = worker.caster.rays();
  worker.counts.cut = worker.caster.cut();
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

bool Pass::holds(std::span<const double> values) const {
  return std::all_of(values.begin(), values.end(), [this](double v) { return film_.holds(v); });
}

bool Pass::keeps(std::span<const double> values, Worker& worker) const {
  const bool good = holds(values);
  if (!good) ++worker.counts.nonfinite;
  return good;
}

std::uint32_t Pass::index(std::uint64_t sample) const {
  return static_cast<std::uint32_t>(sample / static_cast<std::uint64_t>(film_.replicates()));
}

Pass::Tile Pass::tile(std::uint32_t number) const {
  return {static_cast<int>(number % tiles_x_ * kTile), static_cast<int>(number / tiles_x_ * kTile)};
}

// By which all paths of a sample have a packet and a time in common where they are to be joined across
// pixels.
std::array<float, 4> Pass::numbers_of(std::uint64_t sample) const {
  return Sampler(seed_, Purpose::sample, 0, 0, index(sample), replicate(sample)).group(0);
}

// The number of that of a sample at a pixel; none where the pixel skips it. Which samples these are is
// chance, for each pixel and replicate, so that the mean over any of them is right.
std::optional<std::uint32_t> Pass::path_of(std::uint64_t sample, int x, int y) const {
  // Those of progressive photon mapping are the same in all samples.
  if (uses(plan_.techniques, Technique::ppm)) return 0;
  if (path_interval_ == 1) return index(sample);
  const float u =
      Sampler(seed_, Purpose::camera, 0, number_of(x, y), 0, replicate(sample)).group(kPhaseGroup)[0];
  const std::uint32_t at = index(sample) + static_cast<std::uint32_t>(u * static_cast<float>(path_interval_));
  return at % path_interval_ == 0 ? std::optional(at / path_interval_) : std::nullopt;
}

// Of the pixels of a tile within a crop, the path that `path_of` says of each, if any.
template <typename PathOf>
void Pass::take_pixels(const Tile& tile, const Crop& within, std::uint64_t sample, PathOf path_of,
                       Worker& worker) const {
  constexpr int kEdge = kTile;
  worker.pixels.clear();
  for (int y = std::max(tile.y0, within.y0); y < std::min(tile.y0 + kEdge, within.y1); ++y)
    for (int x = std::max(tile.x0, within.x0); x < std::min(tile.x0 + kEdge, within.x1); ++x)
      if (const std::optional<std::uint32_t> path = path_of(x, y))
        worker.pixels.push_back(
            {x, y, Sampler(seed_, Purpose::camera, 0, number_of(x, y), *path, replicate(sample)),
             static_cast<double>(path_interval_)});
}

// One sample of each pixel of a tile: of all, where some of its lanes may fall on others that are asked for.
void Pass::take_pixels(const Tile& tile, std::uint64_t sample, Worker& worker) const {
  const Crop within = displaces_lanes_ ? Crop{0, 0, film_.width(), film_.height()} : crop_;
  take_pixels(
      tile, within, sample, [&](int x, int y) { return this->path_of(sample, x, y); }, worker);
  worker.counts.paths += worker.pixels.size();
}

// The paths from lights are those of all pixels, whichever are asked for.
void Pass::take_pairs(const Tile& tile, std::uint64_t sample, Worker& worker) const {
  constexpr int kEdge = kTile;
  worker.pairs.clear();
  for (int y = tile.y0; y < std::min(tile.y0 + kEdge, film_.height()); ++y)
    for (int x = tile.x0; x < std::min(tile.x0 + kEdge, film_.width()); ++x)
      worker.pairs.push_back(
          {x, y, Sampler(seed_, Purpose::camera, 0, number_of(x, y), index(sample), replicate(sample)),
           photon_sampler(sample, number_of(x, y)), is_sampled(x, y)});
}

// Those from `first` to `last` of a sample.
void Pass::take_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last, Worker& worker) const {
  worker.photons.clear();
  for (std::uint64_t photon = first; photon < last; ++photon)
    worker.photons.push_back(photon_sampler(sample, photon));
  worker.counts.paths += worker.photons.size();
}

Sampler Pass::photon_sampler(std::uint64_t sample, std::uint64_t photon) const {
  const std::uint64_t number = index(sample) * photons_ + photon;
  constexpr std::uint64_t kOfStream = 1U << Sampler::kIndexBits;
  return {seed_,
          Purpose::light,
          0,
          static_cast<std::uint32_t>(number / kOfStream),
          static_cast<std::uint32_t>(number % kOfStream),
          replicate(sample)};
}

// As the films take them.
std::span<const double> Pass::weighted(std::span<const double> values, double weight, Worker& worker) {
  worker.values.assign(values.begin(), values.end());
  for (double& value : worker.values) value *= weight;
  return worker.values;
}

void Pass::deposit(std::uint64_t sample, const FilmPoint& at, std::span<const double> values, double weight,
                   Worker& worker) {
  if (is_asked_for(at.x, at.y) && keeps(weighted(values, weight, worker), worker))
    film_.add(number_of(at.x, at.y), static_cast<int>(replicate(sample).number), worker.values);
}

// What the layers get of what the film gets.
void Pass::deposit_apart(std::uint64_t sample, const FilmPoint& at, const LightHistory& of,
                         std::span<const double> values, double weight, Worker& worker) {
  if (is_asked_for(at.x, at.y) && holds(weighted(values, weight, worker)))
    beside_.layer_sums->add(number_of(at.x, at.y), static_cast<int>(replicate(sample).number), worker.values,
                            beside_.layers->of(of) * values.size());
}

Deposit Pass::pixels_deposit(std::uint64_t sample, Worker& worker) {
  return [=, this, &worker](std::uint32_t path, const FilmPoint& at, std::span<const double> values) {
    deposit(sample, at, values, worker.pixels[path].weight, worker);
  };
}

ContributionDeposit Pass::pixels_apart(std::uint64_t sample, Worker& worker) {
  if (beside_.layers == nullptr) return {};
  return [=, this, &worker](std::uint32_t path, const FilmPoint& at, const LightHistory& of,
                            std::span<const double> values) {
    deposit_apart(sample, at, of, values, worker.pixels[path].weight, worker);
  };
}

// Paths from lights may come to any pixel of the film; those that are not asked for get nothing.
Deposit Pass::splats_of(std::uint64_t sample, Worker& worker) {
  return [=, this, &worker](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    deposit(sample, at, values, 1, worker);
  };
}

ContributionDeposit Pass::splats_apart(std::uint64_t sample, Worker& worker) {
  if (beside_.layers == nullptr) return {};
  return [=, this, &worker](std::uint32_t, const FilmPoint& at, const LightHistory& of,
                            std::span<const double> values) {
    deposit_apart(sample, at, of, values, 1, worker);
  };
}

// What the samples of a tile's pixels see first, whichever of them have camera paths.
void Pass::look(const Tile& tile, std::uint64_t sample, Worker& worker) {
  if (beside_.features == nullptr) return;
  take_pixels(
      tile, crop_, sample, [&](int, int) { return std::optional(index(sample)); }, worker);
  worker.feature_tracer->trace(worker.pixels, sample == 0,
                               [this](const PixelSample& at, std::span<const double> values) {
                                 beside_.features->add(number_of(at.x, at.y), values);
                               });
}

void Pass::look_at_tile(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) look(tile(number), s, worker);
}

void Pass::render_tile(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) {
    look(tile(number), s, worker);
    take_pixels(tile(number), s, worker);
    worker.path_tracer.tell_apart(pixels_apart(s, worker));
    worker.path_tracer.trace(worker.pixels, pixels_deposit(s, worker));
  }
}

void Pass::render_tile_brutely(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) {
    look(tile(number), s, worker);
    take_pixels(tile(number), s, worker);
    worker.adjoint_brute_tracer.tell_apart(pixels_apart(s, worker));
    worker.adjoint_brute_tracer.trace(worker.pixels, pixels_deposit(s, worker));
  }
}

void Pass::gather_tile(std::uint32_t item, Worker& worker) {
  const std::uint64_t sample = first_ + item / tiles_;
  GatherKernel kernel{gather_radius(plan_.gather_radius, sample)};
  if (uses(plan_.techniques, Technique::photon_map)) {
    kernel.nearest = static_cast<std::size_t>(scene_.render.photons.nearest);
    kernel.final_gather = scene_.render.photons.final_gather;
  }
  look(tile(item % tiles_), sample, worker);
  take_pixels(tile(item % tiles_), sample, worker);
  worker.photon_gatherer.tell_apart(pixels_apart(sample, worker));
  worker.photon_gatherer.trace(worker.pixels, *cloud_, kernel, pixels_deposit(sample, worker));
}

void Pass::join_tile(std::uint32_t number, Worker& worker) {
  for (std::uint64_t s = first_; s < last_; ++s) {
    look(tile(number), s, worker);
    take_pairs(tile(number), s, worker);
    for (const PixelPair& pair : worker.pairs) worker.counts.paths += pair.seen ? 2 : 1;
    worker.bidirectional_tracer.tell_apart(splats_apart(s, worker));
    worker.bidirectional_tracer.trace(worker.pairs, splats_of(s, worker));
  }
}

void Pass::merge_tile(std::uint32_t item, Worker& worker) {
  const std::uint64_t sample = first_ + item / tiles_;
  look(tile(item % tiles_), sample, worker);
  take_pairs(tile(item % tiles_), sample, worker);
  for (const PixelPair& pair : worker.pairs) worker.counts.paths += pair.seen ? 1 : 0;
  worker.bidirectional_tracer.tell_apart(splats_apart(sample, worker));
  worker.bidirectional_tracer.trace(worker.pairs, light_paths_, splats_of(sample, worker));
}

void Pass::trace_batch(std::uint32_t batch, Worker& worker) {
  const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
  const std::uint64_t end = std::min(begin + kPhotonBatch, photons_);
  for (std::uint64_t s = first_; s < last_; ++s) {
    const Deposit deposit = splats_of(s, worker);
    worker.light_tracer.tell_apart(splats_apart(s, worker));
    for (std::uint64_t first = begin; first < end; first += kPathsTogether) {
      take_photons(s, first, std::min<std::uint64_t>(first + kPathsTogether, end), worker);
      worker.light_tracer.trace(worker.photons, deposit);
    }
  }
}

void Pass::trace_batch_brutely(std::uint32_t batch, Worker& worker) {
  const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
  const std::uint64_t end = std::min(begin + kPhotonBatch, photons_);
  for (std::uint64_t s = first_; s < last_; ++s) {
    take_photons(s, begin, end, worker);
    worker.brute_photon_tracer.tell_apart(splats_apart(s, worker));
    worker.brute_photon_tracer.trace(worker.photons, splats_of(s, worker));
  }
}

}  // namespace abbe
