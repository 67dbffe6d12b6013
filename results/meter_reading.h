#pragma once

#include <vector>

#include "scene/camera/meter.h"
#include "transport/render/render.h"

namespace abbe {

/// Values of a meter in radiometric, photometric and photon units of its quantity (`units_of`). Each has a
/// standard error and the degrees of freedom of its estimate.
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

/// Units of a meter's radiometric, photometric and photon values.
struct MeterUnits {
  const char* radiant;
  const char* luminous;
  const char* photons;
};
/// Units of a meter of that quantity, as texts.
[[nodiscard]] const MeterUnits& units_of(MeterQuantity quantity);

/// Reads the meter from the film of its scene (`camera_of`, `channels_of`), exposed for `exposure_s` [s],
/// above 0. Values are per second and per m^2 or sr, not exposures.
[[nodiscard]] MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s);

}  // namespace abbe
