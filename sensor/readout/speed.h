#pragma once

#include <span>

#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Saturation-based ISO speed 78/H [ISO12232], with H [lx s] the least exposure of the sensor to light of
/// `illuminant` that saturates a channel: fills the well or reaches the highest code, whichever is first.
/// Noise, dark current and offsets between pixels are left out. 0 when no channel sees the light. Throws
/// Error{internal} for a channel that counts no electrons.
[[nodiscard]] double saturation_speed(const Readout& readout, std::span<const Channel> channels,
                                      double gathering_area_m2, const Curve& illuminant);

}  // namespace abbe
