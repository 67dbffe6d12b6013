#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
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
#include "transport/technique/photon_mapping.h"

namespace abbe {

/// Work that a pass counted, and what it dropped.
struct PassCounts {
  std::uint64_t paths = 0;      ///< Camera paths and light paths started.
  std::uint64_t rays = 0;       ///< Rays cast, shadow rays included.
  std::uint64_t nonfinite = 0;  ///< Contributions dropped: a value is not finite or too large for the film.
  TruncatedPaths cut = {};      ///< Paths that ended at the maximum depth.

  PassCounts& operator+=(const PassCounts& more) {
    paths += more.paths;
    rays += more.rays;
    nonfinite += more.nonfinite;
    cut += more.cut;
    return *this;
  }
};

/// Films that a pass fills in addition to its main film; null if not requested.
struct AuxiliaryFilms {
  FeatureFilm* features = nullptr;  ///< Sums of the features of the first hit.
  const Layers* layers = nullptr;   ///< Set together with `layer_sums`.
  Film* layer_sums = nullptr;       ///< Planes of all layers, one layer after another.
};

/// Pixels that have all samples of a pass without photons after its first `items` work items, as rectangles
/// that do not overlap.
[[nodiscard]] std::vector<Crop> tiles_done(const FilmShape& shape, std::uint32_t items);

/// One pass: samples [first, last) of every pixel. Each sample has `Plan::photons` photons, if the plan
/// traces photons. With n = `Plan::path_interval`, a pixel has a camera path in every n-th sample of a
/// replicate only, of weight n. The first of these samples is random for each pixel and replicate. With R
/// replicates, sample s is number s / R of the random-number sequence of replicate s mod R.
///
/// Each technique of the plan has a stage of work items: tiles, or batches of photons. Threads take items
/// from one counter, so the finished items are always the first ones. No stage waits for the one before.
///
/// If camera paths gather photons or merge with light subpaths, the pass takes the samples one by one. All
/// threads first trace the light subpaths of a sample; the work items are then its tiles.
class Pass {
 public:
  /// Prepares a pass over `samples`, of which the film has the first `done` work items already. Pixels
  /// outside `crop` receive nothing. `seed` selects the random numbers. The film must have the size and
  /// planes of the scene; plan and films must outlive the pass.
  Pass(const Plan& plan, Film& film, std::optional<Crop> crop, const SampleRange& samples, std::uint32_t done,
       std::uint64_t seed, const AuxiliaryFilms& auxiliary = {});

  /// Runs on `threads` threads, at least 1, until all items are done or `pause` returns true. Any thread may
  /// call `pause` after any item. Returns the counts of this call. Rethrows an exception of a thread:
  /// Error{scene} if a sum of the film overflows, Error{resource} if more than `MediumStack::kMaxShapes`
  /// media nest.
  PassCounts run(int threads, const std::function<bool()>& pause);

  /// Number of finished items, not to be called during `run`.
  [[nodiscard]] std::uint32_t done() const { return std::min(next_.load(), items_); }
  /// True if all items are done.
  [[nodiscard]] bool finished() const { return done() == items_; }

 private:
  // State of one thread, reused for all its items.
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
    std::optional<FeatureTracer> feature_tracer;  // if features are requested
    std::vector<PixelSample> pixels;
    std::vector<PixelPair> pairs;
    std::vector<Sampler> photons;
    std::vector<double> values;  // weighted film values of one contribution
    PassCounts counts;
  };

  // The work items of one technique.
  struct Stage {
    std::uint32_t items;
    void (Pass::*work)(std::uint32_t item, Worker& worker);
  };
  // Top left pixel of a tile.
  struct Tile {
    int x0, y0;
  };

  [[nodiscard]] Stage stage_of(Technique technique) const;
  PassCounts run_until(std::uint32_t end, int threads, const std::function<bool()>& pause);
  PassCounts work(std::uint32_t end, const std::function<bool()>& pause);
  void trace_sample_subpaths(std::uint64_t sample, int threads, PassCounts& counts);
  void do_item(std::uint32_t item, Worker& worker);
  template <auto tracer>  // member of `Worker`
  void render_tile(std::uint32_t tile, Worker& worker);
  void gather_tile(std::uint32_t item, Worker& worker);
  void connect_tile(std::uint32_t tile, Worker& worker);
  void merge_tile(std::uint32_t item, Worker& worker);
  void trace_tile_features(std::uint32_t tile, Worker& worker);
  void trace_features(const Tile& tile, std::uint64_t sample, Worker& worker);
  void trace_batch(std::uint32_t batch, Worker& worker);
  void trace_batch_brutely(std::uint32_t batch, Worker& worker);

