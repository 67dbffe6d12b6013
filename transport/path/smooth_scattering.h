#pragma once

#include <optional>

#include "transport/path/ray_trace.h"

namespace abbe {

/// Ray that leaves a smooth surface.
struct OutgoingRay {
  TraceEvent::Kind kind;  ///< refract, reflect or total_reflection
  Imath::V3d direction;   ///< Unit vector.
  double angle_deg;       ///< Angle with the normal on the side of the ray, in [0, 90].
  /// Mueller matrix of the event, including the power of unpolarised light, with `SmoothScattering::axis` as
  /// axis.
  FullMueller mueller;
};

/// Light that a surface sends in single directions. `OutgoingRay::mueller` has the fractions of its power.
struct SmoothScattering {
  /// Specular reflection, and refraction or straight transmission; empty if it carries no power.
  std::optional<OutgoingRay> reflected, through;
  Imath::V3d axis = {};  ///< First axis of the event's frames, perpendicular to the ray before and after.
  Passage passage = {};  ///< Complete except for `angle_out_deg`, which depends on the ray that is followed.
  /// True if the surface also scatters light into other directions, or if no outgoing ray is known.
  bool ends = true;
};

/// Outgoing rays of a ray that arrives at `at`; the unit vector `wo` points back to where it came from.
/// `outside` is the index of the medium outside the shape, relative to air. No rays leave a surface without a
/// specular lobe, or a mesh whose material needs surface coordinates, because a hit does not have them.
[[nodiscard]] SmoothScattering smooth_scattering_at(const Scene& scene, const ExactHit& at,
                                                    const Imath::V3d& wo, double wavelength_nm,
                                                    double outside);

}  // namespace abbe
