#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "scene/scene.h"
#include "transport/render/choose_integrator.h"

namespace abbe::cli {

/// Options of `abbe info`.
struct InfoOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Prints what a scene contains, which features it needs and which it skips. Traces pilot rays to choose the
/// integrator. Returns 0. Throws InvalidInput for an invalid scene; a scene that cannot be rendered only
/// causes a warning.
int info(const InfoOptions& options);

/// Report of `abbe info` in plain text. `scene` must have the integrator of `choice`, the result of
/// `choose_integrator`. Traces pilot rays with one thread per processor.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

}  // namespace abbe::cli
