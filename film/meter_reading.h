#pragma once

#include <vector>

#include "scene/camera/meter.h"
#include "transport/render/render.h"

namespace abbe {

/// What a meter tells of light: in the units of its quantity, in W, lm and photons per second.
/// Each comes with its standard error and the degrees of freedom that this is estimated with.
struct LightReading {
  Film::Average radiant;
  Film::Average luminous;
  Film::Average photons;
};

/// A meter's reading: the mean while the shutter is open where something moves.
struct MeterReading {
  LightReading whole;
  std::vector<LightReading> cells;      ///< Row by row, `edge_u` first; none of a meter with a single one.
  std::vector<Film::Average> spectrum;  ///< Per nm, bin by bin.
};

/// The probability with which the intervals that are told of readings hold the truth.
inline constexpr double kMeterLevel = 0.95;

/// The units of what a meter tells, of energy, as the eye sees it, and of photons.
struct MeterUnits {
  const char* radiant;
  const char* luminous;
  const char* photons;
};
[[nodiscard]] const MeterUnits& units_of(MeterQuantity quantity);

/// Reads the meter off the film of its camera and channels, exposed for so long.
[[nodiscard]] MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s);

}  // namespace abbe
