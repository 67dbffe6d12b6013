#pragma once

#include <cmath>

#include "materials/interface/fresnel_mueller.h"

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
[[nodiscard]] FresnelPower<T> sheet_power(const T& cos_i, const T& eta, const T& depth);

/// What it does to polarisation: r_s r_p* and t_s t_p* of the faces add up as their powers do, since each
/// order is a passage of its own.
template <typename T>
[[nodiscard]] MuellerBothWays<T> sheet_mueller(const T& cos_i, const T& eta, const T& depth);

/// R and T of the sheet, by r and t of its faces and a of the passage.
template <typename T>
struct SheetOrders {
  T reflected, passed;

  SheetOrders(const T& r, const T& t, const T& a) : reflected(r), passed(t * t * a / (T(1) - r * r * a * a)) {
    reflected += passed * r * a;
  }
};

template <typename T>
FresnelPower<T> sheet_power(const T& cos_i, const T& eta, const T& depth) {
  using std::exp;
  const FresnelPower<T> f = fresnel_dielectric(cos_i, eta);
  if (!(f.cos_t > T(0))) return f;
  const T a = exp(-depth / f.cos_t);
  const SheetOrders<T> s(f.Rs, f.Ts, a);
  const SheetOrders<T> p(f.Rp, f.Tp, a);
  return {s.reflected, p.reflected, s.passed, p.passed, cos_i};
}

template <typename T>
MuellerBothWays<T> sheet_mueller(const T& cos_i, const T& eta, const T& depth) {
  using std::exp;
  using std::sqrt;
  const FresnelPower<T> f = fresnel_dielectric(cos_i, eta);
  const MuellerElements<T> face = reflection_mueller(cos_i, eta, T(0));
  if (!(f.cos_t > T(0))) return {face, {}};
  const T a = exp(-depth / f.cos_t);
  const SheetOrders<T> s(f.Rs, f.Ts, a);
  const SheetOrders<T> p(f.Rp, f.Tp, a);
  const SheetOrders<T> sp(face.c * f.R(), sqrt(f.Ts * f.Tp), a);
  return {mueller_elements(s.reflected, p.reflected, {sp.reflected, T(0)}),
          mueller_elements(s.passed, p.passed, {sp.passed, T(0)})};
}

}  // namespace abbe
