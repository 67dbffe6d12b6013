#pragma once

#include <optional>
#include <span>

#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"

namespace abbe {

/// The attribute of films and raw files that tells the speed, in single precision.
inline constexpr const char* kIsoSpeedKey = "isoSpeed";

/// Electrons that a pixel of the most sensitive channel counts per lx s of light of `illuminant` on the
/// sensor. Throws Error{internal} for a channel that counts no electrons.
[[nodiscard]] double sensitivity_e_per_lx_s(std::span<const Channel> channels, double gathering_area_m2,
                                            const Curve& illuminant);

/// The same of daylight D55, which speeds are stated for [ISO12232]; nothing where a channel counts no
/// electrons.
[[nodiscard]] std::optional<double> daylight_sensitivity(std::span<const Channel> channels,
                                                         double gathering_area_m2);

/// Warns of the light beyond the table of D55 where channels count so much of it: a speed leaves it out.
void check_daylight(std::span<const Channel> channels, const SourcePosition& where, Diagnostics& diagnostics);

/// Electrons that saturate a pixel: fill its well or reach the highest code, whichever is first.
[[nodiscard]] double saturation_electrons(const Readout& readout);

/// Saturation-based ISO speed 78/H [ISO12232], with H [lx s] the least exposure that saturates a pixel of
/// that sensitivity: fills its well or reaches the highest code, whichever is first. Noise, dark current and
/// offsets between pixels are left out.
[[nodiscard]] double saturation_speed(const Readout& readout, double sensitivity_e_per_lx_s);

/// The gain [electrons per digital number] with which the highest code, not the full well, makes a pixel of
/// that sensitivity have this speed: K = 78 sensitivity/(speed codes).
[[nodiscard]] double gain_of_speed(const Readout& readout, double speed, double sensitivity_e_per_lx_s);

}  // namespace abbe
