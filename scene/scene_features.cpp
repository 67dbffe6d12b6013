#include "scene/scene_features.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "scene/coincidence.h"
#include "scene/coincident_shapes.h"
#include "scene/scene.h"
#include "scene/shapes/shape.h"
#include "scene/small_light.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

// Solid angle [sr] below which photons sample a light's caustics. Path tracing hits such a light by chance in
// fewer than one in 250 directions.
constexpr double kSmallLight_sr = 0.05;

constexpr std::array<FeatureName, 14> kFeatures{{
    {"dispersion", &SceneFeatures::dispersion, "a refractive index varies with wavelength"},
    {"media", &SceneFeatures::media, "a medium absorbs light"},
    {"scattering", &SceneFeatures::scattering, "a medium scatters light"},
    {"boundaries", &SceneFeatures::boundaries, "a medium begins and ends without an interface"},
    {"nesting", &SceneFeatures::nesting,
     "media may be nested, or a medium may coincide with another one, a sheet or a wall"},
    {"caustics", &SceneFeatures::caustics,
     "a specular surface can focus light onto a surface that is not specular"},
    {"light_tracing", &SceneFeatures::light_tracing,
     "a camera sees caustics of a light too small to be hit by chance, or such a light illuminates a probe "
     "with an area through specular media"},
    {"environment", &SceneFeatures::environment, "light arrives from infinity in all directions"},
    {"textures", &SceneFeatures::textures,
     "a material, its relief or vertex normals vary over the surface, or the material is anisotropic"},
    {"delta_lights", &SceneFeatures::delta_lights, "point, spot or directional lights"},
    {"polarisation_matters", &SceneFeatures::polarisation_relevant,
     "light polarised by one event may meet another that depends on polarisation"},
    {"depth_of_field", &SceneFeatures::depth_of_field, "a lens of finite aperture"},
    {"angular_response", &SceneFeatures::angular_response,
     "a filter shifts with the angle of incidence on the film"},
    {"motion", &SceneFeatures::motion, "a shape, a light or the camera moves while the film is exposed"},
}};

// Sets a feature and records the first object that causes it.
void require(SceneFeatures& features, bool SceneFeatures::*member, bool condition, const char* kind,
             const std::string& name) {
  if (!condition || features.*member) return;
  features.*member = true;
  const auto* known = std::find_if(kFeatures.begin(), kFeatures.end(),
                                   [member](const FeatureName& n) { return n.member == member; });
  features.reasons[known->key] = name.empty() ? kind : fmt::format("{} \"{}\"", kind, name);
}

// Bounds of an object that matters for nested media:
// - a shape that light enters through an interface, or whose appearance depends on the surrounding medium;
// - a boundary of a medium without an interface;
// - all faces with one material that bounds a medium, which together may form a body.
struct MediumBounds {
  Imath::Box3d box;
  const ShapeInstance* shape;  // first face of a body
  bool has_interface;          // the medium has an interface
  bool face;                   // bounds a medium, but encloses no volume by itself
  bool body = false;           // made of faces
};

std::vector<MediumBounds> medium_bounds(const Scene& scene) {
  std::vector<MediumBounds> all;
  std::map<std::uint32_t, MediumBounds> bodies;  // by material
  for (const ShapeInstance& instance : scene.shapes) {
    const Material& material = scene.materials[instance.material];
    if (!depends_on_outside(material) && !is_boundary(material)) continue;
    const bool face = encloses_medium(material) && !(instance.volume > 0);
    all.push_back({bounds(instance.shape), &instance, interior_index(material) != nullptr, face});
    if (!face) continue;
    MediumBounds& body = bodies.try_emplace(instance.material, all.back()).first->second;
    body.box.extendBy(all.back().box);
    body.body = true;
  }
  for (const auto& [material, body] : bodies) all.push_back(body);
  return all;
}

// True if one is a body and the other one of its faces.
bool is_face_of(const MediumBounds& a, const MediumBounds& b) {
  return (a.body || b.body) && a.face && b.face && a.shape->material == b.shape->material;
}

// Finds a shape whose box intersects that of another shape or body, where one of them has an interface. Boxes
// are swept in order of x.
const ShapeInstance* nested_shape(const Scene& scene) {
  std::vector<MediumBounds> all = medium_bounds(scene);
  std::sort(all.begin(), all.end(),
            [](const MediumBounds& a, const MediumBounds& b) { return a.box.min.x < b.box.min.x; });
  const double tolerance = scene.coincidence_tolerance();
  // If there are too many pairs, the media are assumed to be nested.
  std::size_t pairs = 0;
  for (auto a = all.begin(); a != all.end(); ++a) {
    const Imath::Box3d near = grown(a->box, tolerance);
    for (auto b = a + 1; b != all.end() && b->box.min.x <= near.max.x; ++b)
      if (++pairs > kMaxPairs ||
          ((a->has_interface || b->has_interface) && near.intersects(b->box) && !is_face_of(*a, *b)))
        return b->shape;
  }
  return nullptr;
}

