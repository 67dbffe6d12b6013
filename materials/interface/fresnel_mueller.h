#pragma once

#include <limits>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// Normalised Mueller elements of reflection by a smooth interface of relative index eta + ik, cos_i in [0,
/// 1]: the reflectance of unpolarised light is divided out. The axis is perpendicular to the plane of
/// incidence. Total internal reflection changes the phase only. With g the normal component of the refracted
/// wave vector and theta the angle of incidence, Fresnel's amplitudes [Born1999, sec. 1.5.2 and 14.2] have
/// the ratio
///
///   r_p/r_s = (sin^2 theta - g cos theta)/(sin^2 theta + g cos theta).
///
/// The difference eta - 1 has been divided out, and with it all cancellation. The ratio is -1 along the
/// normal, 0 at Brewster's angle and 1 at grazing angles.
template <typename T>
[[nodiscard]] MuellerElements<T> reflection_mueller(const T& cos_i, const T& eta, const T& k) {
  const Complex<T> w = scaled(normal_component(cos_i, eta, k), cos_i);
  const T u = (T(1) - cos_i) * (T(1) + cos_i);
  // Both terms would vanish along the normal for the perfect mirror n = k = 0.
  const T w2 = norm(w) + T(std::numeric_limits<float>::min());
  const T scale = T(1) / (u * u + w2);
  return {T(2) * u * w.re * scale, T(1), (u * u - w2) * scale, T(2) * u * w.im * scale};
}

/// Normalised Mueller elements of refraction into a transparent medium of relative index eta: the
/// transmittance of unpolarised light is divided out. The axis is perpendicular to the plane of incidence.
/// cos_i is in [0, 1]. The result is meaningless if nothing is refracted. The amplitudes have the ratio
/// t_p/t_s = (cos_i + eta cos_t)/(eta cos_i + cos_t) [Born1999, sec. 1.5.2], which is exactly 1 for eta = 1.
template <typename T>
[[nodiscard]] MuellerElements<T> refraction_mueller(const T& cos_i, const T& eta) {
  const T cos_t = refracted_cosine(cos_i, eta);
  const T less = (eta - T(1)) * (cos_i - cos_t);  // (eta cos_i + cos_t) - (cos_i + eta cos_t)
  const T sum = (eta + T(1)) * (cos_i + cos_t);
  // Twice the sum of both squares. It vanishes for light along a surface between equal media.
  const T squares = sum * sum + less * less + T(std::numeric_limits<float>::min());
  return {T(2) * less * sum / squares, T(1), T(1) - T(2) * less * less / squares, T(0)};
}

}  // namespace abbe
