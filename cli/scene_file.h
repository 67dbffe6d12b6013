#pragma once

#include <string>

#include "scene/scene.h"
#include "transport/render/choose_integrator.h"

namespace abbe::cli {

/// Report of `abbe info` in plain text. `scene` must have the integrator of `choice`, the result of
/// `choose_integrator`. Traces pilot rays with one thread per processor.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

/// Prints a note on the error of the image if the scene turns polarisation off and has paths that it affects.
void note_polarisation(const Scene& scene);

}  // namespace abbe::cli
