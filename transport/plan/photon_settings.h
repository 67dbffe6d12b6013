#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "transport/plan/techniques.h"

namespace abbe {

/// True if the scene file may set the number of photons per sample, because a technique traces them
/// separately from the camera paths: brute-force photons and all that gather photons.
[[nodiscard]] bool scene_sets_photon_count(std::span<const Technique> techniques);

/// Keys of `render/photons` in the scene file, such as "radius", that the scene's integrator does not use
/// although the scene sets them to other values than the defaults. With Integrator::automatic the radius
/// counts as used if an integrator that merges paths may be chosen.
[[nodiscard]] std::vector<std::string_view> unused_photon_settings(const Scene& scene);

}  // namespace abbe
