#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <ImathVec.h>

#include "description/load.h"
#include "io/inputs.h"
#include "transport/path/ray_trace.h"

namespace abbe::cli {

/// What `abbe trace` was asked for, in the units of length of the scene file.
struct TraceOptions {
  std::filesystem::path scene;  ///< "-" is standard input.
  double wavelength_nm = 0;
  std::optional<Imath::V3d> origin;     ///< Needed without a light.
  std::optional<Imath::V3d> direction;  ///< Needed without a light, whose middle ray it is otherwise.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
  std::string light = {};           ///< Where the ray starts, in place of an origin.
  StokesVector stokes{1, 0, 0, 0};  ///< Of the light that sets out, with I = 1.
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Follows one ray through a scene and prints what happens to it. Returns the exit code.
int trace(const TraceOptions& options);

}  // namespace abbe::cli
