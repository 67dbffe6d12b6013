#include "transport/render/pilot.h"

#include <algorithm>
#include <cstdint>

#include "transport/render/pass.h"

namespace abbe {
namespace {

constexpr std::uint64_t kPaths = 1U << 16;
constexpr std::uint64_t kMostSamples = 16;
constexpr std::uint64_t kSeed = std::uint64_t{1} << 63;  // scene files have none so large

}  // namespace

Film pilot_film(const Plan& plan, int threads, std::optional<Crop> crop) {
  const Camera& camera = plan.scene.camera;
  Film film(camera.width, camera.height, static_cast<int>(plan.scene.film_planes().size()), 1,
            plan.nominal_value);
  const auto pixels = static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height);
  const std::uint64_t samples = std::clamp<std::uint64_t>(kPaths / pixels, 1, kMostSamples);
  Pass(plan, film, crop, {0, samples}, 0, kSeed).run(threads, [] { return false; });
  film.set_samples({samples});
  return film;
}

}  // namespace abbe
