#pragma once

#include <optional>
#include <span>

#include "sensor/readout/readout.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Attribute of films and raw files with the ISO speed, in single precision.
inline constexpr const char* kIsoSpeedKey = "isoSpeed";

/// Electrons per pixel of the most sensitive channel for a luminous exposure of 1 lx s from daylight D55, to
/// which speeds refer [ISO12232]. A channel with its own exposure time counts as exposed for that of the
/// sensor. Nothing if a channel does not count electrons. Throws Error if the shipped table of D55 is
/// missing.
[[nodiscard]] std::optional<double> daylight_sensitivity(std::span<const Channel> channels,
                                                         double gathering_area_m2);

/// Warns if channels respond to a non-negligible fraction of daylight outside the table of D55. Throws Error
/// if that table is missing.
void check_daylight(std::span<const Channel> channels, const SourcePosition& where, Diagnostics& diagnostics);

/// Electrons that saturate a pixel: those of a full well or of the highest code, whichever are fewer.
[[nodiscard]] double saturation_electrons(const Readout& readout);

/// Saturation-based ISO speed 78/H [ISO12232], where H [lx s] is the smallest luminous exposure that
/// saturates a pixel of this sensitivity. Noise, dark current and offsets between pixels are ignored.
[[nodiscard]] double saturation_speed(const Readout& readout, double sensitivity_e_per_lx_s);

/// Gain [electrons per digital number] at which the highest code, and not the full well, gives this speed: K
/// = 78 sensitivity/(speed codes), with the number of codes above the offset.
[[nodiscard]] double gain_of_speed(const Readout& readout, double speed, double sensitivity_e_per_lx_s);

}  // namespace abbe
