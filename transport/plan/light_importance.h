#pragma once

#include <ImathVec.h>

#include "scene/lights/light.h"
#include "transport/plan/light_bounds.h"

namespace abbe {

/// Bounds of lights, prepared for evaluation at path vertices.
class LightImportance {
 public:
  /// Multiplies the strengths of `bounds` by `scale`. `min_distance` [m] > 0 is a lower bound for `nearest`,
  /// so that the irradiance at the position of a light is finite.
  LightImportance(const LightBounds& bounds, double scale, double min_distance);

  /// Irradiance bound for a vertex: the unoccluded irradiance from the most favourable direction and
  /// orientation within the lights' sphere, at the distance of its center. [Conty2018] Its unit is that of
  /// the scaled strengths, per m^2 for nearby lights. Not negative; 0 if no emission can arrive, and for
  /// ambient light at glossy vertices.
  [[nodiscard]] float irradiance(const LightSampleContext& context) const;

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
