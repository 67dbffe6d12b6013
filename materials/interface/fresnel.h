#pragma once

#include <cmath>
#include <limits>

#include "materials/interface/complex.h"
#include "materials/interface/snell.h"

namespace abbe {

/// Power reflectance and transmittance of a smooth surface for s and p polarisation. R + T is 1 at a bare
/// interface and less if thin films or a sheet absorb.
template <typename T>
struct FresnelPower {
  T Rs, Rp;
  T Ts, Tp;
  /// Cosine between the normal and the transmitted ray; 0 if no ray is transmitted, as by total internal
  /// reflection or a conductor.
  T cos_t;

  /// Reflectance and transmittance for unpolarised light.
  [[nodiscard]] T R() const { return (Rs + Rp) * T(0.5); }
  [[nodiscard]] T transmitted() const { return (Ts + Tp) * T(0.5); }
};

/// Fresnel power of a dielectric interface, eta = n_t/n_i > 0, cos_i in [0, 1]. Total internal reflection
/// gives R = 1 and T = 0. R and T keep full relative precision however small they are. [Born1999, sec. 1.5]
template <typename T>
[[nodiscard]] FresnelPower<T> fresnel_dielectric(const T& cos_i, const T& eta) {
  const T cos_t = refracted_cosine(cos_i, eta);
  if (!(cos_t > T(0))) return {T(1), T(1), T(0), T(0), T(0)};
  // r_s = (c - eta ct)/(c + eta ct) and r_p = (eta c - ct)/(eta c + ct), expanded by their denominators. The
  // terms that would cancel in the numerators then cancel analytically. These are all of r_s at eta = 1, and
  // r_p except for the zero at Brewster's angle.
  const T eta2_1 = (eta - T(1)) * (eta + T(1));
  const T s = cos_i + eta * cos_t;
  const T p = eta * cos_i + cos_t;
  const T rs = eta2_1 / s / s;
  // (eta cos_i)^2 - sin_i^2 vanishes at Brewster's angle. For small eta the critical angle, at which r_p is
  // large again, is close to it.
  using W = typename Wider<T>::type;
  const W c_w(cos_i);
  const W eta_w(eta);
  const T brewster = T(c_w * c_w * (eta_w * eta_w + W(1)) - W(1));
  const T rp = eta2_1 / p * (brewster / (eta * eta) / p);
  const T Ts = T(4) * (cos_i / s) * (eta * cos_t / s);
  const T Tp = T(4) * (eta * cos_i / p) * (cos_t / p);
  const auto R = [](const T& r, const T& transmitted) {
    return select(transmitted < T(0.5), T(T(1) - transmitted), T(r * r));
  };
  return {R(rs, Ts), R(rp, Tp), Ts, Tp, cos_t};
}

/// Normal component of the refracted wave vector, sqrt((eta + ik)^2 - sin_i^2), divided by the wave number in
/// the medium of incidence. Both parts are 0 or more.
template <typename T>
[[nodiscard]] Complex<T> normal_component(const T& cos_i, const T& eta, const T& k) {
  using std::sqrt;
  using W = typename Wider<T>::type;
  // a + ib = sqrt(z), z = (eta + ik)^2 - sin_i^2. The larger of a and b comes from a sum, the other from
  // their product eta k.
  const W c_w(cos_i);
  const T re = T((W(eta) - W(k)) * (W(eta) + W(k)) - (W(1) - c_w) * (W(1) + c_w));
  const T half_im = eta * k;
  const T size = sqrt(re * re + T(4) * half_im * half_im);
  const T larger = sqrt((size + (re < T(0) ? -re : re)) * T(0.5));
  const T smaller = larger > T(0) ? half_im / larger : T(0);
  const T a = re < T(0) ? smaller : larger;
  const T b = re < T(0) ? larger : smaller;
  return {a, b};
}

/// Fresnel power of a conductor or absorbing medium of relative index eta + ik, k >= 0, cos_i in [0, 1]. T is
/// the absorptance, the power that enters the medium. [Born1999, sec. 14.2]
template <typename T>
[[nodiscard]] FresnelPower<T> fresnel_conductor(const T& cos_i, const T& eta, const T& k) {
  const auto [a, b] = normal_component(cos_i, eta, k);
  const T& c = cos_i;
  const T sin2 = (T(1) - c) * (T(1) + c);
  const T s = (a + c) * (a + c) + b * b;
  // Without `tiny`, p would vanish along the normal for the perfect mirror n = k = 0, where s and p do not
  // differ.
  const T tiny(std::numeric_limits<float>::min());
  const T p = (a * c + sin2) * (a * c + sin2) + b * c * (b * c) + tiny;
  const T Rs = ((a - c) * (a - c) + b * b) / s;
  const T As = T(4) * a * c / s;
  const T ratio = ((a * c - sin2) * (a * c - sin2) + b * c * (b * c) + tiny) / p;
  return {Rs, Rs * ratio, As, As + T(4) * Rs * a * c * sin2 / p, T(0)};
}

/// Schlick's approximation r0 + (1 - r0) (1 - cos_i)^5 of the reflectance, for comparison only. r0 is the
/// reflectance along the normal, cos_i in [0, 1]. [Schlick1994]
template <typename T>
[[nodiscard]] T schlick(const T& cos_i, const T& r0) {
  const T m = T(1) - cos_i;
  const T m2 = m * m;
  return r0 + (T(1) - r0) * (m2 * m2 * m);
}

/// Diffuse reflectance 2 int_0^1 R(c) c dc from inside a medium of index eta > 0 relative to the outside,
/// including total internal reflection; R is the mean over s and p. Diffuse transmission from outside is
/// eta^2 times that from inside, so 1 - r_inside = (1 - r_outside)/eta^2. Accurate to 1e-7. [Judd1942]
[[nodiscard]] double diffuse_reflectance_inside(double eta);

/// Diffuse reflectance of a smooth interface to a medium of index n + ik, relative to the outside, from which
/// the light arrives; n > 0, k >= 0. It is 2 int_0^1 R(c) c dc by Gauss-Legendre quadrature, accurate to
/// 5e-5. If n < 1 and k is so small that total reflection sets in at an angle, the error is up to 2e-3.
[[nodiscard]] double diffuse_reflectance(double n, double k);

}  // namespace abbe
