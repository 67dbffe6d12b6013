#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/integrators.h"
#include "scene/lost_light.h"
#include "scene/scene.h"

namespace abbe {

/// A technique from which a plan chooses: an integrator that is not `automatic`. Each estimates the classes
/// of paths that it owns; no path has two owners. Only `path` and `light` are combined.
using Technique = Integrator;

/// Techniques of the scene's integrator, in the order of the enumeration; at least one.
[[nodiscard]] std::vector<Technique> chosen_techniques(const Scene& scene);

/// Classes of light paths of a scene that none of its `chosen_techniques` can sample.
[[nodiscard]] std::vector<PathClass> unsampled_paths(const Scene& scene);

/// True if one of the techniques traces such paths.
[[nodiscard]] bool traces(std::span<const Technique> techniques, TracedPaths paths);

/// True if a technique traces camera paths.
[[nodiscard]] bool starts_at_camera(Technique technique);

/// True if one of the techniques starts paths at lights.
[[nodiscard]] bool starts_at_lights(std::span<const Technique> techniques);

/// True if a technique gathers photons that the light paths of a sample store first.
[[nodiscard]] bool gathers_photons(Technique technique);

/// Reason why a technique's estimate is biased; "" if it is unbiased.
[[nodiscard]] std::string_view bias_of(Technique technique);

/// Classes of camera paths that a technique owns if a plan combines the techniques `active`, of which it is
/// one, in the notation of `IntegratorTraits`.
[[nodiscard]] std::string owned_paths(Technique technique, std::span<const Technique> active,
                                      const Camera& camera);

/// True if the scene file may set the number of photons per sample, because a technique traces them
/// separately from the camera paths: brute-force photons and all that gather photons.
[[nodiscard]] bool scene_sets_photon_count(std::span<const Technique> techniques);

/// Keys of `render/photons` in the scene file, such as "radius", that the scene's integrator does not use
/// although the scene sets them to other values than the defaults. With Integrator::automatic the radius
/// counts as used if an integrator that merges paths may be chosen.
[[nodiscard]] std::vector<std::string_view> unused_photon_settings(const Scene& scene);

}  // namespace abbe
