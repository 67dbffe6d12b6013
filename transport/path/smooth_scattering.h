#pragma once

#include <optional>

#include "transport/path/ray_trace.h"

namespace abbe {

/// Ray that leaves a smooth surface.
struct OutgoingRay {
  TraceEvent::Kind kind;  ///< refract, reflect or total_reflection
  Imath::V3d direction;
  double angle_deg;  ///< Angle with the normal.
  /// Mueller matrix of the event, including the power of unpolarised light, with `SmoothScattering::axis` as
  /// axis.
  FullMueller mueller;
};

/// Outgoing rays at a surface, and their fractions.
struct SmoothScattering {
  std::optional<OutgoingRay> reflected, through;
  Imath::V3d axis = {};  ///< Perpendicular to the ray before and after.
  Passage passage = {};  ///< Complete except for the outgoing angle.
  bool ends = true;      ///< True if the remaining light, or all of it, is scattered.
};

/// Outgoing rays of a ray that arrives at `at` from the direction `wo`. `outside` is the index outside the
/// shape's own medium.
[[nodiscard]] SmoothScattering smooth_scattering_at(const Scene& scene, const ExactHit& at,
                                                    const Imath::V3d& wo, double wavelength_nm,
                                                    double outside);

}  // namespace abbe
