#include "transport/render/pass.h"

#include <pmmintrin.h>

#include <algorithm>
#include <mutex>

#include "transport/render/threads.h"

namespace abbe {
namespace {

constexpr std::uint32_t kTile = 16;
constexpr std::uint32_t kPhotonBatch = 4096;
constexpr std::uint32_t kTogether = 64;  // photons that take each step together

constexpr std::uint32_t pieces(std::uint64_t whole, std::uint32_t piece) {
  return static_cast<std::uint32_t>((whole + piece - 1) / piece);
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
           std::uint32_t done, std::uint64_t seed)
    : plan_(plan),
      scene_(plan.scene),
      film_(film),
      crop_(crop.value_or(Crop{0, 0, film.width(), film.height()})),
      first_(samples.first),
      last_(samples.last),
      seed_(seed),
      next_(done) {
  const auto width = static_cast<std::uint32_t>(film.width());
  const auto height = static_cast<std::uint32_t>(film.height());
  tiles_x_ = pieces(width, kTile);
  photons_ = plan.photons;
  path_interval_ = plan.path_interval;
  const std::uint32_t tiles = tiles_x_ * pieces(height, kTile);
  for (const Technique technique : plan.techniques) switch (technique) {
      case Technique::path:
        stages_.push_back({tiles, &Pass::render_tile});
        break;
      case Technique::light:
        stages_.push_back({pieces(photons_, kPhotonBatch), &Pass::trace_batch});
        break;
      case Technique::bdpt:
        stages_.push_back({tiles, &Pass::join_tile});
        break;
    }
  for (const Stage& stage : stages_) items_ += stage.items;
}

PassCounts Pass::run(int threads, const std::function<bool()>& pause) {
  PassCounts total;
  std::mutex mutex;
  run_on_threads(threads, [&] {
    const PassCounts counts = work(pause);
    const std::scoped_lock lock(mutex);
    total.paths += counts.paths;
    total.rays += counts.rays;
    total.nonfinite += counts.nonfinite;
    total.cut += counts.cut;
  });
  return total;
}

PassCounts Pass::work(const std::function<bool()>& pause) {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  Worker worker(plan_);
  for (std::uint32_t item = next_++; item < items_; item = next_++) {
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

std::uint32_t Pass::replicate(std::uint64_t sample) const {
  return static_cast<std::uint32_t>(sample % static_cast<std::uint64_t>(film_.replicates()));
}

bool Pass::keeps(std::span<const double> values, Worker& worker) const {
  const bool good = std::all_of(values.begin(), values.end(), [this](double v) { return film_.holds(v); });
  if (!good) ++worker.counts.nonfinite;
  return good;
}

void Pass::render_tile(std::uint32_t tile, Worker& worker) {
  const auto x0 = static_cast<int>(tile % tiles_x_ * kTile);
  const auto y0 = static_cast<int>(tile / tiles_x_ * kTile);
  for (std::uint64_t s = first_; s < last_; ++s) sample_tile(x0, y0, s, worker);
}

// Of the replicate's sequence at a pixel, that of a sample; nothing where the pixel skips it. Which samples
// these are is chance, for each pixel and replicate, so that the mean over any of them is right.
std::optional<std::uint32_t> Pass::path_of(std::uint64_t sample, std::uint32_t pixel) const {
  const auto index = static_cast<std::uint32_t>(sample / static_cast<std::uint64_t>(film_.replicates()));
  if (path_interval_ == 1) return index;
  constexpr std::uint32_t kPhaseGroup = 0xC0000000;
  const float u = Sampler(seed_, Purpose::camera, replicate(sample), pixel, 0).group(kPhaseGroup)[0];
  const std::uint32_t at = index + static_cast<std::uint32_t>(u * static_cast<float>(path_interval_));
  if (at % path_interval_ != 0) return std::nullopt;
  return at / path_interval_;
}

// One sample of each pixel of a tile.
void Pass::sample_tile(int x0, int y0, std::uint64_t sample, Worker& worker) {
  constexpr int kEdge = kTile;
  const auto pixel_at = [this](int x, int y) { return static_cast<std::uint32_t>(y * film_.width() + x); };
  worker.pixels.clear();
  for (int y = std::max(y0, crop_.y0); y < std::min(y0 + kEdge, crop_.y1); ++y)
    for (int x = std::max(x0, crop_.x0); x < std::min(x0 + kEdge, crop_.x1); ++x)
      if (const auto index = path_of(sample, pixel_at(x, y)))
        worker.pixels.push_back(
            {x, y, Sampler(seed_, Purpose::camera, replicate(sample), pixel_at(x, y), *index)});
  worker.counts.paths += worker.pixels.size();
  const Deposit deposit = [&](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    worker.values.assign(values.begin(), values.end());
    for (double& value : worker.values) value *= path_interval_;
    if (keeps(worker.values, worker))
      film_.add(pixel_at(at.x, at.y), static_cast<int>(replicate(sample)), worker.values);
  };
  worker.path_tracer.trace(worker.pixels, deposit);
}

// Paths from lights may come to any pixel of the film; those that are not asked for get nothing.
Deposit Pass::splats_of(std::uint64_t sample, Worker& worker) {
  return [this, sample, &worker](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    if (!is_asked_for(at.x, at.y) || !keeps(values, worker)) return;
    film_.add(static_cast<std::size_t>(at.y) * static_cast<std::size_t>(film_.width()) +
                  static_cast<std::size_t>(at.x),
              static_cast<int>(replicate(sample)), values);
  };
}

// The paths from lights are those of all pixels, whichever are asked for.
void Pass::join_tile(std::uint32_t tile, Worker& worker) {
  const auto x0 = static_cast<int>(tile % tiles_x_ * kTile);
  const auto y0 = static_cast<int>(tile / tiles_x_ * kTile);
  for (std::uint64_t s = first_; s < last_; ++s) {
    const auto index = static_cast<std::uint32_t>(s / static_cast<std::uint64_t>(film_.replicates()));
    worker.pairs.clear();
    for (int y = y0; y < std::min(y0 + static_cast<int>(kTile), film_.height()); ++y)
      for (int x = x0; x < std::min(x0 + static_cast<int>(kTile), film_.width()); ++x) {
        const auto pixel = static_cast<std::uint32_t>(y * film_.width() + x);
        worker.pairs.push_back({x, y, Sampler(seed_, Purpose::camera, replicate(s), pixel, index),
                                photon_sampler(s, pixel), is_asked_for(x, y)});
        worker.counts.paths += worker.pairs.back().seen ? 2 : 1;
      }
    worker.bidirectional_tracer.trace(worker.pairs, splats_of(s, worker));
  }
}

void Pass::trace_batch(std::uint32_t batch, Worker& worker) {
  const std::uint64_t begin = std::uint64_t{batch} * kPhotonBatch;
  const std::uint64_t end = std::min(begin + kPhotonBatch, photons_);
  for (std::uint64_t s = first_; s < last_; ++s) {
    const Deposit deposit = splats_of(s, worker);
    for (std::uint64_t first = begin; first < end; first += kTogether)
      trace_photons(s, first, std::min<std::uint64_t>(first + kTogether, end), worker, deposit);
  }
}

Sampler Pass::photon_sampler(std::uint64_t sample, std::uint64_t photon) const {
  const std::uint64_t index = sample / static_cast<std::uint64_t>(film_.replicates()) * photons_ + photon;
  return {seed_, Purpose::light, replicate(sample), static_cast<std::uint32_t>(index >> 32),
          static_cast<std::uint32_t>(index)};
}

// Those from `first` to `last` of a sample.
void Pass::trace_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last, Worker& worker,
                         const Deposit& deposit) const {
  worker.photons.clear();
  for (std::uint64_t photon = first; photon < last; ++photon)
    worker.photons.push_back(photon_sampler(sample, photon));
  worker.counts.paths += worker.photons.size();
  worker.light_tracer.trace(worker.photons, deposit);
}

}  // namespace abbe
