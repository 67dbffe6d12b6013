#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "description/load.h"
#include "io/inputs.h"
#include "transport/path/ray_trace.h"

namespace abbe::cli {

/// What `abbe draw` was asked for, in the units of length of the scene file.
struct DrawOptions {
  std::filesystem::path scene;  ///< "-" is standard input.
  std::filesystem::path output;
  std::vector<double> wavelengths_nm{450, 550, 650};
  std::optional<Imath::V3d> origin;  ///< Of one ray, in place of the lamps'.
  Imath::V3d direction{0, 0, 0};
  int rays = 9;  ///< Of each lamp and wavelength in each of two planes; 0 for none.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Draws plan and elevation of a scene. Returns the exit code.
int draw(const DrawOptions& options);

}  // namespace abbe::cli
