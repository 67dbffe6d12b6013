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

/// Options of `abbe trace`; lengths are in the units of the scene file.
struct TraceOptions {
  std::filesystem::path scene;       ///< Scene file; "-" is standard input.
  double wavelength_nm = 0;          ///< Wavelength of the ray in standard air.
  std::optional<Imath::V3d> origin;  ///< Origin of the ray; required without a light.
  /// Direction of the ray, of any length > 0. Required without a light; by default that of the light's
  /// central ray.
  std::optional<Imath::V3d> direction;
  /// Maximum number of events along each chain from the start of the ray. A branch inherits the count of its
  /// parent, so this does not limit the sum over all branches.
  int max_events = 64;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;       ///< Print the answer as JSON instead of plain text.
  std::string light = {};  ///< Light at which the ray starts, instead of an origin.
  /// Stokes vector of the emitted light with I = 1, in the frame of `first_axis` in the answer.
  StokesVector stokes{1, 0, 0, 0};
  Follow follow = Follow::refraction;  ///< Ray to follow at surfaces that both reflect and transmit.
  std::vector<Override> overrides = {};
};

/// Traces one ray through a scene and prints its events. Returns 0. Throws Error{usage} without a start of
/// the ray, for a zero direction, and for a light that is unknown or has no central ray. Throws InvalidInput
/// for an invalid scene.
int trace(const TraceOptions& options);

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

/// Warning for a material whose index or extinction is extrapolated at a wavelength [nm]; empty if neither
/// is.
[[nodiscard]] std::optional<std::string> extrapolated_index_warning(const Material& material,
                                                                    double wavelength_nm);

}  // namespace abbe::cli
