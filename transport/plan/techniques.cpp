#include "transport/plan/techniques.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace abbe {

std::string_view name_of(Technique technique) {
  return kIntegratorNames.at(static_cast<std::size_t>(technique) + 1);
}

std::vector<Technique> chosen_techniques(const Scene& scene) {
  // Both lists and their names have the same order, after `automatic`.
  constexpr auto kLast = static_cast<std::size_t>(Technique::adjoint_brute);
  static_assert(static_cast<std::size_t>(Integrator::adjoint_brute) == kLast + 1);
  static_assert(kIntegratorNames.size() == kLast + 2);
  if (scene.render.integrator != Integrator::automatic)
    return {static_cast<Technique>(static_cast<int>(scene.render.integrator) - 1)};
  if (scene.features.light_tracing) return {Technique::path, Technique::light};
  return {Technique::path};
}

std::vector<PathClass> unreached(const Scene& scene) {
  return unsampled_paths(scene, scene.features, uses(chosen_techniques(scene), Technique::light));
}

bool uses(std::span<const Technique> techniques, Technique technique) {
  return std::find(techniques.begin(), techniques.end(), technique) != techniques.end();
}

bool starts_at_lights(std::span<const Technique> techniques) {
  return std::any_of(techniques.begin(), techniques.end(), [](Technique technique) {
    return technique != Technique::path && technique != Technique::adjoint_brute;
  });
}

bool gathers_photons(Technique technique) {
  return technique == Technique::photon_map || technique == Technique::ppm || technique == Technique::sppm;
}

std::string_view bias_of(Technique technique) {
  if (technique == Technique::photon_map) return "blurred, over the nearest photons of a sample";
  if (technique == Technique::vcm || gathers_photons(technique))
    return "blurred, over a radius that shrinks from sample to sample: consistent, not unbiased";
  return "";
}

std::string owned_paths(Technique technique, std::span<const Technique> active, const Camera& camera) {
  switch (technique) {
    case Technique::bdpt:
      return "E (S|D)* L, except paths to lights without area that have no D next to another D or L";
    case Technique::photon_map:
    case Technique::ppm:
    case Technique::sppm:
    case Technique::vcm:
      return "E (S|D)* L, except E S* L of lights without area";
    case Technique::photon_brute:
      return "E (S|D)* L if E has an opening of finite size";
    case Technique::adjoint_brute:
      return "E (S|D)* L of lights with area";
    case Technique::path:
    case Technique::light:
      break;
  }
  const bool alone = active.size() == 1;
  if (technique == Technique::light && is_probe(camera))
    return alone ? "E (S|D)* L"
                 : "E S L and E S (S|D)* S L of traced lights, E (S|D)* S L of lights without area";
  if (technique == Technique::light) return alone ? "E D (S|D)* L" : "E D (S|D)* S L of traced lights";
  return alone ? "E (S|D)* L" : "E (S|D)* L, except paths owned by light";
}

bool scene_sets_photon_count(std::span<const Technique> techniques) {
  return uses(techniques, Technique::photon_brute) ||
         std::any_of(techniques.begin(), techniques.end(), gathers_photons);
}

std::vector<std::string_view> unused_photon_settings(const Scene& scene) {
  const PhotonSettings& spec = scene.render.photons;
  const PhotonSettings defaults;
  const std::vector<Technique> techniques = chosen_techniques(scene);
  const bool by_number = uses(techniques, Technique::photon_map);
  const bool by_radius = uses(techniques, Technique::ppm) || uses(techniques, Technique::sppm) ||
                         uses(techniques, Technique::vcm) || scene.render.consistent;
  std::vector<std::string_view> unused;
  if (spec.per_sample && !scene_sets_photon_count(techniques)) unused.emplace_back("per_sample");
  if (spec.radius_m && !by_radius) unused.emplace_back("radius");
  if (spec.nearest != defaults.nearest && !by_number) unused.emplace_back("nearest");
  if (spec.final_gather != defaults.final_gather && !by_number) unused.emplace_back("final_gather");
  return unused;
}

}  // namespace abbe
