#pragma once

#include <limits>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// What reflection by a smooth interface does to polarisation, for a relative index eta + ik and cos_i in
/// [0, 1]; nothing but a phase where reflection is total. With g the refracted wave's component along the
/// normal and theta the angle of incidence Fresnel's amplitudes [Born1999, sec. 1.5.2 and 14.2] are in the
/// ratio
///
///   r_p/r_s = (sin^2 theta - g cos theta)/(sin^2 theta + g cos theta),
///
/// from which the difference of eta and 1 has gone, and with it all that cancels. It is -1 along the normal
/// and 1 at grazing angles, and 0 at Brewster's.
template <typename T>
[[nodiscard]] MuellerElements<T> reflection_mueller(const T& cos_i, const T& eta, const T& k) {
  const Complex<T> w = scaled(normal_component(cos_i, eta, k), cos_i);
  const T u = (T(1) - cos_i) * (T(1) + cos_i);
  // Of the perfect mirror, n = k = 0, both would vanish along the normal.
  const T w2 = norm(w) + T(std::numeric_limits<float>::min());
  const T scale = T(1) / (u * u + w2);
  return {T(2) * u * w.re * scale, T(1), (u * u - w2) * scale, T(2) * u * w.im * scale};
}

/// What refraction by a smooth interface to clear matter of relative index eta does to polarisation; where
/// nothing is refracted numbers that mean nothing. The amplitudes are in the ratio
/// t_p/t_s = (cos_i + eta cos_t)/(eta cos_i + cos_t) [Born1999, sec. 1.5.2]: 1 exactly for eta = 1.
template <typename T>
[[nodiscard]] MuellerElements<T> refraction_mueller(const T& cos_i, const T& eta) {
  const T cos_t = refracted_cosine(cos_i, eta);
  const T less = (eta - T(1)) * (cos_i - cos_t);  // eta cos_i + cos_t, less the other
  const T sum = (eta + T(1)) * (cos_i + cos_t);
  // Twice the sum of both squares; light along the surface of equal matter has none.
  const T squares = sum * sum + less * less + T(std::numeric_limits<float>::min());
  return {T(2) * less * sum / squares, T(1), T(1) - T(2) * less * less / squares, T(0)};
}

}  // namespace abbe