  [[nodiscard]] Tile tile(std::uint32_t number) const;
  template <typename PathIndex>
  void select_pixels(const Tile& tile, const Crop& within, std::uint64_t sample, PathIndex path_index,
                     Worker& worker) const;
  void select_pixels(const Tile& tile, std::uint64_t sample, Worker& worker) const;
  void select_pairs(const Tile& tile, std::uint64_t sample, Worker& worker) const;
  void select_photons(std::uint64_t sample, std::uint64_t first, std::uint64_t last, Worker& worker) const;
  [[nodiscard]] Sampler photon_sampler(std::uint64_t sample, std::uint64_t photon) const;
  [[nodiscard]] std::array<float, 4> sample_random_numbers(std::uint64_t sample) const;
  [[nodiscard]] static std::span<const double> weighted(std::span<const double> values, double weight,
                                                        Worker& worker);
  void deposit(std::uint64_t sample, const FilmPoint& at, std::span<const double> values, double weight,
               Worker& worker);
  void deposit_to_layer(std::uint64_t sample, const FilmPoint& at, const ContributionInfo& history,
                        std::span<const double> values, double weight, Worker& worker);
  [[nodiscard]] Deposit pixel_deposit(std::uint64_t sample, Worker& worker);
  [[nodiscard]] ContributionDeposit pixel_layer_deposit(std::uint64_t sample, Worker& worker);
  [[nodiscard]] ContributionDeposit splat_layer_deposit(std::uint64_t sample, Worker& worker);
  [[nodiscard]] Deposit splat_deposit(std::uint64_t sample, Worker& worker);
  // True if the pixel lies in the crop, or its light may fall on a pixel of the crop.
  [[nodiscard]] bool is_sampled(int x, int y) const { return displaces_wavelengths_ || is_requested(x, y); }
  [[nodiscard]] bool is_requested(int x, int y) const {
    return x >= crop_.x0 && x < crop_.x1 && y >= crop_.y0 && y < crop_.y1;
  }
  [[nodiscard]] std::uint32_t pixel_index(int x, int y) const {
    return static_cast<std::uint32_t>(y * film_.width() + x);
  }
  [[nodiscard]] bool is_representable(std::span<const double> values) const;
  [[nodiscard]] bool accept(std::span<const double> values, Worker& worker) const;
  [[nodiscard]] Replicate replicate(std::uint64_t sample) const;
  [[nodiscard]] std::uint32_t sequence_index(std::uint64_t sample) const;
  [[nodiscard]] std::optional<std::uint32_t> path_index(std::uint64_t sample, int x, int y) const;

  const Plan& plan_;
  const Scene& scene_;
  Film& film_;
  AuxiliaryFilms auxiliary_;
  Crop crop_;
  bool displaces_wavelengths_;  // the camera moves some wavelengths to other pixels
  std::uint64_t first_;
  std::uint64_t last_;
  std::uint64_t seed_;
  std::uint32_t tiles_x_;
  std::uint32_t tiles_;
  std::vector<Stage> stages_;
  std::uint32_t items_ = 0;  // of all stages
  bool sample_by_sample_;
  bool repeats_paths_;  // all samples have the same camera paths
  // sample of the pass to which `cloud_` or `light_paths_` belongs
  std::optional<std::uint32_t> sample_of_cloud_;
  std::optional<PhotonCloud> cloud_;
  LightSubpaths light_paths_;
  std::uint64_t photons_;
  std::uint32_t path_interval_;
  std::atomic<std::uint32_t> next_;
};

/// Memory [bytes] for the light subpaths of one sample, if each has four vertices, as is usual; 0 if the
/// scene's integrator stores none.
[[nodiscard]] std::size_t bytes_of_light_paths(const Scene& scene);

}  // namespace abbe
