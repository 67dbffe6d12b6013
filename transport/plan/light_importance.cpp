#include "transport/plan/light_importance.h"

#include <algorithm>
#include <cmath>

namespace abbe {
namespace {

// cos(max(0, a - b)) of two angles in [0, pi], given their cosines.
float cos_excess(float cos_a, float cos_b) {
  if (cos_a >= cos_b) return 1;
  return cos_a * cos_b + std::sqrt(std::max(0.0F, (1 - cos_a * cos_a) * (1 - cos_b * cos_b)));
}

}  // namespace

LightImportance::LightImportance(const LightBounds& bounds, double scale, double min_distance)
    : center_(bounds.box.center()),
      radius2_(static_cast<float>(bounds.radius * bounds.radius)),
      nearest2_(static_cast<float>(std::pow(std::max(bounds.nearest, min_distance), 2))),
      axis_(bounds.cone.axis),
      cos_spread_(static_cast<float>(std::cos(bounds.cone.spread))),
      cos_falloff_(static_cast<float>(std::cos(bounds.cone.falloff))),
      facing_(static_cast<float>(bounds.facing * scale)),
      all_sides_(static_cast<float>(bounds.all_sides * scale)),
      at_infinity_(bounds.at_infinity),
      ambient_(bounds.ambient) {}

// I max(0, cos e) max(0, cos r) / max(d^2, nearest^2) with the strength I and the distance d of the sphere's
// center. The angle e is that with the emission's axis, less its spread and the sphere's half angle. The
// angle r is that with the receiver's normal, less the half angle.
float LightImportance::irradiance(const LightSampleContext& context) const {
  if (ambient_ && context.glossy) return 0;
  const float strength = context.side ? facing_ : all_sides_;
  if (at_infinity_)
    return context.side ? strength * std::max(0.0F, cos_excess(context.side->dot(axis_), cos_spread_))
                        : strength;
  const Imath::V3f to_center = center_ - context.point;
  const float distance2 = to_center.length2();
  const float nearness = strength / std::max(distance2, nearest2_);
  if (!(distance2 > radius2_)) return nearness;
  const Imath::V3f towards = to_center * (1 / std::sqrt(distance2));
  const float cos_half_angle = std::sqrt(1 - radius2_ / distance2);  // half angle of the sphere
  const float emitted = cos_excess(cos_excess(-axis_.dot(towards), cos_spread_), cos_half_angle);
  if (emitted < cos_falloff_) return 0;
  const float received = context.side ? cos_excess(context.side->dot(towards), cos_half_angle) : 1;
  return nearness * std::max(0.0F, emitted) * std::max(0.0F, received);
}

}  // namespace abbe
