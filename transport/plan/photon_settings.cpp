#include "transport/plan/photon_settings.h"

#include <algorithm>

namespace abbe {

bool scene_sets_photon_count(std::span<const Technique> techniques) {
  return std::any_of(techniques.begin(), techniques.end(), [](Technique technique) {
    return gathers_photons(technique) || traits(technique).traces == TracedPaths::light_by_chance;
  });
}

std::vector<std::string_view> unused_photon_settings(const Scene& scene) {
  const PhotonSettings& spec = scene.render.photons;
  const PhotonSettings defaults;
  const std::vector<Technique> techniques = chosen_techniques(scene);
  const Merging merging = traits(scene.render.integrator).merging;
  const bool by_number = merging == Merging::nearest;
  const bool by_radius = merging == Merging::radius || scene.render.consistent;
  std::vector<std::string_view> unused;
  if (spec.per_sample && !scene_sets_photon_count(techniques)) unused.emplace_back("per_sample");
  if (spec.radius_m && !by_radius) unused.emplace_back("radius");
  if (spec.nearest != defaults.nearest && !by_number) unused.emplace_back("nearest");
  if (spec.final_gather != defaults.final_gather && !by_number) unused.emplace_back("final_gather");
  return unused;
}

}  // namespace abbe
