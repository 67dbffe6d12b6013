#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

#include "materials/interface/complex.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/interface/snell.h"

namespace abbe {

/// A homogeneous plane layer, described relative to the medium of incidence of real index n_i.
template <typename T>
struct FilmLayer {
  T eta, k;     ///< Index eta + ik relative to n_i; k >= 0 absorbs.
  T thickness;  ///< In wavelengths of the medium of incidence: n_i d / lambda.

  [[nodiscard]] bool operator==(const FilmLayer&) const = default;
};

/// Amplitude reflection coefficients of coherent layers on a substrate: the reflected electric field divided
/// by the incident one. s and p have opposite signs at normal incidence. Fields vary in time as
/// exp(-i omega t).
template <typename T>
struct FilmReflection {
  Complex<T> s, p;
};
namespace film {

/// Characteristic matrix of a layer for one polarisation, with tilted admittance `kappa` and phase d: cos d,
/// (sin d)/kappa and kappa sin d. All elements are multiplied by e^(-Im d), so that they do not overflow.
template <typename T>
struct Matrix {
  Complex<T> cosine, over, times;
};

/// Tangential fields of one polarisation at a boundary between layers, normalised: u and v are E and H for s,
/// H and E for p, in units in which v = kappa u for a wave that travels into the substrate.
template <typename T>
struct Fields {
  Complex<T> u, v;
  T scale;  ///< u and v divided by the fields here that a unit field in the substrate causes.
};

/// Propagates the fields `at` on the far side of a layer to the side of incidence. `m` is the layer's matrix,
/// `decay` the factor e^(-Im d) that it contains.
template <typename T>
void cross(Fields<T>& at, const Matrix<T>& m, const T& decay) {
  using std::abs;
  const Complex<T> u = m.cosine * at.u + minus_i(m.over * at.v);
  const Complex<T> v = m.cosine * at.v + minus_i(m.times * at.u);
  // Normalise, because the fields of opaque stacks would overflow or underflow.
  const T unit = T(1) / (abs(u.re) + abs(u.im) + abs(v.re) + abs(v.im));
  at = {scaled(u, unit), scaled(v, unit), at.scale * decay * unit};
}

/// The incident and the reflected wave that compose the fields at the first boundary, times 2 kappa_i.
/// kappa_i is the admittance of the medium of incidence, the cosine of incidence.
template <typename T>
struct Waves {
  Complex<T> arriving, reflected;

