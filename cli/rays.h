#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <ImathVec.h>

#include "description/load.h"
#include "io/inputs.h"
#include "scene/scene.h"
#include "transport/path/ray_trace.h"

namespace abbe::cli {

/// Options of `abbe trace`; lengths are in the units of the scene file. The help of the command explains
/// them.
struct TraceOptions {
  std::filesystem::path scene;
  double wavelength_nm = 0;
  std::optional<Imath::V3d> origin;  ///< Required without a light.
  /// Direction of any length > 0. Required without a light; by default that of the light's central ray.
  std::optional<Imath::V3d> direction;
  /// Maximum number of events along each chain from the start of the ray. A branch inherits the count of its
  /// parent, so this does not limit the sum over all branches.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
  std::string light = {};
  StokesVector stokes{1, 0, 0, 0};  ///< I = 1, in the frame of `first_axis` in the answer.
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Traces one ray through a scene and prints its events. Throws Error{usage} without a start of
/// the ray, for a zero direction, and for a light that is unknown or has no central ray. Throws InvalidInput
/// for an invalid scene.
void trace(const TraceOptions& options);

/// Options of `abbe draw`; lengths are in the units of the scene file. The help of the command explains them.
struct DrawOptions {
  std::filesystem::path scene;
  std::filesystem::path output;
  std::vector<double> wavelengths_nm{450, 550, 650};
  std::optional<Imath::V3d> origin;
  Imath::V3d direction{0, 0, 0};
  int rays = 9;
  int max_events = 64;  ///< As in `TraceOptions`.
  std::size_t max_memory_bytes = default_memory_limit();
  Follow follow = Follow::refraction;
  std::vector<Override> overrides = {};
};

/// Draws the plan and elevation of a scene with rays through it, as SVG. Throws Error{usage} for
/// another extension than .svg and for a zero direction, InvalidInput for an invalid scene, Error{output} if
/// the drawing cannot be written.
void draw(const DrawOptions& options);

/// Warning for a material whose index or extinction is extrapolated at a wavelength [nm]; empty if neither
/// is.
[[nodiscard]] std::optional<std::string> extrapolated_index_warning(const Material& material,
                                                                    double wavelength_nm);

}  // namespace abbe::cli
