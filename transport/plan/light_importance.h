#pragma once

#include <ImathVec.h>

#include "transport/plan/light_bounds.h"

namespace abbe {

/// The bounds of lights, made ready to be evaluated at each vertex of a path.
class LightImportance {
 public:
  /// Takes the strengths of `bounds` times `scale` [1/unit of them], and `nearest` no less than
  /// `least_distance` [m] > 0, which keeps the irradiance finite at the place of a lamp.
  LightImportance(const LightBounds& bounds, double scale, double least_distance);

  /// Irradiance of a surface at `point` whose side of the unit `normal` alone can be lit, or, without a
  /// normal, of what takes light from all sides: what the lamps could send there from the most favourable
  /// place in their sphere, with nothing in between, but for their distance, which is that of the middle. Not
  /// negative; 0 where they cannot shine. [Conty2018]
  [[nodiscard]] float irradiance(const Imath::V3f& point, const Imath::V3f* normal) const;

 private:
  Imath::V3f center_;
  float radius2_;
  float nearest2_;
  Imath::V3f axis_;
  float cos_spread_;
  float cos_falloff_;
  float facing_;
  float all_sides_;
  bool at_infinity_;
};

}  // namespace abbe
