#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"
#include "transport/plan/plan.h"
#include "transport/render/pass.h"
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

}  // namespace abbe::test
