#pragma once

#include <cstdint>

#include "transport/path/path_state.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Start of a photon at its light.
struct PhotonStart {
  std::uint32_t light = 0;
  Imath::V3f from{0, 0, 0};       ///< Origin of its ray.
  Imath::V3f direction{0, 0, 1};  ///< Unit direction of its ray.
  /// `LightPath::branch` at its first contribution to the film; 0 if it made none.
  std::uint32_t branch = 0;
};

/// Starts a photon at one of the plan's traced lights, with its own random numbers: sets its ray, power and
/// media. The throughput is zero if the light emits nothing there or is occluded.
[[nodiscard]] PhotonStart start_photon(const Plan& plan, RayCaster& caster, PathState& photon);

}  // namespace abbe
