#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <ImathVec.h>

namespace abbe {

/// Surfaces of lower roughness are treated as smooth: their lobes are narrower than float precision and
/// pixels can resolve.
inline constexpr double kMinAlpha = 1e-3;

/// Largest ratio of the roughness along the two axes. The tables of multiple scattering are too coarse for a
/// larger one.
inline constexpr double kMaxAlphaRatio = 20;

/// The distribution of slopes: GGX (Trowbridge-Reitz) or Beckmann.
enum class FacetShape { ggx, beckmann };

/// A microfacet surface whose slopes along x and y have widths alpha_x and alpha_y in [kMinAlpha, 1]. Smith's
/// assumption holds: heights and slopes are independent. Directions are local: z points along the normal,
/// away from the surface. A facet is given by its normal h, h.z > 0. Directions w are unit vectors.
template <typename T>
struct Microfacets {
  using Vec = Imath::Vec3<T>;

  FacetShape shape = FacetShape::ggx;
  T alpha_x, alpha_y;

  /// True if the surface is anisotropic.
  [[nodiscard]] bool brushed() const { return alpha_x != alpha_y; }

  /// Normal distribution: area of the facets of normal h per surface area [1/sr]. The integral of D h.z is 1.
  /// h may have any length. [Walter2007, eq. 25 and 33]
  [[nodiscard]] T D(const Vec& h) const;
  /// Smith's Lambda: masked area per visible area of the facets that face w, on either side of the surface.
  /// It is 0 or more, and infinite for w.z = 0. [Heitz2014, sec. 5]
  [[nodiscard]] T lambda(const Vec& w) const;
  /// Smith's masking: fraction of the facets facing w that are visible from w, in [0, 1].
  [[nodiscard]] T G1(const Vec& w) const { return 1 / (1 + lambda(w)); }
  /// Distribution of normals visible from w, w.z > 0: a pdf of the unit vector h [1/sr], 0 for facets that
  /// face away from w. [Heitz2014b]
  [[nodiscard]] T visible(const Vec& w, const Vec& h) const {
    return G1(w) * std::max(T(0), w.dot(h)) * D(h) / w.z;
  }
  /// Samples a unit normal h, h.z > 0, from `visible` with u in [0, 1)^2; w.z > 0.
  [[nodiscard]] Vec sample_visible(const Vec& w, const Imath::Vec2<T>& u) const;
  /// Width of the slopes along the azimuth of w, times the sine of the polar angle of w.
  [[nodiscard]] T projected_alpha(const Vec& w) const {
    return std::sqrt(alpha_x * w.x * (alpha_x * w.x) + alpha_y * w.y * (alpha_y * w.y));
  }
};

/// Inverts the distribution of visible slopes. Slopes s are distributed as exp(-s^2)/sqrt(pi), weighted by
/// max(0, 1 - k s), where k >= 0 is the tangent of the viewing angle. Returns the slope at the cumulative
/// probability u in [0, 1); it lies in [-6, 6]. [Heitz2014b]
[[nodiscard]] inline double visible_slope(double u, double k) {
  constexpr double kMaxSlope = 6;  // larger slopes are too rare for a float u
  constexpr double kRootPi = 1 / std::numbers::inv_sqrtpi;
  const auto below = [k](double s) { return (std::erfc(-s) + k * std::exp(-s * s) / kRootPi) / 2; };
  double low = -kMaxSlope;
  double high = k * kMaxSlope > 1 ? 1 / k : kMaxSlope;
  const double target = u * below(high);
  // The inverse error function to 2e-3 [Winitzki2008] is the start of Newton's method, limited to a bracket.
  const double log = std::log(std::max(4 * u * (1 - u), 1e-12));
  const double half = 2 / (std::numbers::pi * 0.147) + log / 2;
  const double start = std::copysign(std::sqrt(std::sqrt(half * half - log / 0.147) - half), u - 0.5);
  double s = std::clamp(start, low, high);
  for (int i = 0; i < 40; ++i) {
    const double error = below(s) - target;
    (error < 0 ? low : high) = s;
    const double newton = s - error * kRootPi / ((1 - k * s) * std::exp(-s * s));
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (std::abs(next - s) < 1e-7) return next;
    s = next;
  }
  return s;
}

template <typename T>
T Microfacets<T>::D(const Vec& h) const {
  const T x = h.x / alpha_x;
  const T y = h.y / alpha_y;
  const T slopes2 = x * x + y * y;
  const T length2 = h.length2();
  const T area = std::numbers::pi_v<T> * alpha_x * alpha_y;
  if (shape == FacetShape::ggx) {
    const T e = (slopes2 + h.z * h.z) / length2;
    return 1 / (area * e * e);
  }
  const T z2 = h.z * h.z;
  if (!(z2 > 0)) return 0;
  return std::exp(-slopes2 / z2) * (length2 / z2) * (length2 / z2) / area;
}

template <typename T>
T Microfacets<T>::lambda(const Vec& w) const {
  const T a = projected_alpha(w) / std::abs(w.z);  // alpha tan(theta)
  if (shape == FacetShape::ggx) return a * a / (2 * (1 + std::sqrt(1 + a * a)));
  constexpr T kNegligible = T(0.2);  // exp(-1/a^2) is below 2e-11
  if (a < kNegligible) return 0;
  const T v = 1 / a;
  return std::max(T(0), (std::exp(-v * v) * std::numbers::inv_sqrtpi_v<T> * a - std::erfc(v)) / 2);
}

template <typename T>
typename Microfacets<T>::Vec Microfacets<T>::sample_visible(const Vec& w, const Imath::Vec2<T>& u) const {
  // Scale so that the slopes have width 1, sample there, and scale back.
  const Vec scaled = Vec(alpha_x * w.x, alpha_y * w.y, w.z).normalized();
  if (shape == FacetShape::ggx) {
    // The normal is halfway between w and a direction that is uniform over the reflections of w by a
    // hemisphere of mirrors [Dupuy2023].
    const T phi = 2 * std::numbers::pi_v<T> * u.x;
    const T z = (1 - u.y) * (1 + scaled.z);  // component of the sum of both directions, in [0, 1 + w.z]
    const T cap_z = z - scaled.z;
    const T radius = std::sqrt(std::max(T(0), (1 - cap_z) * (1 + cap_z)));
    return Vec(alpha_x * (scaled.x + radius * std::cos(phi)), alpha_y * (scaled.y + radius * std::sin(phi)),
               std::max(z, std::numeric_limits<T>::min()))
        .normalized();
  }
  const T across = std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y);
  const T cos_phi = across > 0 ? scaled.x / across : T(1);
  const T sin_phi = across > 0 ? scaled.y / across : T(0);
  const T along = T(visible_slope(u.x, across / scaled.z));
  const T side = T(visible_slope(u.y, 0));
  return Vec(-alpha_x * (cos_phi * along - sin_phi * side), -alpha_y * (sin_phi * along + cos_phi * side),
             T(1))
      .normalized();
}

}  // namespace abbe