  Waves(const Fields<T>& at, const T& kappa_i)
      : arriving(scaled(at.u, kappa_i) + at.v), reflected(scaled(at.u, kappa_i) + scaled(at.v, T(-1))) {}
};

/// R and T, in this order; `kappa_i` is the cosine of incidence, `kappa_t` the real part of the substrate's
/// admittance.
template <typename T>
std::pair<T, T> powers(const Fields<T>& at, const T& kappa_i, const T& kappa_t) {
  const Waves<T> waves(at, kappa_i);
  const T incident = norm(waves.arriving);
  return {norm(waves.reflected) / incident, T(4) * kappa_i * kappa_t * (at.scale * at.scale / incident)};
}

/// Characteristic matrices of a layer for both polarisations; `decay` is e^(-Im d).
template <typename T>
struct Crossing {
  Matrix<T> s, p;
  T decay;
};
template <typename T>
Crossing<T> crossing_of(const T& cos_i, const FilmLayer<T>& layer) {
  using std::cos;
  using std::exp;
  using std::expm1;
  using std::sin;
  constexpr double kTurn = 2 * std::numbers::pi;
  const Complex<T> q = normal_component(cos_i, layer.eta, layer.k);
  const T length = T(kTurn) * layer.thickness;
  const T phase = length * q.re;
  const T loss = length * q.im;
  const bool decays = loss > T(0);  // most layers do not, and exponentials are slow
  const T decay = decays ? exp(-loss) : T(1);
  const T even = (T(1) + decay * decay) * T(0.5);  // cosh and sinh times e^-loss
  const T odd = decays ? expm1(T(-2) * loss) * T(-0.5) : T(0);
  const T c = cos(phase);
  const T d = sin(phase);
  const Complex<T> cosine{c * even, -d * odd};
  const Complex<T> sine{d * even, c * odd};
  // At the critical angle of a layer q is 0, and sin(length q)/q is the length.
  const Complex<T> over = norm(q) > T(0) ? sine / q : Complex<T>{length, T(0)};
  const Complex<T> eps = square(layer.eta, layer.k);
  return {{cosine, over, sine * q}, {cosine, over * eps, sine * q / eps}, decay};
}

/// Fields of both polarisations at the first boundary, and the admittances of the substrate for s (`q_t`) and
/// p (`p_t`).
template <typename T>
struct Stack {
  Fields<T> s, p;
  Complex<T> q_t, p_t;
};
template <typename T>
Stack<T> stack(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta, const T& k) {
  const Complex<T> one{T(1), T(0)};
  const Complex<T> q_t = normal_component(cos_i, eta, k);
  const Complex<T> eps_t = square(eta, k);
  // H of p vanishes on a substrate of index 0, which transmits nothing.
  const bool closed = !(norm(eps_t) > T(0));
  const Complex<T> p_t = closed ? Complex<T>{T(0), T(0)} : q_t / eps_t;
  Fields<T> s{one, q_t, T(1)};
  Fields<T> p = closed ? Fields<T>{p_t, one, T(1)} : Fields<T>{one, p_t, T(1)};
  std::array<Crossing<T>, 2> last;  // of the last two layers: mirrors alternate between two layers
  for (std::size_t i = layers.size(); i-- > 0;) {
    Crossing<T>& at = last[i % 2];
    if (i + 2 >= layers.size() || layers[i] != layers[i + 2]) at = crossing_of(cos_i, layers[i]);
    cross(s, at.s, at.decay);
    cross(p, at.p, at.decay);
  }
  return {s, p, q_t, p_t};
}

}  // namespace film

/// Reflectance and transmittance of coherent layers on a substrate of relative index eta + ik, cos_i in [0,
/// 1]. `layers` are ordered from the side of incidence. T is the power that enters the substrate, so the
/// layers absorb 1 - R - T. cos_t is that of the substrate, 0 if k > 0. Without layers the result is that of
/// the bare interface.
///
/// The fields at each boundary follow from the characteristic matrices of the layers [Born1999, sec. 1.6]
/// [Macleod2010, sec. 2.6]. The method is stable for any absorption and at all angles, also above the
/// critical ones.
template <typename T>
[[nodiscard]] FresnelPower<T> film_power(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta,
                                         const T& k) {
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const auto [Rs, Ts] = film::powers(at.s, cos_i, at.q_t.re);
  const auto [Rp, Tp] = film::powers(at.p, cos_i, at.p_t.re);
  return {Rs, Rp, Ts, Tp, k > T(0) ? T(0) : refracted_cosine(cos_i, eta)};
}

/// Amplitude reflection coefficients, with the arguments of `film_power`.
template <typename T>
[[nodiscard]] FilmReflection<T> film_reflection(const T& cos_i, std::span<const FilmLayer<T>> layers,
                                                const T& eta, const T& k) {
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const film::Waves<T> s(at.s, cos_i);
  const film::Waves<T> p(at.p, cos_i);
  return {s.reflected / s.arriving, p.reflected / p.arriving};
}

/// Mueller matrices of reflection and transmission, with the arguments of `film_power`. The matrix of
/// transmission holds for a transparent substrate.
template <typename T>
[[nodiscard]] InterfaceMueller<T> film_mueller(const T& cos_i, std::span<const FilmLayer<T>> layers,
                                               const T& eta, const T& k) {
  using std::sqrt;
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const film::Waves<T> s(at.s, cos_i);
  const film::Waves<T> p(at.p, cos_i);
  const auto [Rs, Ts] = film::powers(at.s, cos_i, at.q_t.re);
  const auto [Rp, Tp] = film::powers(at.p, cos_i, at.p_t.re);
  const Complex<T> r_s = s.reflected / s.arriving;
  const Complex<T> r_p = p.reflected / p.arriving;
  // The transmitted amplitudes have the phase of 1/arriving.
  const Complex<T> phases = p.arriving * conjugate(s.arriving);
  const T size = sqrt(norm(phases));
  return {mueller_elements(Rs, Rp, r_s * conjugate(r_p)),
          mueller_elements(Ts, Tp, scaled(phases, sqrt(Ts * Tp) / size))};
}

}  // namespace abbe
