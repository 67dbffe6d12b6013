#pragma once

#include <vector>

#include "scene/camera/meter.h"
#include "transport/render/render.h"

namespace abbe {

/// Values of a meter in radiometric, photometric and photon units of its quantity. Each has a standard error
/// and the degrees of freedom of its estimate.
struct LightReading {
  Film::Average radiant;
  Film::Average luminous;
  Film::Average photons;
};

/// A meter's reading, averaged over the open shutter if something moves.
struct MeterReading {
  LightReading whole;
  std::vector<LightReading> cells;      ///< Row by row, `edge_u` first; empty for a single cell.
  std::vector<Film::Average> spectrum;  ///< Values per nm, for each bin.
};

/// Confidence level of the reported intervals.
inline constexpr double kMeterConfidence = 0.95;

/// Units of a meter's radiometric, photometric and photon values.
struct MeterUnits {
  const char* radiant;
  const char* luminous;
  const char* photons;
};
/// Units of a meter of that quantity.
[[nodiscard]] const MeterUnits& units_of(MeterQuantity quantity);

/// Reads the meter from the film of its scene, exposed for `exposure_s` [s].
[[nodiscard]] MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s);

}  // namespace abbe
