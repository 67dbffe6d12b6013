#pragma once

#include <span>

#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Electrons that a pixel of the most sensitive channel counts per lx s of light of `illuminant` on the
/// sensor. Throws Error{internal} for a channel that counts no electrons.
[[nodiscard]] double sensitivity_e_per_lx_s(std::span<const Channel> channels, double gathering_area_m2,
                                            const Curve& illuminant);

/// Saturation-based ISO speed 78/H [ISO12232], with H [lx s] the least exposure that saturates a pixel of
/// that sensitivity: fills its well or reaches the highest code, whichever is first. Noise, dark current and
/// offsets between pixels are left out.
[[nodiscard]] double saturation_speed(const Readout& readout, double sensitivity_e_per_lx_s);

}  // namespace abbe
