#pragma once

#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/sources.h"

namespace abbe {

/// The hottest light that a daylight exists for [K].
inline constexpr double kHottestDaylight = 25000;

/// The light that colour rendering is judged by, of a colour temperature up to `kHottestDaylight`: a black
/// body below 5000 K, daylight from there on [CIE13, sec. 5.2].
[[nodiscard]] inline Curve rendering_reference(double kelvin) {
  return kelvin < 5000 ? planck(kelvin) : daylight(kelvin);
}

/// The reference light of colour fidelity: a black body up to 4000 K, daylight from 5000 K on. In between it
/// is a mixture whose fractions of luminance, summed over a range, are linear in the temperature [CIE224,
/// sec. 4.3].
[[nodiscard]] inline Curve fidelity_reference(double kelvin, SumRange range) {
  if (kelvin <= 4000) return planck(kelvin);
  if (kelvin >= 5000) return daylight(kelvin);
  const auto part = [range](const Curve& light, double share) {
    return scaled(light, share / sum_product(light, color_matching(Observer::cie1964).y, range));
  };
  const double share = (kelvin - 4000) / 1000;
  return sum(part(planck(kelvin), 1 - share), part(daylight(kelvin), share));
}

}  // namespace abbe
