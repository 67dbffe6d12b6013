#pragma once

#include <vector>

#include "scene/camera/camera.h"
#include "sensor/response/incidence.h"

namespace abbe {

/// Angles of incidence on the film at a film position (or on a meter), where the camera sees uniform
/// radiance. They are those of `sample_ray` over the lens at 550 nm, weighted by irradiance, without ghosts.
/// For a cone of numerical aperture sin u that a lens without losses fills evenly, the density is that of
///     (1/sin^2 u) 2 sin(theta) cos(theta) dtheta.
/// Empty where no light arrives.
[[nodiscard]] std::vector<Incidence> incidence_angles(const Camera& camera, Imath::V2f film);

}  // namespace abbe
