#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "scene/scene.h"
#include "transport/render/choose_integrator.h"

namespace abbe::cli {

/// What `abbe info` was asked for.
struct InfoOptions {
  std::filesystem::path scene;  ///< "-" is standard input.
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Prints what a scene contains, needs and skips. Returns the exit code.
int info(const InfoOptions& options);

/// What `abbe info` tells of a scene whose integrator is what was chosen, in lines for reading.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

}  // namespace abbe::cli
