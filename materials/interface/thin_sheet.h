#pragma once

#include <cmath>

#include "materials/interface/fresnel.h"

namespace abbe {

/// A sheet of clear or tinted matter with the same outside on both sides, hit at cos_i in [0, 1]: `eta` is
/// its index relative to the outside, `depth` the -ln a of the passage along its normal. The reflections
/// between its faces are summed without interference, s and p apart,
///
///   R = r + t^2 r a^2/(1 - r^2 a^2),  T = t^2 a/(1 - r^2 a^2),
///
/// with r + t = 1 of one face and a what is left after one passage inside. What passes goes straight on.
/// [Stokes1862]
template <typename T>
[[nodiscard]] FresnelPower<T> sheet_power(const T& cos_i, const T& eta, const T& depth) {
  using std::exp;
  const FresnelPower<T> f = fresnel_dielectric(cos_i, eta);
  if (!(f.cos_t > T(0))) return f;
  const T a = exp(-depth / f.cos_t);
  const T s = f.Ts * f.Ts * a / (1 - f.Rs * f.Rs * a * a);
  const T p = f.Tp * f.Tp * a / (1 - f.Rp * f.Rp * a * a);
  return {f.Rs + s * f.Rs * a, f.Rp + p * f.Rp * a, s, p, cos_i};
}

}  // namespace abbe
