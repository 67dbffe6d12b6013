#include "scene/dark_enclosure.h"

#include <algorithm>

#include "scene/shapes/solid.h"

namespace abbe {
namespace {

// Number of times that a ray leaves a shape, minus the number that it enters it.
int exits(const Shape& shape, const Imath::V3d& from, const Imath::V3d& direction, double min_step) {
  int count = 0;
  double t = 0;
  while (const auto hit = intersect(shape, BasicRay<double>{from, direction}, t)) {
    count += hit->normal.dot(direction) > 0 ? 1 : -1;
    t = hit->t + min_step;
  }
  return count;
}

// The test works on a copy, because `make_solid` modifies its mesh.
bool has_openings(const Shape& shape) {
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  return make_solid(copy).open_edges > 0;
}

bool encloses(const Shape& shape, const Imath::V3d& point) {
  constexpr double kMinStep = 1e-9;  // between two surfaces, relative to the shape
  const auto askew = askew_direction<double>();
  const Imath::Box3d box = bounds(shape);
  const double min_step = kMinStep * box.size().length();
  return min_step > 0 && box.intersects(point) && exits(shape, point, askew, min_step) > 0 &&
         exits(shape, point, -askew, min_step) > 0;
}

// True if a light lies in the shape or emits into it.
bool is_illuminated(const Scene& scene, std::uint32_t enclosure) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    const auto* area = std::get_if<AreaLight>(&light.kind);
    if (area != nullptr && area->shape == enclosure) return area->two_sided;
    if (motion_of(light, scene.shapes) != nullptr) return true;  // it may enter
    if (light.at_infinity()) return false;
    return std::ranges::any_of(kRepresentativePoints, [&](const std::array<float, 2>& u) {
      const EmissionPoint from = sample_emission_point(light, scene.shapes, {u[0], u[1]}, 0);
      return encloses(scene.shapes[enclosure].shape, Imath::V3d(from.point));
    });
  });
}

// Origins of the camera's rays; for a probe representative points.
std::vector<Imath::V3d> ray_origins_of(const Camera& camera) {
  if (!is_probe(camera)) return {center(camera)};
  std::vector<Imath::V3d> camera_points;
  for (const std::array<float, 2>& u : kRepresentativePoints)
    camera_points.emplace_back(probe_point(camera, {u[0], u[1]}));
  return camera_points;
}

}  // namespace

std::optional<std::uint32_t> dark_enclosure(const Scene& scene) {
  const std::vector<Imath::V3d> camera = ray_origins_of(scene.camera);
  if (scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeInstance& instance = scene.shapes[i];
    if (motion_of(instance.shape) == nullptr && opaque(scene.materials[instance.material]) &&
        std::ranges::all_of(camera, [&](const auto& at) { return encloses(instance.shape, at); }) &&
        !is_illuminated(scene, i) && !has_openings(instance.shape))
      return i;
  }
  return std::nullopt;
}

}  // namespace abbe
