#include "transport/plan/emission_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace abbe {
namespace {

// Unit vector at the angle `turn` from `axis`, rotated towards `towards`.
Imath::V3d turned(const Imath::V3d& axis, const Imath::V3d& towards, double turn) {
  const Imath::V3d across = towards - axis * axis.dot(towards);
  return (axis * std::cos(turn) + across.normalized() * std::sin(turn)).normalized();
}

}  // namespace

EmissionCone union_of(const EmissionCone& a, const EmissionCone& b) {
  const EmissionCone& wide = a.spread >= b.spread ? a : b;
  const EmissionCone& narrow = a.spread >= b.spread ? b : a;
  const double falloff = std::max(a.falloff, b.falloff);
  if (wide.axis == narrow.axis || wide.spread >= std::numbers::pi) return {wide.axis, wide.spread, falloff};
  const double between = std::acos(std::clamp(wide.axis.dot(narrow.axis), -1.0, 1.0));
  if (between + narrow.spread <= wide.spread) return {wide.axis, wide.spread, falloff};
  const double spread = (wide.spread + between + narrow.spread) / 2;
  if (spread >= std::numbers::pi) return {wide.axis, std::numbers::pi, falloff};
  return {turned(wide.axis, narrow.axis, spread - wide.spread), spread, falloff};
}

double measure(const EmissionCone& cone) {
  const double rim = std::min(cone.spread + cone.falloff, std::numbers::pi);
  const double cosine = std::cos(cone.spread);
  const double sine = std::sin(cone.spread);
  // 2 pi times the integrals of sin t up to the spread, and of cos(t - spread) sin t from there to the rim.
  return 2 * std::numbers::pi * (1 - cosine) +
         std::numbers::pi / 2 * (2 * (rim - cone.spread) * sine + cosine - std::cos(cone.spread - 2 * rim));
}

}  // namespace abbe
