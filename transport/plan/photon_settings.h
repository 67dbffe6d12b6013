#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// Whether the number of photons of a sample is for the scene to say, as it is nothing that camera paths rely
/// on.
[[nodiscard]] bool traces_photons_alone(std::span<const Technique> techniques);

/// The keys of `render/photons` that the scene sets to other values than those they have by themselves, and
/// that its integrator makes no use of, in the order of the list. Where Integrator::automatic may choose
/// Integrator::vcm, the radius is of use.
[[nodiscard]] std::vector<std::string_view> unused_photon_settings(const Scene& scene);

}  // namespace abbe
