#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sensor/film/feature_film.h"
#include "sensor/film/film.h"
#include "transport/plan/plan.h"
#include "transport/render/layers.h"
#include "transport/render/render.h"

namespace abbe {

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

  ~Pass();

  /// Runs on `threads` threads, at least 1, until all items are done or `pause` returns true. Any thread may
  /// call `pause` after any item. Returns the counts of this call. Rethrows an exception of a thread:
  /// Error{scene} if a sum of the film overflows, Error{resource} if more than `MediumStack::kMaxShapes`
  /// media nest.
  WorkCounts run(int threads, const std::function<bool()>& pause);

  /// Number of finished items, not to be called during `run`.
  [[nodiscard]] std::uint32_t done() const;
  /// True if all items are done.
  [[nodiscard]] bool finished() const;

 private:
  class Items;
  std::unique_ptr<Items> items_;
};

/// Memory [bytes] for the light subpaths of one sample, if each has four vertices, as is usual; 0 if the
/// scene's integrator stores none.
[[nodiscard]] std::size_t bytes_of_light_paths(const Scene& scene);

}  // namespace abbe
