#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "description/load.h"
#include "io/inputs.h"
#include "transport/path/ray_trace.h"

namespace abbe::cli {

/// Options of `abbe draw`; lengths are in the units of the scene file.
struct DrawOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  std::filesystem::path output;
  std::vector<double> wavelengths_nm{450, 550, 650};
  std::optional<Imath::V3d> origin;  ///< Origin of a single ray, which replaces the rays of the lights.
  Imath::V3d direction{0, 0, 0};
  int rays = 9;  ///< Rays per light and wavelength in each of two planes; 0 for none.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Draws the plan and elevation of a scene. Returns the exit code.
int draw(const DrawOptions& options);

}  // namespace abbe::cli
