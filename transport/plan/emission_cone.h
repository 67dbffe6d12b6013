#pragma once

#include <ImathVec.h>

namespace abbe {

/// The directions in which lamps emit: within the angle `spread` around the unit `axis` as strongly as
/// anywhere, beyond it falling off with the cosine of what is beyond, and nothing from `falloff` beyond. Both
/// in radians, in [0, pi].
struct EmissionCone {
  Imath::V3d axis{0, 0, 1};
  double spread = 0;
  double falloff = 0;
};

/// A cone that holds both, no wider than it must be. [Conty2018]
[[nodiscard]] EmissionCone union_of(const EmissionCone& a, const EmissionCone& b);

/// How much the choice of a light in a cone of directions leaves open [sr]: the solid angle of its spread,
/// and that of the fall-off around it weighed by its cosine. [Conty2018]
[[nodiscard]] double measure(const EmissionCone& cone);

}  // namespace abbe
