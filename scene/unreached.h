#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// One class of paths that no active technique reaches: a regular expression from the eye E to the light L
/// over specular (S) and diffuse (D) vertices, and what it is in words [Heckbert1990].
using PathClass = std::string;

/// Those of a scene by its integrator. `light_tracing_active`: whether photons are traced from the lights of
/// `needs.light_is_traced`. With Integrator::light nothing else is.
[[nodiscard]] std::vector<PathClass> unreached(const Scene& scene, const Needs& needs,
                                               bool light_tracing_active);

}  // namespace abbe
