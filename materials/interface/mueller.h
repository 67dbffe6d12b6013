#pragma once

#include <concepts>
#include <cstddef>

#include <ImathVec.h>

#include "materials/interface/complex.h"
#include "materials/interface/quotient.h"
#include "spectral/packet.h"

namespace abbe {

/// The elements d, p, c and s of a `MuellerMatrix` at one wavelength.
template <typename T>
struct MuellerElements {
  T d{0}, p{1}, c{1}, s{0};
};

/// The elements of what reflects, and of what lets through.
template <typename T>
struct MuellerBothWays {
  MuellerElements<T> reflected, through;
};

/// What reflects both polarisations alike, with the signs that reflection has along the normal.
template <typename T>
inline constexpr MuellerElements<T> kIdealMirror{T(0), T(1), T(-1), T(0)};

/// Of light that has the powers `S` and `P` across the plane of incidence and in it, and the mean `sp` of s
/// p* over whatever adds up without interference; the identity where nothing is left.
template <typename T>
[[nodiscard]] MuellerElements<T> mueller_elements(const T& S, const T& P, const Complex<T>& sp) {
  const T sum = S + P;
  if (!(sum > T(0))) return {};
  return {(S - P) / sum, T(1), T(2) * sp.re / sum, T(2) * sp.im / sum};
}

/// The mean of the matrices about one axis of what sends light the same way, by the power that each sends of
/// unpolarised light. The elements of a sum of no power are 0, as of what depolarises.
template <typename T>
class MuellerMean {
 public:
  void add(const T& power, const MuellerElements<T>& part) {
    sum_.d += power * part.d;
    sum_.p += power * part.p;
    sum_.c += power * part.c;
    sum_.s += power * part.s;
    add_unpolarised(power);
  }
  /// A part that depolarises.
  void add_unpolarised(const T& power) { power_ += power; }

  [[nodiscard]] MuellerElements<T> mean() const {
    return {quotient(sum_.d, power_), quotient(sum_.p, power_), quotient(sum_.c, power_),
            quotient(sum_.s, power_)};
  }

 private:
  MuellerElements<T> sum_{T(0), T(0), T(0), T(0)};
  T power_{0};
};

/// What an event does to polarised light over what it does to unpolarised light, lane by lane: Mueller's
/// matrix over its first element,
///     1 d 0  0
///     d p 0  0
///     0 0 c -s
///     0 0 s  c,
/// for light that arrives and leaves with Stokes vectors (I, Q, U, V) in frames of one common first axis, a
/// unit vector perpendicular to both directions; the second axis of each is k x axis, k being the unit vector
/// along which the light travels. `docs/physics/conventions.md` says what the signs mean. Nothing in it
/// depends on which of its two ways the light takes. All that is isotropic about the plane of its directions
/// has this form: interfaces with d = (S - P)/(S + P) and c + is = 2 s p*/(S + P) for the amplitudes s, p of
/// the fields across the plane of incidence, along the axis, and in it, and their powers S, P [Born1999,
/// sec. 1.5]; so have polarisers and retarders about their own axis. p is 1, and d^2 + c^2 + s^2 too, where
/// nothing is depolarised.
struct MuellerMatrix {
  Imath::V3f axis;
  SampledSpectrum d{};
  SampledSpectrum p{1.0F};
  SampledSpectrum c{1.0F};
  SampledSpectrum s{};
};

/// The matrix about `axis` whose elements at each lane are `elements(lane)`.
template <std::invocable<int> F>
[[nodiscard]] MuellerMatrix mueller_of_lanes(const Imath::V3f& axis, F elements) {
  SampledSpectrum::Values d, p, c, s;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto j = static_cast<std::size_t>(lane);
    const MuellerElements<float> at = elements(lane);
    d[j] = at.d;
    p[j] = at.p;
    c[j] = at.c;
    s[j] = at.s;
  }
  return {axis, SampledSpectrum(d), SampledSpectrum(p), SampledSpectrum(c), SampledSpectrum(s)};
}

/// A unit vector perpendicular to both of two unit vectors; to the first where they are parallel.
[[nodiscard]] Imath::V3d across(const Imath::V3d& a, const Imath::V3d& b);
[[nodiscard]] inline Imath::V3f across(const Imath::V3f& a, const Imath::V3f& b) {
  return Imath::V3f(across(Imath::V3d(a), Imath::V3d(b)));
}

}  // namespace abbe
