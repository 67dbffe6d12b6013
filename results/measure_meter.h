#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "scene/camera/meter.h"
#include "transport/render/render.h"

namespace abbe {

/// Values of a meter in the units of its quantity (`units_of`).
struct LightReading {
  Film::Average radiant;
  Film::Average luminous;
  Film::Average photons;
};

/// A meter's reading, averaged over the open shutter if something moves.
struct MeterReading {
  LightReading whole;  ///< Reading of the whole meter.
  /// Reading of each cell, row by row, with cells along `edge_u` running fastest; empty for a single cell.
  /// Flux and intensity are those of the cell's own area.
  std::vector<LightReading> cells;
  /// Radiant value of the whole meter per nm, for each bin; empty without bins.
  std::vector<Film::Average> spectrum;
};

/// Confidence level of the reported intervals.
inline constexpr double kMeterConfidence = 0.95;

/// Units of the values of a `LightReading`.
struct MeterUnits {
  const char* radiant;
  const char* luminous;
  const char* photons;
};
[[nodiscard]] const MeterUnits& units_of(MeterQuantity quantity);

/// Reads the meter from the film of its scene (`camera_of`, `channels_of`), exposed for `exposure_s` [s],
/// above 0. Values are per second and per m^2 or sr, not exposures.
[[nodiscard]] MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s);

struct MeterMeasurement {
  Meter meter;
  Integrator integrator;  ///< The integrator that rendered, also if the scene leaves the choice to Abbe.
  std::uint64_t seed;
  MeterReading reading;
  RenderStats stats;
};

/// Functions and settings of a caller of `measure_meter`.
struct MeterCallbacks {
  /// Renders the scene, with the caller's progress report and interruption.
  std::function<RenderResult(const Scene& scene, const RenderOptions& options)> render;
  /// Reports a warning about a reading.
  std::function<void(const std::string& warning)> warn;
  /// The caller's name for the target error, such as an option, for messages.
  const char* error_name;
  bool strict = false;  ///< True if missing light is an error instead of a warning.
};

/// The meters with these names in the scene's order, or all meters if `names` is empty. They refer to the
/// scene, which must outlive them. Throws Error{usage}, which names `option`, for an unknown name.
[[nodiscard]] std::vector<const Meter*> chosen_meters(const MeteredScene& scene,
                                                      const std::vector<std::string>& names,
                                                      const std::string& option);

/// Renders the scene as built by `scene_of` for the meter, and reads the meter. A target error applies to the
/// meter's three figures. Throws Error{resource} if the memory of the render exceeds the rest of the limit of
/// `inputs`. If the caller is strict, throws Error{scene} for a `dark_camera_warning`, and for an
/// `unsampled_light_warning` about an integrator that the scene names. The caller reports
/// `coincidence_warning`, which is the same for all meters of a scene.
[[nodiscard]] MeterMeasurement measure_meter(Scene scene, const Meter& meter, RenderOptions options,
                                             const MeterCallbacks& caller, Inputs& inputs);

}  // namespace abbe
