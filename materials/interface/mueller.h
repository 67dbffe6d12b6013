#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include <ImathVec.h>

#include "materials/interface/complex.h"
#include "materials/interface/fresnel.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// a/b, or 0 if b is not positive, as for a fraction of a total that may be zero.
template <std::floating_point T>
[[nodiscard]] T quotient(T a, T b) {
  return b > 0 ? a / b : T(0);
}
/// The quotient at each wavelength.
[[nodiscard]] inline SampledSpectrum quotient(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, quotient<float>);
}

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
/// of s p* over all contributions that add without interference. Zero power gives the identity.
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
/// is the direction of travel. `docs/reference/physics.md` defines the signs. The matrix is the same for
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
[[nodiscard]] inline Imath::V3d across(const Imath::V3d& a, const Imath::V3d& b) {
  const Imath::V3d normal = a.cross(b);
  const double length = normal.length();
  if (length > 0) return normal / length;
  return (std::abs(a.x) < std::abs(a.y) ? Imath::V3d(0, a.z, -a.y) : Imath::V3d(a.z, 0, -a.x)).normalized();
}
[[nodiscard]] inline Imath::V3f across(const Imath::V3f& a, const Imath::V3f& b) {
  return Imath::V3f(across(Imath::V3d(a), Imath::V3d(b)));
}

/// The matrix of a smooth surface with the normal z for light along the unit vector `wo`. Its axis is
/// perpendicular to the plane of incidence. If `only` is given, all samples have the elements of that one.
template <std::invocable<int> F>
[[nodiscard]] MuellerMatrix mueller_of_surface(const Imath::V3f& wo, std::optional<int> only, F elements) {
  const Imath::V3f axis = across(wo, {0, 0, 1});
  if (!only) return mueller_of_lanes(axis, elements);
  const MuellerElements<float> m = elements(*only);
  return {axis, SampledSpectrum(m.d), SampledSpectrum(m.p), SampledSpectrum(m.c), SampledSpectrum(m.s)};
}

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

/// Mueller elements of a linear polariser (`PolariserBsdf`) about its axis.
template <typename T>
[[nodiscard]] MuellerElements<T> polariser_mueller(const T& blocked) {
  using std::sqrt;
  return mueller_elements(T(1), blocked, Complex<T>{sqrt(blocked), T(0)});
}

/// Mueller elements of a wave plate with a retardance [rad] about its fast axis. Fields perpendicular to it
/// are retarded, so their phase is larger.
template <typename T>
[[nodiscard]] MuellerElements<T> wave_plate_mueller(const T& retardance) {
  using std::cos;
  using std::sin;
  return {T(0), T(1), cos(retardance), -sin(retardance)};
}

/// Unit vector along the component of an axis in the plane z = 0 that is perpendicular to the unit vector w.
/// If that component is zero, any unit vector perpendicular to w.
template <typename T>
[[nodiscard]] Imath::Vec3<T> projected_axis(const Imath::Vec2<T>& axis, const Imath::Vec3<T>& w) {
  const Imath::Vec3<T> projected = w.cross(Imath::Vec3<T>(axis.x, axis.y, 0)).cross(w);
  const T length = projected.length();
  return length > T(0) ? projected / length : across(w, w);
}

}  // namespace abbe
