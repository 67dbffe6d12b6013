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

/// Prints what a scene contains, which features it needs and which it skips. Returns the exit code.
int info(const InfoOptions& options);

/// Report of `abbe info` in plain text, for a scene whose integrator has been chosen.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

}  // namespace abbe::cli
