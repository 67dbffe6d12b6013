#include "scene/polarisation_need.h"

#include <algorithm>
#include <variant>

#include "scene/scene.h"

namespace abbe {
namespace {

// A bare metal of n = 0 lets nothing in, and reflects s and p alike; a coating may absorb one more than the
// other.
bool is_perfect(const ConductorMaterial& metal) {
  if (!metal.coating.layers.empty()) return false;
  for (double lambda_nm = kMinWavelengthNm; lambda_nm <= kMaxWavelengthNm; ++lambda_nm)
    if (metal.index.n(lambda_nm) > 0) return false;
  return true;
}

// Whether light that meets a surface may go on as polarised as it was, although unpolarised light leaves it
// so: what sends light on in this way may bring it back to where it has been polarised.
bool hands_on(const Material& material) {
  const auto& model = material.model;
  if (const auto* mixture = std::get_if<MixtureMaterial>(&model))
    return std::any_of(mixture->components.begin(), mixture->components.end(),
                       [](const auto& component) { return hands_on(*component.material); });
  const auto* metal = std::get_if<ConductorMaterial>(&model);
  return std::holds_alternative<MirrorMaterial>(model) || std::holds_alternative<SchlickMaterial>(model) ||
         (metal != nullptr && is_perfect(*metal));
}

// Whether unpolarised light may leave a surface polarised.
bool polarises(const Material& material) {
  const auto& model = material.model;
  if (const auto* mixture = std::get_if<MixtureMaterial>(&model))
    return std::any_of(mixture->components.begin(), mixture->components.end(),
                       [](const auto& component) { return polarises(*component.material); });
  if (hands_on(material) || std::holds_alternative<MediumMaterial>(model)) return false;
  return lobes(material).delta || std::holds_alternative<RoughDielectricMaterial>(model) ||
         std::holds_alternative<RoughConductorMaterial>(model);
}

bool holds_camera(const Sphere& sphere, const Scene& scene) {
  return (middle(scene.camera) - sphere.center).length() <= sphere.radius;
}

// How many events at the shape a path may have in a row, two standing for any more, if nothing else sends
// light back to it. Light meets the outside of an opaque ball once, its inside again and again.
int events_in_a_row(const Scene& scene, const ShapeInstance& instance) {
  const Material& material = scene.materials[instance.material];
  const Medium* filling = medium(material);
  if (filling != nullptr && filling->scatters() && std::holds_alternative<RayleighPhase>(filling->phase))
    return 2;
  if (!polarises(material)) return 0;
  if (plain<Mesh>(instance.shape) != nullptr) return 2;
  if (plain<Sphere>(instance.shape) == nullptr) return 1;
  const auto* plain_sphere = std::get_if<Sphere>(&instance.shape);
  return opaque(material) && plain_sphere != nullptr && !holds_camera(*plain_sphere, scene) ? 1 : 2;
}

}  // namespace

// A sensor that tells how light is polarised is told; a polarised lamp stands for a first event, a lens that
// polarises for a last one.
std::optional<PolarisationNeed> polarisation_need(const Scene& scene) {
  const auto analysing = std::find_if(scene.channels.begin(), scene.channels.end(),
                                      [](const Channel& channel) { return channel.analyser.has_value(); });
  if (analysing != scene.channels.end()) return PolarisationNeed{"channel", analysing->name};
  const bool polarised_lamp = std::any_of(scene.lights.begin(), scene.lights.end(),
                                          [](const Light& light) { return light.polarisation.has_value(); });
  const bool comes_back = std::any_of(
      scene.shapes.begin(), scene.shapes.end(),
      [&scene](const ShapeInstance& instance) { return hands_on(scene.materials[instance.material]); });
  int events = (polarised_lamp ? 1 : 0) + (traits(scene.camera).polarises ? 1 : 0);
  for (const ShapeInstance& instance : scene.shapes) {
    const int here = events_in_a_row(scene, instance);
    events += here;
    if (events >= 2 || (here > 0 && comes_back)) return PolarisationNeed{"shape", instance.name};
  }
  return std::nullopt;
}

bool carries_polarisation(const Scene& scene) {
  return scene.needs.polarisation_matters && scene.render.polarisation;
}

}  // namespace abbe
