#include "scene/lights/emission.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/error.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1F;

// Arguments of `emission_density`.
struct EmissionQuery {
  const Imath::V3f& normal;
  const Imath::V3f& wo;
  float scene_radius_m;
  float time;
};

EmissionDensity density_of(const AreaLight& light, const EmissionQuery& at) {
  const float cos_theta = at.normal.dot(at.wo);
  const float pdf = light.two_sided ? std::abs(cos_theta) / (2 * std::numbers::pi_v<float>)
                                    : std::max(0.0F, cos_theta) / std::numbers::pi_v<float>;
  return {static_cast<float>(1 / light.area), pdf};
}

EmissionDensity density_of(const PointLight& /*light*/, const EmissionQuery& /*at*/) {
  return {1, 1 / (4 * std::numbers::pi_v<float>)};
}

EmissionDensity density_of(const SpotLight& light, const EmissionQuery& at) {
  return {1, light.illuminates(at.wo, at.time) ? cone_pdf(light.cap) : 0.0F};
}

// Density on the disc of the scene's radius that is perpendicular to the direction.
float disc_pdf(const EmissionQuery& at) {
  return 1 / (std::numbers::pi_v<float> * at.scene_radius_m * at.scene_radius_m);
}

EmissionDensity density_of(const EnvironmentLight& light, const EmissionQuery& at) {
  return {disc_pdf(at), light.pdf({}, -at.wo)};
}

EmissionDensity density_of(const DirectionalLight& /*light*/, const EmissionQuery& at) {
  return {disc_pdf(at), 1};
}

EmissionDensity density_of(const SunLight& light, const EmissionQuery& at) {
  return {disc_pdf(at), light.contains(-at.wo) ? cone_pdf(light.cap) : 0.0F};
}

}  // namespace

EmissionDensity emission_density(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo,
                                 float scene_radius_m, float time) {
  return std::visit(
      [&](const auto& kind) {
        return density_of(kind, {normal, wo, scene_radius_m, time});
      },
      light.kind);
}

Imath::V3f emission_direction(const Light& light, const Imath::V3f& normal, Imath::V2f u, float time) {
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  if (const auto* area = std::get_if<AreaLight>(&light.kind)) {
    const bool flip = area->two_sided && u.x >= 0.5F;
    const float v = area->two_sided ? std::min(2 * (u.x - (flip ? 0.5F : 0.0F)), kBelowOne) : u.x;
    return direction_about(flip ? -normal : normal, 1 - std::sqrt(1 - v), phi);
  }
  if (const auto* spot = std::get_if<SpotLight>(&light.kind))
    return direction_about(spot->axis_at(time), u.x * spot->cap, phi);
  if (light.is<PointLight>()) return direction_about({0, 0, 1}, 2 * u.x, phi);
  throw Error(ErrorCode::internal, "light \"" + light.name + "\"", "a light at infinity has no position");
}

}  // namespace abbe
