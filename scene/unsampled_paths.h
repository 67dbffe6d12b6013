#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// A class of light paths that cannot be sampled: a regular expression [Heckbert1990], a description and the
/// lights concerned. The expression goes from the eye E to the light L over specular (S) and diffuse (D)
/// vertices.
using PathClass = std::string;

/// Light paths of a scene that its integrator cannot sample. `light_tracing_active` is true if photons are
/// traced from the lights of `features.light_is_traced`. Integrator::light samples by photons alone.
[[nodiscard]] std::vector<PathClass> unsampled_paths(const Scene& scene, const SceneFeatures& features,
                                                     bool light_tracing_active);

}  // namespace abbe
