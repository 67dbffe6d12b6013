#pragma once

#include <ImathVec.h>

namespace abbe {

/// Bound on the directions of lights' emission: full emission within the angle `spread` around the unit
/// `axis`, a cosine falloff of the excess angle outside, and none above the excess `falloff`. Both angles are
/// in radians, in [0, pi].
struct EmissionCone {
  Imath::V3d axis{0, 0, 1};
  double spread = 0;
  double falloff = 0;
};

/// Cone that contains both, with the larger of their falloffs. [Conty2018]
[[nodiscard]] EmissionCone union_of(const EmissionCone& a, const EmissionCone& b);

/// Measure of a cone [sr]: the solid angle of its spread, plus that of the falloff weighted by its cosine.
/// [Conty2018]
[[nodiscard]] double measure(const EmissionCone& cone);

}  // namespace abbe
