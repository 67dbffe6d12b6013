#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sensor/film/feature_film.h"
#include "sensor/film/film.h"
#include "transport/render/layers.h"
#include "transport/render/render.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/brute.h"
#include "transport/technique/features.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"
#include "transport/technique/photon_gathering.h"

namespace abbe {

/// What a pass counted.
struct PassCounts {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t nonfinite = 0;
  TruncatedPaths cut = {};

  PassCounts& operator+=(const PassCounts& more) {
    paths += more.paths;
    rays += more.rays;
    nonfinite += more.nonfinite;
    cut += more.cut;
    return *this;
  }
};

/// What a pass fills beside its film, where it is asked for.
struct BesideFilms {
  FeatureFilm* features = nullptr;
  const Layers* layers = nullptr;  ///< With `layer_sums`, of as many times the planes of the film.
  Film* layer_sums = nullptr;
};

/// The pixels of which the first items of a pass without photons have all samples: rectangles of a film of
/// this shape that do not overlap.
[[nodiscard]] std::vector<Crop> tiles_done(const FilmShape& shape, std::uint32_t items);

/// Samples [first, last) of every pixel, with the photons and at the interval of camera paths of the plan.
/// Sample s belongs to replicate s mod R and is number s / R of that replicate's sequence. Each technique of
/// the plan has a stage of work items, tiles or batches of photons, that threads take from one counter, so
/// that those done are always the first ones. No stage waits for the one before, but where paths from the
/// camera gather what paths from lights have left: then samples are taken one by one, the items being their
/// tiles, and all threads trace the paths from lights of a sample first.
class Pass {
 public:
  /// Prepares a pass of whose items the film has the first `done` already. `seed` is that of the random
  /// numbers.
  Pass(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples, std::uint32_t done,
       std::uint64_t seed, const BesideFilms& beside = {});

  /// Runs on that many threads until all is done, or until `pause`, which any thread may ask after any item,
  /// says so; exceptions of workers are rethrown here.
  PassCounts run(int threads, const std::function<bool()>& pause);

  /// How many items are done, and whether these are all. Not while it runs.
  [[nodiscard]] std::uint32_t done() const { return std::min(next_.load(), items_); }
  [[nodiscard]] bool finished() const { return done() == items_; }

 private:
  // What one thread keeps between items.
  struct Worker {
    Worker(const Plan& plan, const FeatureFilm* features)
        : caster(plan.scene),
          path_tracer(plan, caster),
          light_tracer(plan, caster, 1.0 / static_cast<double>(plan.photons)),
          bidirectional_tracer(plan, caster),
          photon_gatherer(plan, caster),
          brute_photon_tracer(plan, caster, 1.0 / static_cast<double>(plan.photons)),
          adjoint_brute_tracer(plan, caster) {
      if (features != nullptr) feature_tracer.emplace(plan, features->features(), caster);
    }
    Worker(const Worker&) = delete;  // the tracers refer to the caster
    Worker& operator=(const Worker&) = delete;

    RayCaster caster;
    PathTracer path_tracer;
    LightTracer light_tracer;
    BidirectionalTracer bidirectional_tracer;
    PhotonGatherer photon_gatherer;
    BrutePhotonTracer brute_photon_tracer;
    AdjointBruteTracer adjoint_brute_tracer;
    std::optional<FeatureTracer> feature_tracer;  // where there is a film of them
    std::vector<PixelSample> pixels;
    std::vector<PixelPair> pairs;
    std::vector<Sampler> photons;
    std::vector<double> values;  // of a camera path, or of a layer, as the films take them
    PassCounts counts;
  };

  // What a technique does: `work` for each of so many items.
  struct Stage {
    std::uint32_t items;
    void (Pass::*work)(std::uint32_t item, Worker& worker);
  };
  // Where a tile begins.
  struct Tile {
    int x0, y0;
  };

