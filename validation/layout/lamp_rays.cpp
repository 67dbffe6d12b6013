#include "validation/layout/lamp_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "scene/extent.h"
#include "scene/shapes/placed.h"

namespace abbe {
namespace {

using V3d = Imath::V3d;

constexpr double kSurfaceFan = std::numbers::pi / 3;
// How far beside its surface, which is known in double, a ray leaves a lamp, as a share of the scene.
constexpr double kClear = 1e-12;

V3d middle_of(const Scene& scene) {
  return scene.bounds.isEmpty() ? V3d(0) : scene.bounds.center();
}

// Two directions across another, the first of them horizontal.
std::pair<V3d, V3d> across(const V3d& axis) {
  V3d side = V3d(0, 0, 1).cross(axis);
  if (side.length() < 1e-6) side = V3d(1, 0, 0);
  side.normalize();
  return {side, axis.cross(side).normalized()};
}

struct SurfaceMiddle {
  V3d point;
  V3d normal;
};

// Points are drawn in float: those of round and meshed lamps are put onto their surface.
SurfaceMiddle surface_middle(const AreaLight& light, const Shape& shape) {
  if (const auto* placed =
          std::get_if<PlacedShape>(&shape)) {  // it moves, and is drawn where it is at time 0
    const Shape at_rest = std::visit([](const auto& s) { return Shape(s); }, placed->of->shape);
    const auto [point, normal] = surface_middle(light, at_rest);
    return {point * placed->at->to_world, normal_to_world(*placed->at, normal)};
  }
  if (const auto* quad = std::get_if<Quad>(&shape))
    return {quad->corner + (quad->edge_u + quad->edge_v) / 2, normal_of(*quad)};
  if (const auto* disc = std::get_if<Disc>(&shape)) return {disc->center, disc->normal};
  const SurfacePoint drawn = sample_area(shape, light.triangle_cdf, {0.5F, 0.5F});
  const V3d point(drawn.point);
  const V3d normal = V3d(drawn.normal).normalized();
  const V3d above = point + 8 * float_step(largest_coordinate(point)) * normal;
  const auto hit = intersect(shape, BasicRay<double>{above, -normal}, 0.0);
  return hit ? SurfaceMiddle{hit->point, hit->normal} : SurfaceMiddle{point, normal};
}

struct MiddleRay {
  const Scene& scene;

  std::optional<BasicRay<double>> operator()(const AreaLight& light) const {
    const auto [point, normal] = surface_middle(light, scene.shapes[light.shape].shape);
    return BasicRay<double>{point + kClear * (scene_radius(scene.bounds) + point.length()) * normal, normal};
  }
  std::optional<BasicRay<double>> operator()(const PointLight& light) const {
    const V3d towards = middle_of(scene) - light.position;
    return BasicRay<double>{light.position, towards.length() > 0 ? towards.normalized() : V3d(1, 0, 0)};
  }
  std::optional<BasicRay<double>> operator()(const SpotLight& light) const {
    return BasicRay<double>{light.position, light.axis};
  }
  std::optional<BasicRay<double>> operator()(const DirectionalLight& light) const {
    return from_infinity(light.towards);
  }
  std::optional<BasicRay<double>> operator()(const SunLight& light) const {
    return from_infinity(light.towards);
  }
  std::optional<BasicRay<double>> operator()(const EnvironmentLight&) const { return std::nullopt; }

  [[nodiscard]] BasicRay<double> from_infinity(const V3d& towards) const {
    return {middle_of(scene) + 1.5 * scene_radius(scene.bounds) * towards, -towards};
  }
};

// Half the angle of the fan.
double fan_of(const Light& light) {
  if (const auto* spot = std::get_if<SpotLight>(&light.kind))
    return 2 * std::asin(std::sqrt(std::min(1.0, static_cast<double>(spot->cap) / 2)));
  return light.is<PointLight>() ? std::numbers::pi : kSurfaceFan;
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

std::optional<BasicRay<double>> middle_ray(const Scene& scene, const Light& light) {
  return std::visit(MiddleRay{scene}, light.kind);
}

bool is_left_out(const Scene& scene, const Light& light) {
  return !scene.bounds.isEmpty() && scene.is_far(light);
}

std::vector<BasicRay<double>> lamp_rays(const Scene& scene, const Light& light, int count) {
  const std::optional<BasicRay<double>> middle = middle_ray(scene, light);
  if (!middle || is_left_out(scene, light)) return {};
  const V3d& axis = middle->direction;
  const auto [side, up] = across(axis);
  const double fan = fan_of(light);
  std::vector<BasicRay<double>> rays;
  for (const V3d& of : {side, up})
    for (int i = 0; i < count; ++i) {
      // From -1 to 1; a whole circle would have its ends twice.
      const double share = count == 1 ? 0 : 2.0 * i / (light.is<PointLight>() ? count : count - 1) - 1;
      if (light.at_infinity())
        rays.push_back({middle->origin + share * scene_radius(scene.bounds) * of, axis});
      else
        rays.push_back({middle->origin, std::cos(share * fan) * axis + std::sin(share * fan) * of});
    }
  return rays;
}

}  // namespace abbe
