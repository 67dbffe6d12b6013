#include "transport/render/choose_integrator.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "scene/unreached.h"
#include "transport/plan/plan.h"
#include "transport/render/learn_aims.h"
#include "transport/render/technique_pilots.h"

namespace abbe {
namespace {

// What a ray of bidirectional path tracing takes over one of path tracing, with the weights that come with
// it, where paths are long: 1.9 in the Cornell box, about 1 where they are short.
constexpr double kCostOfJoinedRay = 2;

// By how much the pilots must prefer bidirectional path tracing.
constexpr double kMargin = 1.5;

std::vector<PathClass> unreached_by(const Scene& scene) {
  return unreached(scene, scene.needs, uses(chosen_techniques(scene), Technique::light));
}

// The light that merging finds and nothing else.
std::vector<PathClass> found_by_merging(const Scene& scene, const Scene& merging) {
  std::vector<PathClass> found = unreached_by(scene);
  const std::vector<PathClass> still = unreached_by(merging);
  std::erase_if(found, [&](const PathClass& lost) {
    return std::find(still.begin(), still.end(), lost) != still.end();
  });
  return found;
}

double cost_of_error(const Plan& plan, int threads, std::uint32_t pixels) {
  const PilotFindings found = try_techniques(plan, threads, pixels);
  if (uses(plan.techniques, Technique::bdpt))
    return (found.path_variance + found.photon_variance) * found.path_rays * kCostOfJoinedRay;
  return std::pow(
      std::sqrt(found.path_variance * found.path_rays) + std::sqrt(found.photon_variance * found.photon_rays),
      2);
}

// By few pilots first, as in most scenes it is plain enough.
double cost_ratio(const Scene& scene, const Scene& joining, int threads) {
  constexpr double kPlain = 0.75;
  const Plan apart = make_learnt_plan(scene, threads, scene.render.seed);
  const Plan joined = make_learnt_plan(joining, threads, scene.render.seed);
  double ratio = 0;
  for (const std::uint32_t pixels : {512U, 4096U}) {
    ratio = cost_of_error(apart, threads, pixels) / cost_of_error(joined, threads, pixels);
    if (!(ratio > kPlain)) break;
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
  const double ratio = cost_ratio(scene, joining, threads);
  if (!std::isfinite(ratio)) return {Integrator::automatic, ""};  // pilots that find no light tell nothing
  if (!(ratio > kMargin)) return {Integrator::automatic, "", ratio};
  return {Integrator::bdpt,
          fmt::format("pilots take it for {:.2g} times as cheap at equal error as path tracing", ratio),
          ratio};
}

}  // namespace abbe
