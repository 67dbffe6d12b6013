#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/plan.h"
#include "transport/render/layers.h"
#include "transport/render/pass.h"
#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe::test {

/// The film of a plan, whatever pilots have taught it: so many samples, with that number as their seed unless
/// there is another.
inline Film film_of(const Scene& scene, const Plan& plan, std::uint64_t samples,
                    std::optional<std::uint64_t> seed = {}) {
  constexpr int kReplicates = 8;
  Film film(scene.camera.width, scene.camera.height, static_cast<int>(scene.film_planes().size()),
            kReplicates, plan.nominal_value, paths_to_any_pixel(plan), plan.path_interval);
  Pass(plan, film, {}, {0, samples}, 0, seed.value_or(samples)).run(2, [] { return false; });
  film.set_samples(count_per_replicate({{0, samples}}, kReplicates));
  return film;
}

/// The same with those layers beside it, of that many samples.
inline RenderResult layered_film_of(const Plan& plan, const Layers& layers, std::uint64_t samples) {
  const FilmShape shape = film_of(plan.scene, plan, 0).shape();
  RenderResult result{Film(shape), {}, {}};
  result.layers.emplace(layered(shape, layers.names.size()));
  Pass(plan, result.film, {}, {0, samples}, 0, 0, {nullptr, &layers, &*result.layers}).run(2, [] {
    return false;
  });
  const std::vector<std::uint64_t> counts = count_per_replicate({{0, samples}}, shape.replicates);
  result.film.set_samples(counts);
  result.layers->set_samples(counts);
  return result;
}

}  // namespace abbe::test
