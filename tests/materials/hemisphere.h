#pragma once

#include <cmath>
#include <numbers>

#include <ImathVec.h>

#include "materials/bsdf.h"
#include "tests/materials/random_directions.h"

namespace abbe {

/// Integral of f(wi) cos over the side z > 0, by the midpoint rule in cos^2 and azimuth.
template <typename F>
double integral_over_cosines(F f, int steps = 400) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j)
      sum += f(direction(std::sqrt((i + 0.5) / steps), 2 * std::numbers::pi * (j + 0.5) / steps));
  return sum * std::numbers::pi / (static_cast<double>(steps) * steps);
}

/// Directional-hemispherical reflectance for light from `from`, z > 0, at one wavelength, without delta
/// lobes.
inline double spread_reflectance(const Bsdf& bsdf, const Imath::V3f& from, int lane = 0) {
  return integral_over_cosines([&](const Imath::V3f& to) {
    return static_cast<double>(eval(bsdf, from, to, TransportMode::power)[lane]);
  });
}

}  // namespace abbe
