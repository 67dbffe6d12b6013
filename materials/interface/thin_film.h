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

/// A homogeneous plane layer, seen from the medium of incidence, of real index n_i.
template <typename T>
struct FilmLayer {
  T eta, k;     ///< Its index relative to n_i: eta + ik, k >= 0 absorbing.
  T thickness;  ///< In wavelengths of the medium of incidence: n_i d / lambda.

  [[nodiscard]] bool operator==(const FilmLayer&) const = default;
};

/// Coherent layers on a substrate of relative index eta + ik, hit at cos_i in [0, 1]; `layers` from the side
/// of incidence. T is what enters the substrate, so that 1 - R - T stays in the layers; with none of them the
/// result is that of the bare interface. The fields at each boundary follow by the characteristic matrices of
/// the layers [Born1999, sec. 1.6] [Macleod2010, sec. 2.6]: stable for layers and substrates of any
/// absorption, at and beyond every critical angle.
template <typename T>
[[nodiscard]] FresnelPower<T> film_power(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta,
                                         const T& k);

/// Amplitudes of reflection by the same layers on the same substrate, with the signs of
/// `FresnelAmplitudes`.
template <typename T>
struct FilmReflection {
  Complex<T> s, p;
};
template <typename T>
[[nodiscard]] FilmReflection<T> film_reflection(const T& cos_i, std::span<const FilmLayer<T>> layers,
                                                const T& eta, const T& k);

/// What they do to polarisation; light is let through to a clear substrate.
template <typename T>
[[nodiscard]] MuellerBothWays<T> film_mueller(const T& cos_i, std::span<const FilmLayer<T>> layers,
                                              const T& eta, const T& k);

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

/// `at` carried through a layer to its other side; see `Crossing`.
template <typename T>
void cross(Fields<T>& at, const Matrix<T>& m, const T& decay) {
  using std::abs;
  const Complex<T> u = m.cosine * at.u + minus_i(m.over * at.v);
  const Complex<T> v = m.cosine * at.v + minus_i(m.times * at.u);
  // Opaque stacks would overflow, or vanish.
  const T unit = T(1) / (abs(u.re) + abs(u.im) + abs(v.re) + abs(v.im));
  at = {scaled(u, unit), scaled(v, unit), at.scale * decay * unit};
}

/// The waves that make up the fields at the first boundary, times twice kappa_i: what arrives and what goes
/// back.
template <typename T>
struct Waves {
  Complex<T> arriving, reflected;

  Waves(const Fields<T>& at, const T& kappa_i)
      : arriving(scaled(at.u, kappa_i) + at.v), reflected(scaled(at.u, kappa_i) + scaled(at.v, T(-1))) {}
};

/// R and T of the fields at the first boundary; `kappa_t` is the real part of the substrate's admittance.
template <typename T>
std::pair<T, T> powers(const Fields<T>& at, const T& kappa_i, const T& kappa_t) {
  const Waves<T> waves(at, kappa_i);
  const T incident = norm(waves.arriving);
  return {norm(waves.reflected) / incident, T(4) * kappa_i * kappa_t * (at.scale * at.scale / incident)};
}

/// What a layer does to both polarisations; `decay` is e^(-Im d).
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
  const Complex<T> eps = square(layer.eta, layer.k);
  return {{cosine, over, sine * q}, {cosine, over * eps, sine * q / eps}, decay};
}

/// Both polarisations at the first boundary, and what they are to the substrate.
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
  // H of p vanishes on a substrate of index 0, which lets nothing in.
  const bool closed = !(norm(eps_t) > T(0));
  const Complex<T> p_t = closed ? Complex<T>{T(0), T(0)} : q_t / eps_t;
  Fields<T> s{one, q_t, T(1)};
  Fields<T> p = closed ? Fields<T>{p_t, one, T(1)} : Fields<T>{one, p_t, T(1)};
  std::array<Crossing<T>, 2> last;  // of the two layers crossed last, as mirrors repeat the layer before one
  for (std::size_t i = layers.size(); i-- > 0;) {
    Crossing<T>& at = last[i % 2];
    if (i + 2 >= layers.size() || layers[i] != layers[i + 2]) at = crossing_of(cos_i, layers[i]);
    cross(s, at.s, at.decay);
    cross(p, at.p, at.decay);
  }
  return {s, p, q_t, p_t};
}

}  // namespace film

template <typename T>
FresnelPower<T> film_power(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta, const T& k) {
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const auto [Rs, Ts] = film::powers(at.s, cos_i, at.q_t.re);
  const auto [Rp, Tp] = film::powers(at.p, cos_i, at.p_t.re);
  return {Rs, Rp, Ts, Tp, k > T(0) ? T(0) : refracted_cosine(cos_i, eta)};
}

template <typename T>
FilmReflection<T> film_reflection(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta,
                                  const T& k) {
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const film::Waves<T> s(at.s, cos_i);
  const film::Waves<T> p(at.p, cos_i);
  return {s.reflected / s.arriving, p.reflected / p.arriving};
}

template <typename T>
MuellerBothWays<T> film_mueller(const T& cos_i, std::span<const FilmLayer<T>> layers, const T& eta,
                                const T& k) {
  using std::sqrt;
  const film::Stack<T> at = film::stack(cos_i, layers, eta, k);
  const film::Waves<T> s(at.s, cos_i);
  const film::Waves<T> p(at.p, cos_i);
  const auto [Rs, Ts] = film::powers(at.s, cos_i, at.q_t.re);
  const auto [Rp, Tp] = film::powers(at.p, cos_i, at.p_t.re);
  const Complex<T> r_s = s.reflected / s.arriving;
  const Complex<T> r_p = p.reflected / p.arriving;
  // What is let through has the phases of 1 over what arrives.
  const Complex<T> phases = p.arriving * conjugate(s.arriving);
  const T size = sqrt(norm(phases));
  return {mueller_elements(Rs, Rp, r_s * conjugate(r_p)),
          mueller_elements(Ts, Tp, scaled(phases, sqrt(Ts * Tp) / size))};
}

}  // namespace abbe
