#pragma once

#include "transport/path/walk.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Puts a path that sets out from the camera, along its ray, into the matter that is there at its time.
void enter_camera_matter(const Plan& plan, Walk& path);
/// The matter in which a point of the lens is at that time.
[[nodiscard]] MediumStack camera_matter(const Plan& plan, const Imath::V3f& lens_point, float time);
/// Puts a path that sets out from a light of the plan's, along its ray, into the matter that is there at its
/// time.
void enter_light_matter(const Plan& plan, std::uint32_t light, Walk& path);

}  // namespace abbe
