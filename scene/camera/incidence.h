#pragma once

#include <vector>

#include "scene/camera/camera.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Distribution of the angles of incidence at a film position, or on a probe, under uniform radiance. `film`
/// is in pixels from the top left corner, in [0, width] x [0, height]. The result has at most 32 angles with
/// equal numbers of rays, by increasing angle, whose fractions of the irradiance add up to 1. The rays are
/// those of `sample_ray` over the lens at 550 nm, at time 0 and without ghosts. For a cone of numerical
/// aperture sin u that a lossless lens fills uniformly, the density is
///     (1/sin^2 u) 2 sin(theta) cos(theta) dtheta.
/// Empty if no light arrives.
[[nodiscard]] std::vector<Incidence> incidence_angles(const Camera& camera, Imath::V2f film);

}  // namespace abbe
