#include "transport/plan/techniques.h"

#include <algorithm>

namespace abbe {

std::vector<Technique> chosen_techniques(const Scene& scene) {
  if (scene.render.integrator != Integrator::automatic) return {scene.render.integrator};
  if (scene.features.light_tracing) return {kAutomaticPaths, kAutomaticPhotons};
  return {kAutomaticPaths};
}

std::vector<PathClass> unsampled_paths(const Scene& scene) {
  return unsampled_paths(scene, scene.features, traces(chosen_techniques(scene), TracedPaths::light));
}

bool traces(std::span<const Technique> techniques, TracedPaths paths) {
  return std::any_of(techniques.begin(), techniques.end(),
                     [paths](Technique technique) { return traits(technique).traces == paths; });
}

bool starts_at_camera(Technique technique) {
  const TracedPaths traced = traits(technique).traces;
  return traced != TracedPaths::light && traced != TracedPaths::light_by_chance;
}

bool starts_at_lights(std::span<const Technique> techniques) {
  return std::any_of(techniques.begin(), techniques.end(), [](Technique technique) {
    const TracedPaths traced = traits(technique).traces;
    return traced != TracedPaths::camera && traced != TracedPaths::camera_by_chance;
  });
}

bool gathers_photons(Technique technique) {
  return traits(technique).traces == TracedPaths::photons;
}

std::string_view bias_of(Technique technique) {
  switch (traits(technique).merging) {
    case Merging::nearest:
      return "blurred, over the nearest photons of a sample";
    case Merging::radius:
      return "blurred, over a radius that shrinks from sample to sample: consistent, not unbiased";
    case Merging::none:
      break;
  }
  return "";
}

std::string owned_paths(Technique technique, std::span<const Technique> active, const Camera& camera) {
  const IntegratorTraits& owner = traits(technique);
  const bool alone = active.size() == 1;
  if (owner.traces == TracedPaths::light && is_probe(camera))
    return alone ? "E (S|D)* L"
                 : "E S L and E S (S|D)* S L of traced lights, E (S|D)* S L of lights without area";
  if (alone) return std::string(owner.owned);
  return owner.traces == TracedPaths::light ? "E D (S|D)* S L of traced lights"
                                            : "E (S|D)* L, except paths owned by light";
}

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
