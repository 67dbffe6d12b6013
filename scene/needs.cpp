#include "scene/needs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/coincidence.h"
#include "scene/contact.h"
#include "scene/extent.h"
#include "scene/polarisation_need.h"
#include "scene/scene.h"
#include "scene/shapes/placed.h"
#include "scene/small_light.h"

namespace abbe {
namespace {

// Solid angle [sr] below which a light is left to the light tracer: path tracing then finds it by chance in
// less than one in 250 directions.
constexpr double kSmallLight_sr = 0.05;

constexpr std::array<NeedName, 15> kNeeds{{
    {"dispersion", &Needs::dispersion, "a refractive index varies with wavelength"},
    {"media", &Needs::media, "matter absorbs along the path"},
    {"scattering", &Needs::scattering, "matter scatters light within"},
    {"boundaries", &Needs::boundaries, "matter begins and ends without an interface"},
    {"nesting", &Needs::nesting, "matter may be within other matter, or touch it, a sheet or a wall"},
    {"caustics", &Needs::caustics, "a specular surface can focus a light onto one that is not"},
    {"light_tracing", &Needs::light_tracing,
     "caustics of a light too small to be hit by chance, seen by a camera, or its light through specular "
     "matter on a meter that is no point"},
    {"environment", &Needs::environment, "light from infinity all around"},
    {"textures", &Needs::textures,
     "a material, its relief or vertex normals vary over the surface, or it has a direction along it"},
    {"delta_lights", &Needs::delta_lights, "point, spot or directional lights"},
    {"narrow_bands", &Needs::narrow_bands, "an emission or a response has features narrower than 10 nm"},
    {"polarisation_matters", &Needs::polarisation_matters,
     "light that one event has polarised may meet another that depends on it"},
    {"depth_of_field", &Needs::depth_of_field, "a lens of finite aperture"},
    {"angular_response", &Needs::angular_response, "a filter shifts with the angle of incidence on the film"},
    {"motion", &Needs::motion, "a shape, a light or the camera moves while the film is exposed"},
}};

// Remembers the first thing that asks for a need.
void require(Needs& needs, bool Needs::*need, bool asked, const char* kind, const std::string& name) {
  if (!asked || needs.*need) return;
  needs.*need = true;
  const auto* known =
      std::find_if(kNeeds.begin(), kNeeds.end(), [need](const NeedName& n) { return n.member == need; });
  needs.because[known->key] = name.empty() ? kind : fmt::format("{} \"{}\"", kind, name);
}

// A shape that light enters by an interface, another one that looks otherwise there, or one that ends matter
// without an interface; or all the faces that bound matter of one material, which may be a body.
struct Bounded {
  Imath::Box3d box;
  const ShapeInstance* shape;  // of a body the first face
  bool filled;                 // behind an interface
  bool face;                   // bounds matter, but no volume by itself
  bool body = false;           // made of faces
};

std::vector<Bounded> boxes_where_matter_counts(const Scene& scene) {
  std::vector<Bounded> all;
  std::map<std::uint32_t, Bounded> bodies;  // by material
  for (const ShapeInstance& instance : scene.shapes) {
    const Material& material = scene.materials[instance.material];
    if (!depends_on_outside(material) && !is_boundary(material)) continue;
    const bool face = encloses_medium(material) && !(instance.volume > 0);
    all.push_back({bounds(instance.shape), &instance, interior(material) != nullptr, face});
    if (!face) continue;
    Bounded& body = bodies.try_emplace(instance.material, all.back()).first->second;
    body.box.extendBy(all.back().box);
    body.body = true;
  }
  for (const auto& [material, body] : bodies) all.push_back(body);
  return all;
}

// Whether one is a body of which the other is a face.
bool belong_together(const Bounded& a, const Bounded& b) {
  return (a.body || b.body) && a.face && b.face && a.shape->material == b.shape->material;
}

// One of two shapes, or bodies made of faces, the boxes of which meet, if one of them is filled. Boxes are
// asked in order of x.
const ShapeInstance* nested_shape(const Scene& scene) {
  std::vector<Bounded> all = boxes_where_matter_counts(scene);
  std::sort(all.begin(), all.end(),
            [](const Bounded& a, const Bounded& b) { return a.box.min.x < b.box.min.x; });
  const double reach = scene.touch_distance();
  // In a scene so full that the most pairs do not tell, matter is taken to touch somewhere.
  std::size_t pairs = 0;
  for (auto a = all.begin(); a != all.end(); ++a) {
    const Imath::Box3d near = grown(a->box, reach);
    for (auto b = a + 1; b != all.end() && b->box.min.x <= near.max.x; ++b)
      if (++pairs > kMostPairs ||
          ((a->filled || b->filled) && near.intersects(b->box) && !belong_together(*a, *b)))
        return b->shape;
  }
  return nullptr;
}

// Whether scattering depends on where on the surface it happens.
bool varies(const ShapeInstance& instance, const Material& material) {
  const auto* mesh = plain<Mesh>(instance.shape);
  return needs_coordinates(material) || (mesh != nullptr && !mesh->normals.empty());
}

void analyse_matter(const Scene& scene, Needs& needs) {
  const ShapeInstance* specular = nullptr;
  bool scattering = false;
  for (const ShapeInstance& instance : scene.shapes) {
    const Material& material = scene.materials[instance.material];
    const RefractiveIndex* inside = interior(material);
    require(needs, &Needs::dispersion, is_dispersive(material), "shape", instance.name);
    const Medium* filling = medium(material);
    needs.matter = needs.matter || encloses_medium(material);
    const bool absorbing = (inside != nullptr && inside->absorbing()) || (filling && filling->absorbs());
    const bool turbid = filling != nullptr && filling->scatters();
    require(needs, &Needs::media, absorbing, "shape", instance.name);
    require(needs, &Needs::scattering, turbid, "shape", instance.name);
    require(needs, &Needs::boundaries, is_boundary(material), "shape", instance.name);
    require(needs, &Needs::textures, varies(instance, material), "shape", instance.name);
    const Lobes sent = lobes(material);
    scattering = scattering || sent.spread || turbid;
    if (sent.delta && specular == nullptr) specular = &instance;
  }
  const bool lit = std::any_of(scene.lights.begin(), scene.lights.end(),
                               [](const Light& light) { return !light.is_environment() && emits(light); });
  if (specular != nullptr) require(needs, &Needs::caustics, scattering && lit, "shape", specular->name);
  const ShapeInstance* nested = nested_shape(scene);
  if (nested == nullptr)
    if (const auto contact = crossed_at_once(scene)) nested = &scene.shapes[contact->shape];
  if (nested != nullptr) require(needs, &Needs::nesting, true, "shape", nested->name);
  if (const auto polarising = polarisation_need(scene))
    require(needs, &Needs::polarisation_matters, true, polarising->kind, polarising->name);
}

void analyse_lights(const Scene& scene, Needs& needs) {
  const bool meter = is_meter(scene.camera);
  const Viewpoints centers = specular_centers(scene);
  const Viewpoints looked_at_from = meter ? places_of_meter(scene) : centers;
  const bool photons_arrive =
      meter ? traits(scene.camera).opening && !centers.places.empty() : needs.caustics;
  std::set<const Curve*> examined;  // which many lights may share
  for (const Light& light : scene.lights) {
    require(needs, &Needs::environment, light.is_environment(), "light", light.name);
    require(needs, &Needs::delta_lights, light.is_delta(), "light", light.name);
    const Curve& emission = light.emission.base();
    if (emits(light) && examined.insert(&emission).second)
      require(needs, &Needs::narrow_bands, has_narrow_feature(emission), "light", light.name);
    needs.light_is_traced.push_back(photons_arrive && !light.is_environment() && emits(light) &&
                                    looks_smaller(scene, light, looked_at_from, kSmallLight_sr));
    require(needs, &Needs::light_tracing, needs.light_is_traced.back(), "light", light.name);
  }
}

void analyse_motion(const Scene& scene, Needs& needs) {
  for (const ShapeInstance& instance : scene.shapes)
    require(needs, &Needs::motion, motion_of(instance.shape) != nullptr, "shape", instance.name);
  for (const Light& light : scene.lights)
    require(needs, &Needs::motion, motion_of(light, scene.shapes) != nullptr, "light", light.name);
  require(needs, &Needs::motion, scene.camera.motion != nullptr, "camera", "");
}

// Distance from the peak at knot `i` to where the curve first falls to `level`, walking by `step`; infinite
// if that is beyond `reach`.
double fall_distance(std::span<const Knot> knots, std::size_t i, std::ptrdiff_t step, double level,
                     double reach) {
  const auto count = static_cast<std::ptrdiff_t>(knots.size());
  for (auto j = static_cast<std::ptrdiff_t>(i) + step; j >= 0 && j < count; j += step) {
    const Knot& knot = knots[static_cast<std::size_t>(j)];
    const Knot& before = knots[static_cast<std::size_t>(j - step)];
    const double value = std::abs(knot.value);
    if (std::abs(before.wavelength_nm - knots[i].wavelength_nm) > reach) break;
    if (value >= level) continue;
    const double share = (std::abs(before.value) - level) / (std::abs(before.value) - value);
    return std::abs(before.wavelength_nm + share * (knot.wavelength_nm - before.wavelength_nm) -
                    knots[i].wavelength_nm);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

bool has_narrow_feature(const Curve& curve, double width_nm) {
  const std::span<const Knot> knots = curve.knots();
  const double significant = 0.1 * std::max(std::abs(curve.max()), std::abs(curve.min()));
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double peak = std::abs(knots[i].value);
    if (!(peak > 0 && peak >= significant)) continue;
    if (fall_distance(knots, i, -1, peak / 2, width_nm) + fall_distance(knots, i, 1, peak / 2, width_nm) <
        width_nm)
      return true;
  }
  return false;
}

std::span<const NeedName> need_names() {
  return kNeeds;
}

Needs analyse(const Scene& scene) {
  Needs needs;
  analyse_matter(scene, needs);
  analyse_lights(scene, needs);
  for (const Channel& channel : scene.channels) {
    require(needs, &Needs::narrow_bands, has_narrow_feature(channel.weight), "channel", channel.name);
    require(needs, &Needs::angular_response, channel.angular.has_value(), "channel", channel.name);
  }
  analyse_motion(scene, needs);
  require(needs, &Needs::depth_of_field, traits(scene.camera).depth_of_field, "camera", "");
  return needs;
}

}  // namespace abbe
