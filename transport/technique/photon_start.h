#pragma once

#include <cstdint>

#include "transport/path/ray_caster.h"
#include "transport/path/walk.h"
#include "transport/plan/plan.h"

namespace abbe {

/// How a photon left its light.
struct PhotonStart {
  std::uint32_t light = 0;
  Imath::V3f from{0, 0, 0};       ///< Where its ray began,
  Imath::V3f direction{0, 0, 1};  ///< and the unit vector along it.
  std::uint32_t branch = 0;       ///< `LightPath::branch` where it first added to the film; 0 if it did not.
};

/// Sets a photon out from one of the plan's traced lights, by its own numbers: on its ray, with the power
/// that it carries, in what surrounds it. Where it gets nowhere its throughput is zero.
[[nodiscard]] PhotonStart start_photon(const Plan& plan, RayCaster& caster, Walk& photon);

}  // namespace abbe
