#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// A class of light paths that cannot be sampled, as text for messages: `EXPRESSION: description (lights)`.
/// The regular expression [Heckbert1990], such as "E S+ L", leads from the eye E to the light L over specular
/// (S) and other (D) vertices. Lights are quoted names, at most eight.
using PathClass = std::string;

/// Light paths of a committed scene that its integrator samples with probability zero, or for tiny lights
/// practically never. Empty if all are sampled. `light_tracing_active` is true if path tracing is
/// combined with photons from the lights of `features.light_is_traced`; other integrators ignore it.
[[nodiscard]] std::vector<PathClass> unsampled_paths(const Scene& scene, const SceneFeatures& features,
                                                     bool light_tracing_active);

/// Finds the first closed, opaque shape around the camera that is dark inside, so that the camera sees
/// nothing else. Returns its index in `Scene::shapes`; nothing if there is none. For a probe the shape must
/// enclose all `kRepresentativePoints`. A shape without open edges encloses a point if a ray from there and
/// the opposite ray both leave the shape more often than they enter. The test is in double precision. The
/// shape is dark if no light lies in it and it does not emit inward. Moving shapes and cameras are not
/// examined. A moving light counts as illuminating every shape.
[[nodiscard]] std::optional<std::uint32_t> dark_enclosure(const Scene& scene);

}  // namespace abbe