  [[nodiscard]] Stage stage_of(Technique technique) const;
  PassCounts run_until(std::uint32_t end, int threads, const std::function<bool()>& pause);
  PassCounts work(std::uint32_t end, const std::function<bool()>& pause);
  void collect(std::uint64_t sample, int threads, PassCounts& counts);
  void do_item(std::uint32_t item, Worker& worker);
  void render_tile(std::uint32_t tile, Worker& worker);
  void render_tile_brutely(std::uint32_t tile, Worker& worker);
  void gather_tile(std::uint32_t item, Worker& worker);
  void join_tile(std::uint32_t tile, Worker& worker);
  void merge_tile(std::uint32_t item, Worker& worker);
  void look_at_tile(std::uint32_t tile, Worker& worker);
  void look(const Tile& tile, std::uint64_t sample, Worker& worker);
  void trace_batch(std::uint32_t batch, Worker& worker);
  void trace_batch_brutely(std::uint32_t batch, Worker& worker);

  [[nodiscard]] Tile tile(std::uint32_t number) const;
  template <typename PathOf>
  void take_pixels(const Tile& tile, const Crop& within, std::uint64_t sample, PathOf path_of,
                   Worker& worker) const;
  void take_pixels(const Tile& tile, std::uint64_t sample, Worker& worker) const;
  void take_pairs(const Tile& tile, std::uint64_t sample, Worker& worker) const;
  void take_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last, Worker& worker) const;
  [[nodiscard]] Sampler photon_sampler(std::uint64_t sample, std::uint64_t photon) const;
  [[nodiscard]] std::array<float, 4> numbers_of(std::uint64_t sample) const;
  [[nodiscard]] static std::span<const double> weighted(std::span<const double> values, double weight,
                                                        Worker& worker);
  void deposit(std::uint64_t sample, const FilmPoint& at, std::span<const double> values, double weight,
               Worker& worker);
  void deposit_apart(std::uint64_t sample, const FilmPoint& at, const LightHistory& of,
                     std::span<const double> values, double weight, Worker& worker);
  [[nodiscard]] Deposit pixels_deposit(std::uint64_t sample, Worker& worker);
  [[nodiscard]] ContributionDeposit pixels_apart(std::uint64_t sample, Worker& worker);
  [[nodiscard]] ContributionDeposit splats_apart(std::uint64_t sample, Worker& worker);
  [[nodiscard]] Deposit splats_of(std::uint64_t sample, Worker& worker);
  // Whether the pixel is asked for, or another one's light may fall on it.
  [[nodiscard]] bool is_sampled(int x, int y) const { return displaces_lanes_ || is_asked_for(x, y); }
  [[nodiscard]] bool is_asked_for(int x, int y) const {
    return x >= crop_.x0 && x < crop_.x1 && y >= crop_.y0 && y < crop_.y1;
  }
  [[nodiscard]] std::uint32_t number_of(int x, int y) const {
    return static_cast<std::uint32_t>(y * film_.width() + x);
  }
  [[nodiscard]] bool holds(std::span<const double> values) const;
  [[nodiscard]] bool keeps(std::span<const double> values, Worker& worker) const;
  [[nodiscard]] Replicate replicate(std::uint64_t sample) const;
  [[nodiscard]] std::uint32_t index(std::uint64_t sample) const;
  [[nodiscard]] std::optional<std::uint32_t> path_of(std::uint64_t sample, int x, int y) const;

  const Plan& plan_;
  const Scene& scene_;
  Film& film_;
  BesideFilms beside_;
  Crop crop_;
  bool displaces_lanes_;  // the camera
  std::uint64_t first_;
  std::uint64_t last_;
  std::uint64_t seed_;
  std::uint32_t tiles_x_;
  std::uint32_t tiles_;
  std::vector<Stage> stages_;
  std::uint32_t items_ = 0;  // of all stages
  bool sample_by_sample_;
  std::optional<std::uint32_t> left_by_;  // the sample of the pass whose paths from lights have left these:
  std::optional<PhotonCloud> cloud_;
  LightPaths light_paths_;
  std::uint64_t photons_;
  std::uint32_t path_interval_;
  std::atomic<std::uint32_t> next_;
};

}  // namespace abbe