// True if the BSDF depends on the position on the surface.
bool varies(const ShapeInstance& instance, const Material& material) {
  const auto* mesh = plain<Mesh>(instance.shape);
  return needs_coordinates(material) || (mesh != nullptr && !mesh->normals.empty());
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
  if (is_flat(instance.shape)) return 1;
  const auto ball = ball_of(instance.shape);
  const bool views_outside = ball && !std::holds_alternative<PlacedShape>(instance.shape) &&
                             (center(scene.camera) - ball->center).length() > ball->radius;
  return opaque(material) && views_outside ? 1 : 2;
}

// The object that makes polarisation relevant: its kind and its name.
struct PolarisationCause {
  const char* kind;
  std::string name;
};

// Finds the first object that makes polarisation affect what the film records: a channel with an analyser,
// otherwise the light or shape at which two events suffice. The first event polarises the light: at a shape,
// or the emission of a polarised light. The second, at a shape or in the lens, depends on the polarisation.
// The result is conservative, because paths are not traced. Nothing if unpolarised transport is exact.
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

void analyse_media(const Scene& scene, SceneFeatures& features) {
  const ShapeInstance* specular = nullptr;
  bool scattering = false;
  for (const ShapeInstance& instance : scene.shapes) {
    const Material& material = scene.materials[instance.material];
    const RefractiveIndex* index = interior_index(material);
    require(features, &SceneFeatures::dispersion, is_dispersive(material), "shape", instance.name);
    const Medium* contents = medium(material);
    features.encloses_media = features.encloses_media || encloses_medium(material);
    const bool absorbing = (index != nullptr && index->absorbing()) || (contents && contents->absorbs());
    const bool turbid = contents != nullptr && contents->scatters();
    require(features, &SceneFeatures::media, absorbing, "shape", instance.name);
    require(features, &SceneFeatures::scattering, turbid, "shape", instance.name);
    require(features, &SceneFeatures::boundaries, is_boundary(material), "shape", instance.name);
    require(features, &SceneFeatures::textures, varies(instance, material), "shape", instance.name);
    const Lobes material_lobes = lobes(material);
    scattering = scattering || material_lobes.spread || turbid;
    if (material_lobes.delta && specular == nullptr) specular = &instance;
  }
  const bool has_local_light = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return !light.is_environment() && emits(light);
  });
  if (specular != nullptr)
    require(features, &SceneFeatures::caustics, scattering && has_local_light, "shape", specular->name);
  const ShapeInstance* nested = nested_shape(scene);
  if (nested == nullptr)
    if (const auto contact = find_coincident_shape(scene)) nested = &scene.shapes[*contact];
  if (nested != nullptr) require(features, &SceneFeatures::nesting, true, "shape", nested->name);
  if (const auto polarising = polarisation_cause(scene))
    require(features, &SceneFeatures::polarisation_relevant, true, polarising->kind, polarising->name);
}

void analyse_lights(const Scene& scene, SceneFeatures& features) {
  const bool probe = is_probe(scene.camera);
  const Viewpoints centers = specular_centers(scene);
  const Viewpoints viewpoints = probe ? probe_viewpoints(scene) : centers;
  const bool photons_arrive =
      probe ? traits(scene.camera).opening && !centers.points.empty() : features.caustics;
  for (const Light& light : scene.lights) {
    require(features, &SceneFeatures::environment, light.is_environment(), "light", light.name);
    require(features, &SceneFeatures::delta_lights, light.is_delta(), "light", light.name);
    features.light_is_traced.push_back(photons_arrive && !light.is_environment() && emits(light) &&
                                       subtends_less(scene, light, viewpoints, kSmallLight_sr));
    require(features, &SceneFeatures::light_tracing, features.light_is_traced.back(), "light", light.name);
  }
}

void analyse_motion(const Scene& scene, SceneFeatures& features) {
  for (const ShapeInstance& instance : scene.shapes)
    require(features, &SceneFeatures::motion, motion_of(instance.shape) != nullptr, "shape", instance.name);
  for (const Light& light : scene.lights)
    require(features, &SceneFeatures::motion, motion_of(light, scene.shapes) != nullptr, "light", light.name);
  require(features, &SceneFeatures::motion, scene.camera.motion != nullptr, "camera", "");
}

}  // namespace

std::span<const FeatureName> feature_names() {
  return kFeatures;
}

SceneFeatures analyse(const Scene& scene) {
  SceneFeatures features;
  analyse_media(scene, features);
  analyse_lights(scene, features);
  for (const Channel& channel : scene.channels)
    require(features, &SceneFeatures::angular_response, channel.angular.has_value(), "channel", channel.name);
  analyse_motion(scene, features);
  require(features, &SceneFeatures::depth_of_field, traits(scene.camera).depth_of_field, "camera", "");
  return features;
}

bool carries_polarisation(const Scene& scene) {
  return scene.features.polarisation_relevant && scene.render.polarisation;
}

}  // namespace abbe
