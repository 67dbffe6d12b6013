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

/// CIE 1931 tristimulus values, Y = 1 for the perfect diffuser.
[[nodiscard]] XYZ unit_tristimulus(const Curve& illuminant, const Curve& reflectance, SumRange range = {});

/// Wavelength range over which the channels are summed: 300-1100 nm for sensors, which also count light
/// outside of the visible range, and the range of colorimetric sums for observers.
[[nodiscard]] SumRange sensed(std::span<const Channel> channels);

/// Raw values of a reflectance under an illuminant in channel order, divided by the value of the perfect
/// diffuser in the channel named G, else Y, else the first: `sum_product` over what is `sensed`. Throws
/// Error{input} when that channel does not see the illuminant.
[[nodiscard]] std::vector<double> camera_raw(std::span<const Channel> channels, const Curve& illuminant,
                                             const Curve& reflectance);

/// `sum_product` of illuminant and channel over the same range, in channel order: what the film holds of the
/// perfect diffuser. Throws Error{input} naming a channel that does not see the illuminant.
[[nodiscard]] std::vector<double> diffuser_values(std::span<const Channel> channels, const Curve& illuminant);

using Raw = std::array<double, 3>;

/// What a three-channel camera and the CIE 1931 observer make of the patches of a chart under one illuminant.
struct PatchColors {
  std::vector<std::string> names;
  std::vector<Raw> raw;  ///< White balanced: the perfect diffuser is (1, 1, 1).
  std::vector<XYZ> xyz;  ///< Y = 1 for the perfect diffuser.
  XYZ white;             ///< The perfect diffuser.
  /// What each patch counts in a fit, > 0; empty: all alike.
  std::vector<double> weights = {};
};

/// Integrates a chart; `range` is that of the observer. Throws Error{usage} unless there are three channels,
/// Error{input} when one of them does not see the illuminant.
[[nodiscard]] PatchColors integrate(const Chart& chart, std::span<const Channel> channels,
                                    const Curve& illuminant, SumRange range = {});

}  // namespace abbe
