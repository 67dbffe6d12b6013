#pragma once

#include <concepts>
#include <cstddef>

#include <ImathVec.h>

#include "materials/interface/complex.h"
#include "materials/interface/quotient.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// The elements d, p, c and s of a `MuellerMatrix` at one wavelength.
template <typename T>
struct MuellerElements {
  T d{0}, p{1}, c{1}, s{0};
};

/// Mueller elements of reflection and of transmission.
template <typename T>
struct InterfaceMueller {
  MuellerElements<T> reflected, through;
};

/// An ideal mirror: it reflects s and p equally, with the signs of reflection along the normal.
template <typename T>
inline constexpr MuellerElements<T> kIdealMirror{T(0), T(1), T(-1), T(0)};

/// Elements from the powers `S` and `P` perpendicular to the plane of incidence and in it. `sp` is the mean
/// of s p* over all contributions that add without interference. Returns the elements of the identity if the
/// power is zero.
template <typename T>
[[nodiscard]] MuellerElements<T> mueller_elements(const T& S, const T& P, const Complex<T>& sp) {
  const T sum = S + P;
  if (!(sum > T(0))) return {};
  return {(S - P) / sum, T(1), T(2) * sp.re / sum, T(2) * sp.im / sum};
}

/// Mean of matrices about one axis, weighted by the power that each contributes for unpolarised light. If the
/// total power is 0, all elements are 0, as for a depolariser.
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
  /// Adds a contribution that depolarises.
  void add_unpolarised(const T& power) { power_ += power; }

  /// The weighted mean of all contributions.
  [[nodiscard]] MuellerElements<T> mean() const {
    return {quotient(sum_.d, power_), quotient(sum_.p, power_), quotient(sum_.c, power_),
            quotient(sum_.s, power_)};
  }

 private:
  MuellerElements<T> sum_{T(0), T(0), T(0), T(0)};
  T power_{0};
};

/// Normalised Mueller matrix of an event at each wavelength, divided by its first element:
///     1 d 0  0
///     d p 0  0
///     0 0 c -s
///     0 0 s  c.
/// The Stokes vectors (I, Q, U, V) of the arriving and the leaving light use frames with a common first axis.
/// It is a unit vector perpendicular to both directions. The second axis is k x axis, where the unit vector k
/// is the direction of travel. `docs/physics/conventions.md` defines the signs. The matrix is the same for
/// both directions of travel along the path.
///
/// Every event that is symmetric about the plane of its directions has this form. Let an interface have the
/// amplitudes s and p for fields perpendicular to the plane of incidence (along the axis) and in it, and the
/// powers S and P. Then d = (S - P)/(S + P) and c + is = 2 s p*/(S + P) [Born1999, sec. 1.5]. Polarisers and
/// retarders have it about their own axis. Without depolarisation p = 1 and d^2 + c^2 + s^2 = 1.
struct MuellerMatrix {
  Imath::V3f axis;  ///< Unit vector in the frame of the event's directions, local or world.
  SampledSpectrum d{};
  SampledSpectrum p{1.0F};
  SampledSpectrum c{1.0F};
  SampledSpectrum s{};
};

/// The matrix about `axis` with `elements(lane)` at each wavelength sample.
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

/// A unit vector perpendicular to two unit vectors; if they are parallel, any vector perpendicular to the
/// first.
[[nodiscard]] Imath::V3d across(const Imath::V3d& a, const Imath::V3d& b);
[[nodiscard]] inline Imath::V3f across(const Imath::V3f& a, const Imath::V3f& b) {
  return Imath::V3f(across(Imath::V3d(a), Imath::V3d(b)));
}

}  // namespace abbe
