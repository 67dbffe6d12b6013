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
#include "transport/render/pilot.h"
#include "transport/render/technique_balance.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

// Cost of a ray of bidirectional path tracing, with its MIS weights, relative to one of path tracing: 1.9 in
// the Cornell box, where paths are long, about 1 where they are short.
constexpr double kConnectedRayCost = 2;

// Cost ratio above which the alternative is chosen.
constexpr double kMinCostRatio = 1.5;

// Pixels through which pilots trace paths, in the second and third round.
constexpr std::uint32_t kFewPixels = 512;
constexpr std::uint32_t kManyPixels = 4096;

// Films of probes have few pixels, whose mean takes many samples.
constexpr double kProbeRayBudget = 1 << 21;

// Light paths that only photon merging samples.
std::vector<PathClass> paths_found_by_merging(const Scene& scene, const Scene& merging) {
  std::vector<PathClass> merging_only = unsampled_paths(scene);
  const std::vector<PathClass> unsampled_by_merging = unsampled_paths(merging);
  std::erase_if(merging_only, [&](const PathClass& path_class) {
    return std::find(unsampled_by_merging.begin(), unsampled_by_merging.end(), path_class) !=
           unsampled_by_merging.end();
  });
  return merging_only;
}

// An alternative to path tracing with light tracing: its cost of error, and the rays that pilots may cast.
struct AlternativeIntegrator {
  Integrator integrator;
  double (*cost)(const TechniqueStatistics& statistics);
  double max_rays;
};

double bidirectional_cost(const TechniqueStatistics& bidirectional) {
  return (bidirectional.path_variance + bidirectional.photon_variance) * bidirectional.path_rays *
         kConnectedRayCost;
}

double photon_cost(const TechniqueStatistics& statistics) {
  return statistics.photon_variance * statistics.photon_rays;
}

// Cost of error of path tracing with light tracing. Camera paths may hit some light so rarely that no pilot
// of theirs has hit it; the bidirectional pilots then estimate its mean square.
double path_and_light_cost(const TechniqueStatistics& unidirectional,
                           const TechniqueStatistics& bidirectional) {
  const double squared_mean = unidirectional.path_square - unidirectional.path_variance;
  const double path_variance =
      std::max(unidirectional.path_variance, bidirectional.path_tracing_square - squared_mean);
  return std::pow(std::sqrt(path_variance * unidirectional.path_rays) +
                      std::sqrt(unidirectional.photon_variance * unidirectional.photon_rays),
                  2);
}

// The statistics with the variance of camera paths increased by two standard errors: few samples more often
// miss the rare paths of high variance than contain them.
TechniqueStatistics with_tail(TechniqueStatistics unidirectional) {
  unidirectional.path_variance += 2 * unidirectional.path_variance_error;
  unidirectional.path_square += 2 * unidirectional.path_variance_error;
  return unidirectional;
}

// Cost ratio of path and light tracing over the alternative. Few pilots decide most scenes; a first, very
// small round measures only the rays per pixel. Empty if the film is too small for the pilots to pay off, or
// too dark.
std::optional<double> cost_ratio(const Plan& unidirectional, const Scene& alternative_scene,
                                 const AlternativeIntegrator& alternative, int threads) {
  constexpr std::uint32_t kFirst = 4;
  constexpr double kStopRatio = 0.75;
  double rays_per_pixel = 2 * kPilotPathsPerPixel;  // lower bound, for both plans
  if (kFewPixels * rays_per_pixel > alternative.max_rays) return std::nullopt;
  const Plan plan = make_trained_plan(alternative_scene, threads);
  std::optional<double> ratio;
  for (const std::uint32_t pixels : {kFirst, kFewPixels, kManyPixels}) {
    if (pixels * rays_per_pixel > alternative.max_rays) return std::nullopt;
    const TechniqueStatistics by_paths = measure_techniques(unidirectional, threads, pixels);
    const TechniqueStatistics by_alternative =
        measure_techniques(plan, threads, pixels, by_paths.region_means);
    rays_per_pixel = static_cast<double>(by_paths.rays + by_alternative.rays) / pixels;
    const double cost = alternative.cost(by_alternative);
    if (pixels == kFirst || !(cost > 0)) continue;
    ratio = path_and_light_cost(by_paths, by_alternative) / cost;
    if (!(path_and_light_cost(with_tail(by_paths), by_alternative) / cost > kStopRatio)) break;
  }
  return ratio && std::isfinite(*ratio) ? ratio : std::nullopt;
}

// Bidirectional path tracing would not sample light that photons add by hitting a probe. Photons alone may
// suffice.
AlternativeIntegrator choose_alternative(const Plan& plan) {
  if (is_probe(plan.scene.camera) && traces(plan.techniques, TracedPaths::light))
    return {integrator_for(AutomaticChoice::probes), photon_cost, kProbeRayBudget};
  return {integrator_for(AutomaticChoice::films), bidirectional_cost, pilot_ray_budget(plan.scene.camera)};
}

Scene with_integrator(Scene scene, Integrator integrator) {
  scene.render.integrator = integrator;
  return scene;
}

}  // namespace

IntegratorChoice choose_integrator(const Scene& scene, int threads) {
  const bool is_automatic = scene.render.integrator == Integrator::automatic;
  if (const auto refused = refusal(scene)) {
    const bool by_paths =
        is_automatic && is_probe(scene.camera) && !refusal(with_integrator(scene, kAutomaticPaths));
    if (by_paths) return {kAutomaticPaths, refused->what()};
    return {scene.render.integrator, ""};
  }
  if (is_automatic && scene.render.consistent) {
    const Integrator consistent = integrator_for(AutomaticChoice::consistent);
    const Scene merging = with_integrator(scene, consistent);
    const std::vector<PathClass> merging_only = paths_found_by_merging(scene, merging);
    if (!merging_only.empty() && !refusal(merging))
      return {consistent, fmt::format("only photon merging samples {}", fmt::join(merging_only, "; "))};
  }
  Plan plan = make_trained_plan(scene, threads);
  const AlternativeIntegrator alternative = choose_alternative(plan);
  const Integrator candidate = alternative.integrator;
  const Scene alternative_scene = with_integrator(scene, candidate);
  const bool samples_all_light =
      candidate != integrator_for(AutomaticChoice::probes) || unsampled_paths(alternative_scene).empty();
  std::optional<double> ratio;
  if (is_automatic && !refusal(alternative_scene) && samples_all_light)
    ratio = cost_ratio(plan, alternative_scene, alternative, threads);
  if (ratio && *ratio > kMinCostRatio)
    return {candidate,
            fmt::format("pilots estimate that it is {:.2g} times as cheap as path tracing at equal error",
                        *ratio),
            ratio, candidate};
  return {scene.render.integrator, "", ratio, candidate,
          std::make_shared<const GuidingData>(std::move(plan.guides))};
}

}  // namespace abbe
