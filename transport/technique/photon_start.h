#pragma once

#include <cstdint>

#include "transport/path/path_state.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Start of a photon at its light.
struct PhotonStart {
  std::uint32_t light = 0;        ///< Index into `Scene::lights`.
  Imath::V3f from{0, 0, 0};       ///< Origin of its ray; for distant lights a point in front of the target.
  Imath::V3f direction{0, 0, 1};  ///< Unit direction of its ray.
  /// Branch of the photon's first contribution to the film: a hash of the specular events before the first
  /// other event, and of their shapes. `start_photon` leaves it 0; the training of photon guides sets it.
  std::uint32_t branch = 0;
};

/// Starts a photon at one of the plan's traced lights, with the random numbers of `photon.sampler`. Sets the
/// photon's ray, media and packet: wavelengths, throughput and polarisation. If the light emits nothing along
/// the ray, or a distant light is occluded there, only the throughput is set, to zero. `Plan::traced_lights`
/// must not be empty. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] PhotonStart start_photon(const Plan& plan, RayCaster& caster, PathState& photon);

}  // namespace abbe
