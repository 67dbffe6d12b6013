#pragma once

#include "scene/scene.h"

namespace abbe::cli {

/// Warns on stderr of the classes of paths that the scene's integrator does not reach, whose light the image
/// will lack. Throws Error{scene} instead, when `strict`.
void warn_of_lost_light(const Scene& scene, bool strict);

/// Warns of a camera that stands within opaque matter where no light is: Error{scene} when `strict`.
void warn_of_dark_camera(const Scene& scene, bool strict);

/// Says in a line, when the scene has paths where it costs something, that polarisation is left out.
void note_polarisation(const Needs& needs);

}  // namespace abbe::cli
