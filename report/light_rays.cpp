#include "report/light_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "scene/shapes/shape.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

using V3d = Imath::V3d;

// Offset of a ray's origin from the light's surface as a fraction of the scene's size; positions are in
// double.
constexpr double kSurfaceOffset = 1e-12;

V3d scene_center(const Scene& scene) {
  return scene.bounds.isEmpty() ? V3d(0) : scene.bounds.center();
}

// Two directions perpendicular to the axis, the first of them horizontal.
std::pair<V3d, V3d> perpendicular_axes(const V3d& axis) {
  V3d side = V3d(0, 0, 1).cross(axis);
  if (side.length() < 1e-6) side = V3d(1, 0, 0);
  side.normalize();
  return {side, axis.cross(side).normalized()};
}

struct SurfaceCenter {
  V3d point;
  V3d normal;
};

// `sample_area` returns float positions; those on spheres and meshes are projected onto the surface.
SurfaceCenter surface_center(const Shape& shape) {
  // A moving shape is drawn at its position of time 0.
  if (const auto* placed = std::get_if<PlacedShape>(&shape)) {
    const Shape at_rest = std::visit([](const auto& s) { return Shape(s); }, placed->of->shape);
    const auto [point, normal] = surface_center(at_rest);
    return {point * placed->at->to_world, normal_to_world(*placed->at, normal)};
  }
  if (const auto face = flat_face(shape)) return {face->center, face->normal};
  const SurfacePoint drawn = sample_area(shape, triangle_cdf(shape), {0.5F, 0.5F});
  const V3d point(drawn.point);
  const V3d normal = V3d(drawn.normal).normalized();
  const V3d above = point + 8 * float_step(largest_coordinate(point)) * normal;
  const auto hit = intersect(shape, BasicRay<double>{above, -normal}, 0.0);
  return hit ? SurfaceCenter{hit->point, hit->normal} : SurfaceCenter{point, normal};
}

}  // namespace

const Light& light_named(const Scene& scene, const std::string& name, const std::string& option) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights) {
    if (light.name == name) return light;
    names.push_back(light.name);
  }
  throw Error(ErrorCode::usage, option,
              fmt::format("no such light (got \"{}\", allowed {})", name, fmt::join(names, ", ")));
}

std::optional<BasicRay<double>> central_ray(const Scene& scene, const Light& light) {
  const std::optional<std::uint32_t> surface = surface_of(light);
  if (!surface) return central_ray(light, Ball{scene_center(scene), scene_radius(scene.bounds)});
  const auto [point, normal] = surface_center(scene.shapes[*surface].shape);
  return BasicRay<double>{point + kSurfaceOffset * (scene_radius(scene.bounds) + point.length()) * normal,
                          normal};
}

bool is_omitted(const Scene& scene, const Light& light) {
  return !scene.bounds.isEmpty() && scene.is_distant(light);
}

std::vector<BasicRay<double>> light_rays(const Scene& scene, const Light& light, int count) {
  const std::optional<BasicRay<double>> central = central_ray(scene, light);
  if (!central || is_omitted(scene, light)) return {};
  const V3d& axis = central->direction;
  const auto [side, up] = perpendicular_axes(axis);
  const double fan = fan_of(light);
  std::vector<BasicRay<double>> rays;
  for (const V3d& of : {side, up})
    for (int i = 0; i < count; ++i) {
      // t runs from -1 to 1. A full circle omits the end, which is its start.
      const double t = count == 1 ? 0 : 2.0 * i / (fan < std::numbers::pi ? count - 1 : count) - 1;
      if (light.at_infinity())
        rays.push_back({central->origin + t * scene_radius(scene.bounds) * of, axis});
      else
        rays.push_back({central->origin, std::cos(t * fan) * axis + std::sin(t * fan) * of});
    }
  return rays;
}

}  // namespace abbe
