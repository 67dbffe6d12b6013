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
  std::filesystem::path scene;                        ///< Scene file; "-" is standard input.
  std::filesystem::path output;                       ///< SVG file to write.
  std::vector<double> wavelengths_nm{450, 550, 650};  ///< Wavelengths of the rays in standard air.
  /// Origin of a single ray per wavelength, which replaces the rays of the lights.
  std::optional<Imath::V3d> origin;
  Imath::V3d direction{0, 0, 0};  ///< Direction of that ray, of any length > 0.
  int rays = 9;  ///< Rays per light and wavelength in each of two perpendicular planes; 0 for none.
  /// Maximum number of events of a ray, counted from its start. A branch continues the count.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  Follow follow = Follow::refraction;  ///< Ray to follow at surfaces that both reflect and transmit.
  std::vector<Override> overrides = {};
};

/// Draws the plan and elevation of a scene with rays through it, as SVG. Returns 0. Throws Error{usage} for
/// another extension than .svg and for a zero direction, InvalidInput for an invalid scene, Error{output} if
/// the drawing cannot be written.
int draw(const DrawOptions& options);

}  // namespace abbe::cli
