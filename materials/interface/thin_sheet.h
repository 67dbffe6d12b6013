#pragma once

#include <cmath>

#include "materials/interface/mueller.h"

namespace abbe {

/// R (`reflected`) and T (`passed`) of the sheet from r and t of its faces and the transmittance a of one
/// passage.
template <typename T>
struct SheetOrders {
  T reflected, passed;

  SheetOrders(const T& r, const T& t, const T& a) : reflected(r), passed(t * t * a / (T(1) - r * r * a * a)) {
    reflected += passed * r * a;
  }
};

/// Reflectance and transmittance of a plane sheet with the same medium on both sides, cos_i in [0, 1]. `eta`
/// is its index relative to the medium outside, `depth` its optical depth along the normal, 0 or more. The
/// reflections between the faces add up without interference, for s and p separately:
///
///   R = r + t^2 r a^2/(1 - r^2 a^2),  T = t^2 a/(1 - r^2 a^2).
///
/// r + t = 1 holds at one face, and a = e^(-depth/cos_t) is the transmittance of one passage at the angle
/// inside. Transmitted light is not deflected, so the result's cos_t is cos_i; it is 0 if nothing enters.
/// [Stokes1862]
template <typename T>
[[nodiscard]] FresnelPower<T> sheet_power(const T& cos_i, const T& eta, const T& depth) {
  using std::exp;
  const FresnelPower<T> f = fresnel_dielectric(cos_i, eta);
  if (!(f.cos_t > T(0))) return f;
  const T a = exp(-depth / f.cos_t);
  const SheetOrders<T> s(f.Rs, f.Ts, a);
  const SheetOrders<T> p(f.Rp, f.Tp, a);
  return {s.reflected, p.reflected, s.passed, p.passed, cos_i};
}

/// Mueller matrices of the sheet of `sheet_power`, with the same arguments. The products r_s r_p* and t_s
/// t_p* of the faces add up like their powers, because the orders do not interfere.
template <typename T>
[[nodiscard]] InterfaceMueller<T> sheet_mueller(const T& cos_i, const T& eta, const T& depth) {
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
