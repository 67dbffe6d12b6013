#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "sensor/response/channel.h"
#include "spectral/chart.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// CIE 1931 tristimulus values of a reflectance under an illuminant on any scale, Y = 1 for the perfect
/// diffuser. Not finite if the observer sees nothing of the illuminant in `range`.
[[nodiscard]] XYZ unit_tristimulus(const Curve& illuminant, const Curve& reflectance, SumRange range = {});

/// Wavelength range of sums over the channels: 300-1100 nm for sensors, which also record light outside the
/// visible range, and the range of colorimetric sums for observers.
[[nodiscard]] SumRange sensed(std::span<const Channel> channels);

/// Raw values of a reflectance under an illuminant on any scale, in channel order: `sum_product` over the
/// range `sensed`. They are divided by the value of the perfect diffuser in the channel named G, else Y, else
/// the first. Empty without channels. Throws Error{input} if that channel receives nothing from the
/// illuminant.
[[nodiscard]] std::vector<double> camera_raw(std::span<const Channel> channels, const Curve& illuminant,
                                             const Curve& reflectance);

/// Values of the perfect diffuser, in channel order: `sum_product` of illuminant and channel over the range
/// `sensed`. They scale with the illuminant. Throws Error{input} naming a channel that receives nothing from
/// it.
[[nodiscard]] std::vector<double> diffuser_values(std::span<const Channel> channels, const Curve& illuminant);

/// Values of three channels.
using Raw = std::array<double, 3>;

/// Values of a camera and colours for the CIE 1931 observer, of a chart's patches under one illuminant.
struct PatchColors {
  std::vector<std::string> names;
  std::vector<Raw> raw;  ///< White-balanced values; the perfect diffuser is (1, 1, 1).
  std::vector<XYZ> xyz;  ///< Y = 1 for the perfect diffuser.
  XYZ white;             ///< XYZ of the perfect diffuser, with Y = 1.
  /// Weights of the patches in a fit, > 0; empty for equal weights.
  std::vector<double> weights = {};
};

/// Integrates a chart; `range` is the wavelength range of the observer. Throws Error{usage} unless there are
/// three channels, Error{input} if one of them receives nothing from the illuminant.
[[nodiscard]] PatchColors integrate(const Chart& chart, std::span<const Channel> channels,
                                    const Curve& illuminant, SumRange range = {});

}  // namespace abbe
