#include "transport/render/choose_integrator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "transport/plan/plan.h"
#include "transport/render/learnt_plan.h"
#include "transport/render/pilot.h"
#include "transport/render/technique_pilots.h"

namespace abbe {
namespace {

// What a ray of bidirectional path tracing takes over one of path tracing, with the weights that come with
// it, where paths are long: 1.9 in the Cornell box, about 1 where they are short.
constexpr double kCostOfJoinedRay = 2;

// By how much the pilots must prefer another way.
constexpr double kLeastRatio = 1.5;

// Pixels that pilots look at.
constexpr std::uint32_t kFewPixels = 512;
constexpr std::uint32_t kManyPixels = 4096;

// Films of meters have few pixels, whose mean takes many samples.
constexpr double kRaysOfMeter = 1 << 21;

// The light that merging finds and nothing else.
std::vector<PathClass> found_by_merging(const Scene& scene, const Scene& merging) {
  std::vector<PathClass> found = unreached(scene);
  const std::vector<PathClass> still = unreached(merging);
  std::erase_if(found, [&](const PathClass& lost) {
    return std::find(still.begin(), still.end(), lost) != still.end();
  });
  return found;
}

// Another way than path tracing, and light tracing beside it, what error costs by it, and the rays that
// pilots may cast to find out.
struct OtherWay {
  Integrator integrator;
  double (*cost)(const PilotFindings& found);
  double most_rays;
};

double cost_of_joining(const PilotFindings& joined) {
  return (joined.path_variance + joined.photon_variance) * joined.path_rays * kCostOfJoinedRay;
}

double cost_of_photons(const PilotFindings& found) {
  return found.photon_variance * found.photon_rays;
}

// And by path tracing, and light tracing beside it. Light that camera paths find by chance so rare that no
// pilot of theirs has is in what the joined ones tell of it.
double cost_apart(const PilotFindings& apart, const PilotFindings& joined) {
  const double squared_mean = apart.path_square - apart.path_variance;
  const double path_variance = std::max(apart.path_variance, joined.path_tracing_square - squared_mean);
  return std::pow(
      std::sqrt(path_variance * apart.path_rays) + std::sqrt(apart.photon_variance * apart.photon_rays), 2);
}

// The findings with a variance of camera paths two standard errors larger: few samples more often miss the
// rare paths of high variance than contain them.
PilotFindings with_tail(PilotFindings apart) {
  apart.path_variance += 2 * apart.path_variance_error;
  apart.path_square += 2 * apart.path_variance_error;
  return apart;
}

// By few pilots first, as in most scenes it is plain enough, and by very few for what they cost. None where
// the film is too small for them to be worth that, or has no light that would tell.
std::optional<double> cost_ratio(const Plan& apart, const Scene& other, const OtherWay& way, int threads) {
  constexpr std::uint32_t kFirst = 4;
  constexpr double kPlain = 0.75;
  double rays_per_pixel = 2 * kPilotPathsPerPixel;  // at least, of both
  if (kFewPixels * rays_per_pixel > way.most_rays) return std::nullopt;
  const Plan plan = make_learnt_plan(other, threads);
  std::optional<double> ratio;
  for (const std::uint32_t pixels : {kFirst, kFewPixels, kManyPixels}) {
    if (pixels * rays_per_pixel > way.most_rays) return std::nullopt;
    const PilotFindings by_paths = try_techniques(apart, threads, pixels);
    const PilotFindings by_other = try_techniques(plan, threads, pixels);
    rays_per_pixel = static_cast<double>(by_paths.rays + by_other.rays) / pixels;
    const double cost = way.cost(by_other);
    if (pixels == kFirst || !(cost > 0)) continue;
    ratio = cost_apart(by_paths, by_other) / cost;
    if (!(cost_apart(with_tail(by_paths), by_other) / cost > kPlain)) break;
  }
  return ratio && std::isfinite(*ratio) ? ratio : std::nullopt;
}

// What photons bring a meter that they run into joined paths would not find. Photons alone may do, where they
// reach everything.
OtherWay other_way(const Plan& plan) {
  if (is_meter(plan.scene.camera) && uses(plan.techniques, Technique::light))
    return {Integrator::light, cost_of_photons, kRaysOfMeter};
  return {Integrator::bdpt, cost_of_joining, rays_of_pilots(plan.scene.camera)};
}

Scene with_integrator(Scene scene, Integrator integrator) {
  scene.render.integrator = integrator;
  return scene;
}

}  // namespace

IntegratorChoice choose_integrator(const Scene& scene, int threads) {
  const bool open = scene.render.integrator == Integrator::automatic;
  if (const auto refused = refusal(scene)) {
    const bool by_paths =
        open && is_meter(scene.camera) && !refusal(with_integrator(scene, Integrator::path));
    if (by_paths) return {Integrator::path, refused->what()};
    return {scene.render.integrator, ""};
  }
  if (open && scene.render.consistent) {
    const Scene merging = with_integrator(scene, Integrator::vcm);
    const std::vector<PathClass> found = found_by_merging(scene, merging);
    if (!found.empty() && !refusal(merging))
      return {Integrator::vcm, fmt::format("merging finds {}", fmt::join(found, "; "))};
  }
  Plan plan = make_learnt_plan(scene, threads);
  const OtherWay way = other_way(plan);
  const Integrator by = way.integrator;
  const Scene other = with_integrator(scene, by);
  const bool reaches_enough = by != Integrator::light || unreached(other).empty();
  std::optional<double> ratio;
  if (open && !refusal(other) && reaches_enough) ratio = cost_ratio(plan, other, way, threads);
  if (ratio && *ratio > kLeastRatio)
    return {by,
            fmt::format("pilots take it for {:.2g} times as cheap at equal error as path tracing", *ratio),
            ratio, by};
  return {scene.render.integrator, "", ratio, by, std::make_shared<const Guides>(std::move(plan.guides))};
}

}  // namespace abbe
