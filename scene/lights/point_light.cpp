#include "scene/lights/point_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/shapes/ray.h"

namespace abbe {

Imath::V3f moved_position(const Imath::V3f& position, const Motion* motion, float time) {
  if (motion == nullptr) return position;
  return Imath::V3f(Imath::V3d(position) * motion->since_opening(static_cast<double>(time)));
}

Imath::V3f moved_direction(const Imath::V3f& direction, const Motion* motion, float time) {
  if (motion == nullptr) return direction;
  return Imath::V3f(moved_direction(Imath::V3d(direction), motion->since_opening(static_cast<double>(time))));
}

// Inverse-square falloff, computed in double because the light may be very close.
std::optional<LightSample> sample_towards_point(const Imath::V3f& position, const Imath::V3f& point) {
  const Imath::V3d d = Imath::V3d(position) - Imath::V3d(point);
  const double distance2 = d.length2();
  if (!(distance2 > 0)) return std::nullopt;
  return LightSample{Imath::V3f(d.normalized()), static_cast<float>(std::sqrt(distance2)),
                     static_cast<float>(1 / distance2), 1, position};
}

Imath::Box3d box_of_point(const Imath::V3f& position, const Motion* motion) {
  if (motion != nullptr) return motion->sweep({Imath::V3d(position)}, 0, 1);
  return Imath::Box3d(Imath::V3d(position));
}

LightBounds bounds_of_point(const Imath::V3f& position, const Motion* motion, const EmissionCone& cone,
                            double intensity) {
  const Imath::Box3d box = box_of_point(position, motion);
  return {box, box.size().length() / 2, 0, cone, intensity, intensity};
}

std::optional<LightSample> PointLight::sample(const LightQuery& query) const {
  return sample_towards_point(moved_position(position, motion.get(), query.time), query.context.point);
}

Imath::V3f PointLight::emission_direction(const Imath::V3f& /*normal*/, Imath::V2f u, float /*time*/) const {
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  return direction_about({0, 0, 1}, 2 * u.x, phi);
}

EmissionDensity PointLight::emission_density(const EmissionQuery& /*query*/) const {
  return {1, 1 / (4 * std::numbers::pi_v<float>)};
}

std::optional<BasicRay<double>> PointLight::central_ray(const Ball& sphere) const {
  const Imath::V3d towards = sphere.center - position;
  return BasicRay<double>{position, towards.length() > 0 ? towards.normalized() : Imath::V3d(1, 0, 0)};
}

std::optional<LightSample> SpotLight::sample(const LightQuery& query) const {
  std::optional<LightSample> sample =
      sample_towards_point(moved_position(position, motion.get(), query.time), query.context.point);
  if (!sample || !illuminates(-sample->wi, query.time)) return std::nullopt;
  return sample;
}

Imath::V3f SpotLight::emission_direction(const Imath::V3f& /*normal*/, Imath::V2f u, float time) const {
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  return direction_about(axis_at(time), u.x * cap, phi);
}

EmissionDensity SpotLight::emission_density(const EmissionQuery& query) const {
  return {1, illuminates(query.wo, query.time) ? cone_pdf(cap) : 0.0F};
}

LightBounds SpotLight::bounds(const Shapes& /*shapes*/, double emission) const {
  EmissionCone cone = kEverywhere;
  if (!motion) cone = {Imath::V3d(axis), std::acos(1 - static_cast<double>(cap)), 0};
  return bounds_of_point(position, motion.get(), cone, emission);
}

double SpotLight::fan() const {
  return 2 * std::asin(std::sqrt(std::min(1.0, static_cast<double>(cap) / 2)));
}

}  // namespace abbe
