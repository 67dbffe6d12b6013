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

/// Options of `abbe trace`; lengths are in the units of the scene file.
struct TraceOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  double wavelength_nm = 0;
  std::optional<Imath::V3d> origin;  ///< Required without a light.
  /// Required without a light; by default the direction of the light's central ray.
  std::optional<Imath::V3d> direction;
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
  std::string light = {};           ///< Light at which the ray starts, instead of an origin.
  StokesVector stokes{1, 0, 0, 0};  ///< Stokes vector of the emitted light, with I = 1.
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Traces one ray through a scene and prints its events. Returns the exit code.
int trace(const TraceOptions& options);

}  // namespace abbe::cli
