#include "transport/plan/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/shapes/basic.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

constexpr EmissionCone kEverywhere{{0, 0, 1}, std::numbers::pi, 0};

LightBounds area_light_bounds(const AreaLight& light, const Scene& scene, double emission) {
  const Shape& shape = scene.shapes[light.shape].shape;
  const OuterSide side = outer_side(shape);
  const EmissionCone normals =
      side.normals && !light.two_sided
          ? EmissionCone{side.normals->axis, side.normals->spread, std::numbers::pi / 2}
          : kEverywhere;
  const Imath::Box3d box = bounds(shape);
  const auto* sphere = std::get_if<Sphere>(&shape);
  const double radius = sphere != nullptr ? sphere->radius : box.size().length() / 2;
  const double nearest =
      std::sqrt(side.projected_area / std::numbers::pi);  // irradiance is at most pi times radiance
  const double intensity = emission * side.projected_area;
  return {box, radius, nearest, normals, intensity, intensity};
}

LightBounds bounds_at_infinity(const Imath::V3f& towards, double cap, double facing, double all_sides) {
  const Imath::V3d axis(towards);
  return {Imath::Box3d(axis), 0, 0, {axis, std::acos(1 - cap), 0}, facing, all_sides, true};
}

}  // namespace

Imath::Box3d bounds_of(const Light& light, const Scene& scene) {
  const Imath::V3f* at = light_position(light);
  const Motion* motion = motion_of(light, scene.shapes);
  if (at != nullptr && motion != nullptr) return motion->sweep({Imath::V3d(*at)}, 0, 1);
  if (at != nullptr) return Imath::Box3d(Imath::V3d(*at));
  return bounds(scene.shapes[std::get<AreaLight>(light.kind).shape].shape);
}

LightBounds light_bounds(const Light& light, const Scene& scene, double emission) {
  if (const auto* area = std::get_if<AreaLight>(&light.kind))
    return area_light_bounds(*area, scene, emission);
  if (const auto* sun = std::get_if<SunLight>(&light.kind)) {
    const double irradiance = emission * sun->projected_solid_angle();
    return bounds_at_infinity(sun->towards, static_cast<double>(sun->cap), irradiance, irradiance);
  }
  if (const auto* directional = std::get_if<DirectionalLight>(&light.kind))
    return bounds_at_infinity(directional->towards, 0, emission, emission);
  if (const auto* environment = std::get_if<EnvironmentLight>(&light.kind)) {
    LightBounds environment_bounds =
        bounds_at_infinity({0, 0, 1}, 2, emission * std::numbers::pi, emission * 4 * std::numbers::pi);
    environment_bounds.box = Imath::Box3d(Imath::V3d(0));
    environment_bounds.ambient = environment->image == nullptr;
    return environment_bounds;
  }
  EmissionCone cone = kEverywhere;
  if (const auto* spot = std::get_if<SpotLight>(&light.kind); spot != nullptr && !spot->motion)
    cone = {Imath::V3d(spot->axis), std::acos(1 - static_cast<double>(spot->cap)), 0};
  const Imath::Box3d box = bounds_of(light, scene);
  return {box, box.size().length() / 2, 0, cone, emission, emission};
}

LightBounds union_of(const LightBounds& a, const LightBounds& b) {
  Imath::Box3d box = a.box;
  box.extendBy(b.box);
  // At the center of lights spread uniformly through a ball, the mean of 1/d^2 is 3/r^2. A smaller bound, as
  // here, gives more weight to the nearer half of a node. The second moment of
  // tests/transport/light_sampler_test.cpp is 1.75 at r^2/2 and 1.46 at r^2/8; smaller values do not improve
  // it.
  constexpr double kNearest = 0.35;
  const double radius = box.size().length() / 2;
  return {box,
          radius,
          kNearest * radius,
          union_of(a.cone, b.cone),
          a.facing + b.facing,
          a.all_sides + b.all_sides,
          a.at_infinity};
}

}  // namespace abbe
