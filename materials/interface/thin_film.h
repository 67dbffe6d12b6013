#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "materials/interface/complex.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/snell.h"

namespace abbe {

/// A homogeneous plane layer, seen from the medium of incidence, of real index n_i.
template <typename T>
struct FilmLayer {
  T eta, k;     ///< Its index relative to n_i: eta + ik, k >= 0 absorbing.
  T thickness;  ///< In wavelengths of the medium of incidence: n_i d / lambda.
};

/// Coherent layers on a substrate of relative index eta + ik, hit at cos_i in [0, 1]; `layers` from the side
/// of incidence. T is what enters the substrate, so that 1 - R - T stays in the layers; with none of them the
/// result is that of the bare interface. The fields at each boundary follow by the characteristic matrices of
/// the layers [Born1999, sec. 1.6] [Macleod2010, sec. 2.6]: stable for layers and substrates of any
/// absorption, at and beyond every critical angle.
template <typename T>
[[nodiscard]] FresnelPower<T> film_power(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta,
                                         const T& k);

namespace film {

/// What a layer does to one polarisation: with `kappa` its tilted admittance, cos d and (sin d)/kappa and
/// kappa sin d for the phase d, all times e^(-Im d) lest they overflow.
template <typename T>
struct Matrix {
  Complex<T> cosine, over, times;
};

/// The tangential fields of one polarisation: E and H of s, H and E of p, but for a factor.
template <typename T>
struct Fields {
  Complex<T> u, v;
  T scale;  ///< They are this times those which 1 leaves in the substrate.
};

/// `at` carried through a layer to its other side; `decay` is e^(-Im d).
template <typename T>
void cross(Fields<T>& at, const Matrix<T>& m, const T& decay) {
  using std::abs;
  const Complex<T> u = m.cosine * at.u + minus_i(m.over * at.v);
  const Complex<T> v = m.cosine * at.v + minus_i(m.times * at.u);
  // Opaque stacks would overflow, or vanish.
  const T unit = T(1) / (abs(u.re) + abs(u.im) + abs(v.re) + abs(v.im));
  at = {scaled(u, unit), scaled(v, unit), at.scale * decay * unit};
}

/// R and T of the fields at the first boundary; `kappa_t` is the real part of the substrate's admittance.
template <typename T>
std::pair<T, T> powers(const Fields<T>& at, const T& kappa_i, const T& kappa_t) {
  const Complex<T> in = scaled(at.u, kappa_i);
  const T incident = norm(in + at.v);
  return {norm(in + scaled(at.v, T(-1))) / incident,
          T(4) * kappa_i * kappa_t * (at.scale * at.scale / incident)};
}

}  // namespace film

template <typename T>
FresnelPower<T> film_power(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta, const T& k) {
  using std::cos;
  using std::exp;
  using std::expm1;
  using std::sin;
  constexpr double kTurn = 2 * std::numbers::pi;
  const Complex<T> one{T(1), T(0)};
  const Complex<T> q_t = normal_component(cos_i, eta, k);
  const Complex<T> p_t = q_t / square(eta, k);
  film::Fields<T> s{one, q_t, T(1)};
  film::Fields<T> p{one, p_t, T(1)};
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const Complex<T> q = normal_component(cos_i, layer->eta, layer->k);
    const T length = T(kTurn) * layer->thickness;
    const T phase = length * q.re;
    const T loss = length * q.im;
    const bool decays = loss > T(0);  // most layers do not, and exponentials cost
    const T decay = decays ? exp(-loss) : T(1);
    const T even = (T(1) + decay * decay) * T(0.5);  // cosh and sinh times e^-loss
    const T odd = decays ? expm1(T(-2) * loss) * T(-0.5) : T(0);
    const T c = cos(phase);
    const T d = sin(phase);
    const Complex<T> cosine{c * even, -d * odd};
    const Complex<T> sine{d * even, c * odd};
    // At the critical angle of a layer q is 0 and sin(length q)/q its length.
    const Complex<T> over = norm(q) > T(0) ? sine / q : Complex<T>{length, T(0)};
    const Complex<T> eps = square(layer->eta, layer->k);
    film::cross(s, {cosine, over, sine * q}, decay);
    film::cross(p, {cosine, over * eps, sine * q / eps}, decay);
  }
  const auto [Rs, Ts] = film::powers(s, cos_i, q_t.re);
  const auto [Rp, Tp] = film::powers(p, cos_i, p_t.re);
  return {Rs, Rp, Ts, Tp, k > T(0) ? T(0) : refracted_cosine(cos_i, eta)};
}

}  // namespace abbe
