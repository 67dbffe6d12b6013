#include "scene/dark_enclosure.h"

#include <algorithm>

#include "scene/shapes/solid.h"

namespace abbe {
namespace {

// How often more a ray leaves a shape than it enters it.
int exits(const Shape& shape, const Imath::V3d& from, const Imath::V3d& direction, double apart) {
  int count = 0;
  double t = 0;
  while (const auto met = intersect(shape, BasicRay<double>{from, direction}, t)) {
    count += met->normal.dot(direction) > 0 ? 1 : -1;
    t = met->t + apart;
  }
  return count;
}

// Of a copy, since what is open is found where a mesh is made solid.
bool has_openings(const Shape& shape) {
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  return make_solid(copy).open_edges > 0;
}

bool encloses(const Shape& shape, const Imath::V3d& point) {
  constexpr double kApart = 1e-9;  // of two surfaces, relative to the shape
  const auto askew = askew_direction<double>();
  const Imath::Box3d box = bounds(shape);
  const double apart = kApart * box.size().length();
  return apart > 0 && box.intersects(point) && exits(shape, point, askew, apart) > 0 &&
         exits(shape, point, -askew, apart) > 0;
}

// Whether a light stands in the shape or emits into it.
bool lit(const Scene& scene, std::uint32_t enclosure) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    const auto* area = std::get_if<AreaLight>(&light.kind);
    if (area != nullptr && area->shape == enclosure) return area->two_sided;
    if (motion_of(light, scene.shapes) != nullptr) return true;  // it may come in
    if (area == nullptr && !std::holds_alternative<PointLight>(light.kind) &&
        !std::holds_alternative<SpotLight>(light.kind))
      return false;  // infinitely far
    return std::ranges::any_of(kSpreadOverLight, [&](const std::array<float, 2>& u) {
      const EmissionPoint from = sample_emission_point(light, scene.shapes, {u[0], u[1]}, 0);
      return encloses(scene.shapes[enclosure].shape, Imath::V3d(from.point));
    });
  });
}

// Where its rays begin: of a meter here and there.
std::vector<Imath::V3d> places_of(const Camera& camera) {
  if (!is_meter(camera)) return {middle(camera)};
  std::vector<Imath::V3d> places;
  for (const std::array<float, 2>& u : kSpreadOverLight)
    places.emplace_back(meter_point(camera, {u[0], u[1]}));
  return places;
}

}  // namespace

std::optional<std::uint32_t> dark_enclosure(const Scene& scene) {
  const std::vector<Imath::V3d> camera = places_of(scene.camera);
  if (scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeInstance& instance = scene.shapes[i];
    if (motion_of(instance.shape) == nullptr && opaque(scene.materials[instance.material]) &&
        std::ranges::all_of(camera, [&](const auto& at) { return encloses(instance.shape, at); }) &&
        !lit(scene, i) && !has_openings(instance.shape))
      return i;
  }
  return std::nullopt;
}

}  // namespace abbe
