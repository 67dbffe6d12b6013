#pragma once

#include "scene/camera/camera.h"

namespace abbe {

/// Effective radius of a thin lens's opening divided by the focus distance. For an opening with blades it is
/// the radius of the disc with the same mean square. At f/1 and life size, that disc gives the same mean
/// weight to within 4e-5 for five or more blades, 2e-4 for four and 1.4e-3 for three. 0 for all other cameras
/// and for focus at infinity, where all rays of a film position have one direction.
[[nodiscard]] double opening_tangent(const Camera& camera);

/// Mean weight [sr] of the rays of a film position [pixels], at 550 nm and time 0. It is the irradiance at
/// the position under uniform unit radiance. `opening_tangent` is the result of that function for `camera`;
/// if it is 0, the result is `central_weight`.
[[nodiscard]] double mean_weight(const Camera& camera, double opening_tangent, Imath::V2f film);

}  // namespace abbe
