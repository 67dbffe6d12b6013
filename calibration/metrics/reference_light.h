#pragma once

#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/sources.h"

namespace abbe {

/// Highest colour temperature of a CIE daylight [K].
inline constexpr double kHottestDaylight = 25000;

/// Reference light of colour rendering for a colour temperature [K] up to `kHottestDaylight`: a black body
/// below 5000 K, daylight from there on [CIE13, sec. 5.2]. The two kinds have different scales, since only
/// relative spectra count.
[[nodiscard]] inline Curve rendering_reference(double kelvin) {
  return kelvin < 5000 ? planck(kelvin) : daylight(kelvin);
}

/// Reference light of colour fidelity, on any scale, for a colour temperature [K] up to `kHottestDaylight`: a
/// black body up to 4000 K, daylight from 5000 K on. Between them it is a mixture whose fractions of
/// luminance (CIE 1964), summed over `range`, are linear in the temperature [CIE224, sec. 4.3].
[[nodiscard]] inline Curve fidelity_reference(double kelvin, SumRange range) {
  if (kelvin <= 4000) return planck(kelvin);
  if (kelvin >= 5000) return daylight(kelvin);
  const auto part = [range](const Curve& light, double fraction) {
    return scaled(light, fraction / sum_product(light, color_matching(Observer::cie1964).y, range));
  };
  const double fraction = (kelvin - 4000) / 1000;
  return sum(part(planck(kelvin), 1 - fraction), part(daylight(kelvin), fraction));
}

}  // namespace abbe
