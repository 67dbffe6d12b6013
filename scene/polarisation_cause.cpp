#include "scene/polarisation_cause.h"

#include <algorithm>
#include <variant>

#include "scene/scene.h"

namespace abbe {
namespace {

// A bare metal with n = 0 absorbs nothing and reflects s and p alike. A coating may absorb one more than the
// other.
bool is_perfect(const ConductorMaterial& metal) {
  if (!metal.coating.layers.empty()) return false;
  for (double lambda_nm = kMinWavelengthNm; lambda_nm <= kMaxWavelengthNm; ++lambda_nm)
    if (metal.index.n(lambda_nm) > 0) return false;
  return true;
}

// True if a surface may preserve the polarisation of polarised light although it leaves unpolarised light
// unpolarised. It may return light to where that has been polarised.
bool preserves_polarisation(const Material& material) {
  const auto& model = material.model;
  if (const auto* mixture = std::get_if<MixtureMaterial>(&model))
    return std::any_of(mixture->components.begin(), mixture->components.end(),
                       [](const auto& component) { return preserves_polarisation(*component.material); });
  const auto* metal = std::get_if<ConductorMaterial>(&model);
  return std::holds_alternative<MirrorMaterial>(model) || std::holds_alternative<SchlickMaterial>(model) ||
         (metal != nullptr && is_perfect(*metal));
}

// True if a surface may polarise unpolarised light.
bool polarises(const Material& material) {
  const auto& model = material.model;
  if (const auto* mixture = std::get_if<MixtureMaterial>(&model))
    return std::any_of(mixture->components.begin(), mixture->components.end(),
                       [](const auto& component) { return polarises(*component.material); });
  if (preserves_polarisation(material) || std::holds_alternative<MediumMaterial>(model)) return false;
  return lobes(material).delta || std::holds_alternative<RoughDielectricMaterial>(model) ||
         std::holds_alternative<RoughConductorMaterial>(model);
}

bool holds_camera(const Sphere& sphere, const Scene& scene) {
  return (center(scene.camera) - sphere.center).length() <= sphere.radius;
}

// Number of consecutive events at the shape that a path may have, with 2 for any larger number, if nothing
// else returns light to it. Light meets the outside of an opaque sphere once, but its inside repeatedly.
int events_in_a_row(const Scene& scene, const ShapeInstance& instance) {
  const Material& material = scene.materials[instance.material];
  const Medium* contents = medium(material);
  if (contents != nullptr && contents->scatters() && std::holds_alternative<RayleighPhase>(contents->phase))
    return 2;
  if (!polarises(material)) return 0;
  if (plain<Mesh>(instance.shape) != nullptr) return 2;
  if (plain<Sphere>(instance.shape) == nullptr) return 1;
  const auto* plain_sphere = std::get_if<Sphere>(&instance.shape);
  return opaque(material) && plain_sphere != nullptr && !holds_camera(*plain_sphere, scene) ? 1 : 2;
}

}  // namespace

// A sensor that measures polarisation always needs it. A polarised light counts as a first event and a
// polarising lens as a last one.
std::optional<PolarisationCause> polarisation_cause(const Scene& scene) {
  const auto analysing = std::find_if(scene.channels.begin(), scene.channels.end(),
                                      [](const Channel& channel) { return channel.analyser.has_value(); });
  if (analysing != scene.channels.end()) return PolarisationCause{"channel", analysing->name};
  const auto polarised_light = std::find_if(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.polarisation.has_value();
  });
  const bool has_polarised_light = polarised_light != scene.lights.end();
  const bool polarising_lens = traits(scene.camera).polarises;
  if (has_polarised_light && polarising_lens) return PolarisationCause{"light", polarised_light->name};
  const bool returns_light =
      std::any_of(scene.shapes.begin(), scene.shapes.end(), [&scene](const ShapeInstance& instance) {
        return preserves_polarisation(scene.materials[instance.material]);
      });
  int events = has_polarised_light || polarising_lens ? 1 : 0;
  for (const ShapeInstance& instance : scene.shapes) {
    const int here = events_in_a_row(scene, instance);
    events += here;
    if (events >= 2 || (here > 0 && returns_light)) return PolarisationCause{"shape", instance.name};
  }
  return std::nullopt;
}

bool carries_polarisation(const Scene& scene) {
  return scene.features.polarisation_relevant && scene.render.polarisation;
}

}  // namespace abbe
