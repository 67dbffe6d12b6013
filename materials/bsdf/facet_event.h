#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "materials/bsdf/event.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/microfacet.h"
#include "sampling/sampler.h"

namespace abbe {

/// Functions shared by the rough models. Directions o and i are unit vectors that point away from the
/// surface, in a frame with o.z > 0. `visibility` is G1(o)/o.z, so that facets are sampled with pdf
/// visibility (o.h) D(h).

/// A local direction in the frame in which `wo` is above the surface.
[[nodiscard]] inline Imath::V3f from_side_of(const Imath::V3f& wo, const Imath::V3f& w) {
  return {w.x, w.y, wo.z < 0 ? -w.z : w.z};
}

/// part/all at each wavelength, limited to 1; 0 if `all` is not positive.
[[nodiscard]] inline SampledSpectrum fraction_of(const SampledSpectrum& part, const SampledSpectrum& all) {
  return SampledSpectrum::map(part, all,
                              [](float x, float y) { return y > 0 ? std::min(x / y, 1.0F) : 0.0F; });
}

/// Fraction of the light scattered by a facet from o to i that other facets do not mask: G2/G1(o). The
/// arguments are Smith's Lambda (`Microfacets::lambda`) of both directions. Masking is height-correlated in
/// reflection [Heitz2014, eq. 99] and independent in transmission.
[[nodiscard]] inline float unmasked(float lambda_o, float lambda_i, bool reflected) {
  return reflected ? (1 + lambda_o) / (1 + lambda_o + lambda_i) : 1 / (1 + lambda_i);
}

/// Random numbers for a second sample: hashes of the first ones, practically independent of them.
[[nodiscard]] inline BsdfRandom redrawn(const BsdfRandom& u) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const std::uint32_t key = combine(combine(bits(u.lobe), bits(u.direction.x)), bits(u.direction.y));
  const auto number = [key](std::uint32_t i) { return static_cast<float>(combine(key, i) >> 8U) * 0x1p-24F; };
  return {number(0), {number(1), number(2)}};
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
  /// True if a facet refracts o into i.
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
