#pragma once

#include <ImathVec.h>

#include "scene/lights/light.h"
#include "transport/plan/light_bounds.h"

namespace abbe {

/// The bounds of lights, made ready to be evaluated at each vertex of a path.
class LightImportance {
 public:
  /// Takes the strengths of `bounds` times `scale` [1/unit of them], and `nearest` no less than
  /// `least_distance` [m] > 0, which keeps the irradiance finite at the place of a lamp.
  LightImportance(const LightBounds& bounds, double scale, double least_distance);

  /// Irradiance of a place: what the lamps could send there from the most favourable place in their sphere,
  /// with nothing in between, but for their distance, which is that of the middle. Not negative; 0 where they
  /// cannot shine. [Conty2018] Nothing of ambient light to a glossy place.
  [[nodiscard]] float irradiance(const LightSampleContext& place) const;

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
  bool ambient_;
};

}  // namespace abbe
