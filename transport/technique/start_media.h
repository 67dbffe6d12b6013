#pragma once

#include "transport/path/path_state.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Sets the media of a path at the start of its ray from the camera, at the ray's time. Ray and wavelengths
/// must be set. Throws as `enclosing_media`.
void enter_camera_media(const Plan& plan, PathState& path);
/// Medium stack of a point of the lens at a time, a fraction of the exposure. Throws as `enclosing_media`.
[[nodiscard]] MediumStack camera_media(const Plan& plan, const Imath::V3f& lens_point, float time);
/// Sets the media of a path at the start of its ray from the traced light of index `light`, at the ray's
/// time. Ray and wavelengths must be set. Throws as `enclosing_media`.
void enter_light_media(const Plan& plan, std::uint32_t light, PathState& path);

}  // namespace abbe
