#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// True if the scene determines the number of photons per sample, because camera paths do not depend on it.
[[nodiscard]] bool scene_sets_photon_count(std::span<const Technique> techniques);

/// Keys of `render/photons` that the scene sets to other values than the defaults and that its integrator
/// does not use, in the order of the list. With Integrator::automatic the radius counts as used if
/// Integrator::vcm may be chosen.
[[nodiscard]] std::vector<std::string_view> unused_photon_settings(const Scene& scene);

}  // namespace abbe
