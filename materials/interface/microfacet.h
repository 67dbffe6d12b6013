#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <ImathVec.h>

#include "materials/interface/fresnel.h"

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

// Scattering by single facets. Directions o and i are unit vectors that point away from the surface, in a
// frame with o.z > 0. `visibility` is G1(o)/o.z, so that facets are sampled with pdf visibility (o.h) D(h).

/// Fraction of the light scattered by a facet from o to i that other facets do not mask: G2/G1(o). The
/// arguments are Smith's Lambda (`Microfacets::lambda`) of both directions. Masking is height-correlated in
/// reflection [Heitz2014, eq. 99] and independent in transmission.
[[nodiscard]] inline float unmasked(float lambda_o, float lambda_i, bool reflected) {
  return reflected ? (1 + lambda_o) / (1 + lambda_o + lambda_i) : 1 / (1 + lambda_i);
}

/// Cosine of incidence on the facets that mirror o into i, in [0, 1].
[[nodiscard]] inline float mirror_cosine(const Imath::V3f& o, const Imath::V3f& i) {
  return std::min((o + i).length() / 2, 1.0F);
}

/// Facets that mirror one direction into another.
struct FacetMirror {
  float density;  ///< Pdf of i [1/sr] if the facets reflect all light.
  float cos;      ///< Cosine of incidence on the facets.
};
/// The mirror facets between o and i, i.z > 0.
[[nodiscard]] inline FacetMirror facet_mirror(const Microfacets<float>& facets, float visibility,
                                              const Imath::V3f& o, const Imath::V3f& i) {
  return {visibility * facets.D(o + i) / 4, mirror_cosine(o, i)};  // |dh/di| = 1/(4 o.h)
}

/// A facet that refracts o into i, eta = n_i/n_o. Its normal is parallel to m = o + eta i [Walter2007, eq.
/// 16]. The computation is in double, and Fresnel's formulas use the side of lower index. Both directions of
/// travel then agree at grazing incidence on the facet.
struct RefractingFacet {
  Imath::V3d m;
  /// |m| times the cosines of incidence and refraction. The facet exists only if both are positive.
  double cos_o, cos_i;
  double m2;  ///< |m|^2.

  RefractingFacet(const Imath::V3f& o, const Imath::V3f& i, double eta)
      : m(Imath::V3d(o) + Imath::V3d(i) * eta) {
    const double upward = std::copysign(1.0, m.z);
    cos_o = m.dot(Imath::V3d(o)) * upward;
    cos_i = -m.dot(Imath::V3d(i)) * upward;
    m2 = m.length2();
  }
  [[nodiscard]] bool exists() const { return cos_o > 0 && cos_i > 0 && m.z != 0; }
  /// Cosine between the facet normal and the one of o and i that is on the side of lower index. The facet
  /// must exist.
  [[nodiscard]] float cos_rarer_side(float eta) const {
    return std::min(static_cast<float>((eta > 1 ? cos_o : cos_i) / std::sqrt(m2)), 1.0F);
  }
};
/// Relative index of the interface for light from the side of lower index.
[[nodiscard]] inline float eta_from_rarer_side(float eta) {
  return eta > 1 ? eta : 1 / eta;
}

/// Pdf of i [1/sr] of the light that facets refract from o, eta = n_i/n_o, weighted by their transmittance;
/// |dh/di| is eta^2 |i.h|/m^2. It is 0 if no facet refracts o into i. [Walter2007, eq. 17]
[[nodiscard]] inline float facet_refraction(const Microfacets<float>& facets, float visibility,
                                            const Imath::V3f& o, const Imath::V3f& i, float eta) {
  const double e = eta;
  const RefractingFacet facet(o, i, e);
  if (!facet.exists()) return 0;
  const float transmitted =
      fresnel_dielectric(facet.cos_rarer_side(eta), eta_from_rarer_side(eta)).transmitted();
  return transmitted * visibility * facets.D(Imath::V3f(facet.m)) *
         static_cast<float>(facet.cos_o * facet.cos_i * e * e / (facet.m2 * facet.m2));
}

}  // namespace abbe
