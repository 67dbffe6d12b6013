#include "transport/render/choose_integrator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "transport/plan/plan.h"
#include "transport/render/learn_aims.h"
#include "transport/render/technique_pilots.h"

namespace abbe {
namespace {

// What a ray of bidirectional path tracing takes over one of path tracing, with the weights that come with
// it, where paths are long: 1.9 in the Cornell box, about 1 where they are short.
constexpr double kCostOfJoinedRay = 2;

// By how much the pilots must prefer bidirectional path tracing.
constexpr double kLeastGainOfJoining = 1.5;

// Pixels that pilots look at, and the rays that they may cast for each pixel of the film: about what path
// tracing does in ten samples, so that a film's pilots cost little of it. The samples themselves do not
// count, as parts of one film may state different ones.
constexpr std::uint32_t kFewPixels = 512;
constexpr std::uint32_t kManyPixels = 4096;
constexpr double kRaysPerPixel = 64;

// The light that merging finds and nothing else.
std::vector<PathClass> found_by_merging(const Scene& scene, const Scene& merging) {
  std::vector<PathClass> found = unreached(scene);
  const std::vector<PathClass> still = unreached(merging);
  std::erase_if(found, [&](const PathClass& lost) {
    return std::find(still.begin(), still.end(), lost) != still.end();
  });
  return found;
}

// What pilots through some pixels found of a plan.
struct Trial {
  double cost_of_error = 0;
  double rays_per_pixel = 0;
};

Trial try_plan(const Plan& plan, int threads, std::uint32_t pixels) {
  const PilotFindings found = try_techniques(plan, threads, pixels);
  const double rays_per_pixel = static_cast<double>(found.rays) / pixels;
  if (uses(plan.techniques, Technique::bdpt))
    return {(found.path_variance + found.photon_variance) * found.path_rays * kCostOfJoinedRay,
            rays_per_pixel};
  return {std::pow(std::sqrt(found.path_variance * found.path_rays) +
                       std::sqrt(found.photon_variance * found.photon_rays),
                   2),
          rays_per_pixel};
}

// By few pilots first, as in most scenes it is plain enough, and by very few for what they cost. None where
// the film is too small for them to be worth that.
std::optional<double> cost_ratio(const Scene& scene, const Scene& joining, int threads) {
  constexpr std::uint32_t kFirst = 4;
  constexpr double kPlain = 0.75;
  const double most_rays = kRaysPerPixel * scene.camera.width * scene.camera.height;
  double rays_per_pixel = 2 * kPilotPathsPerPixel;  // at least, of both
  if (kFewPixels * rays_per_pixel > most_rays) return std::nullopt;
  const Plan apart = make_learnt_plan(scene, threads, scene.render.seed);
  const Plan joined = make_learnt_plan(joining, threads, scene.render.seed);
  std::optional<double> ratio;
  for (const std::uint32_t pixels : {kFirst, kFewPixels, kManyPixels}) {
    if (pixels * rays_per_pixel > most_rays) return std::nullopt;
    const Trial one = try_plan(apart, threads, pixels);
    const Trial other = try_plan(joined, threads, pixels);
    rays_per_pixel = one.rays_per_pixel + other.rays_per_pixel;
    if (pixels == kFirst) continue;
    ratio = one.cost_of_error / other.cost_of_error;
    if (!(*ratio > kPlain)) break;
  }
  return ratio;
}

Scene with_integrator(Scene scene, Integrator integrator) {
  scene.render.integrator = integrator;
  return scene;
}

}  // namespace

IntegratorChoice choose_integrator(const Scene& scene, int threads) {
  if (scene.render.integrator != Integrator::automatic || refusal(scene))
    return {scene.render.integrator, ""};
  if (scene.render.consistent) {
    const Scene merging = with_integrator(scene, Integrator::vcm);
    const std::vector<PathClass> found = found_by_merging(scene, merging);
    if (!found.empty() && !refusal(merging))
      return {Integrator::vcm, fmt::format("merging finds {}", fmt::join(found, "; "))};
  }
  const Scene joining = with_integrator(scene, Integrator::bdpt);
  if (refusal(joining)) return {Integrator::automatic, ""};
  const std::optional<double> ratio = cost_ratio(scene, joining, threads);
  if (!ratio || !std::isfinite(*ratio)) return {Integrator::automatic, ""};  // without light nothing is told
  if (!(*ratio > kLeastGainOfJoining)) return {Integrator::automatic, "", ratio};
  return {Integrator::bdpt,
          fmt::format("pilots take it for {:.2g} times as cheap at equal error as path tracing", *ratio),
          ratio};
}

}  // namespace abbe
