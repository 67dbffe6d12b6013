#pragma once

#include "scene/camera/camera.h"

namespace abbe {

/// Radius of a thin lens's opening, seen from the plane in focus: over the distance to that. Between blades
/// it is that of the disc whose points have the same mean square, and the same mean weight to within 4e-5 at
/// f/1 and life size for five blades and more, 2e-4 for four and 1.4e-3 for three. 0 of all other cameras,
/// and for focus at infinity: the rays that a film position has there all have one direction.
[[nodiscard]] double opening_tangent(const Camera& camera);

/// The weight [sr] that the rays of a film position have in the mean over an opening of that tangent, the
/// central one having `central_weight`: the irradiance there by a radiance of 1 that is even all over what
/// they see.
[[nodiscard]] double mean_weight(const Camera& camera, double opening_tangent, Imath::V2f film);

}  // namespace abbe
