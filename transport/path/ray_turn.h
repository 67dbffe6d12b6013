#pragma once

#include <optional>

#include "transport/path/ray_trace.h"

namespace abbe {

/// A way on from a surface.
struct RayWay {
  TraceEvent::Kind kind;  ///< refract, reflect or total_reflection
  Imath::V3d direction;
  double angle_deg;  ///< To the normal.
  /// What going this way does to polarisation, about the axis of the `Turn`, and to the power of unpolarised
  /// light.
  FullMueller mueller;
};

/// What a surface does to a ray: the ways on, and what takes them.
struct Turn {
  std::optional<RayWay> reflected, through;
  Imath::V3d axis = {};  ///< Across the ray before and after.
  Passage passage = {};  ///< But for the angle out.
  bool ends = true;      ///< Light that takes neither is scattered, or all of it is.
};

/// Of a ray that arrives at `at` on a shape from `wo`; `outside` is the index of what the shape's matter is
/// in.
[[nodiscard]] Turn turn_at(const Scene& scene, const ExactHit& at, const Imath::V3d& wo, double wavelength_nm,
                           double outside);

}  // namespace abbe
