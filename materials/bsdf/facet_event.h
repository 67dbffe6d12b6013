#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "materials/bsdf/event.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/microfacet.h"
#include "sampling/mix.h"

namespace abbe {

/// What rough surfaces have in common. Directions o and i are on the side of the surface where o.z > 0, and
/// `seen` is G1(o)/o.z, so that facets are drawn with the density seen (o.h) D(h).

/// Local directions as seen from the side of `wo`.
[[nodiscard]] inline Imath::V3f from_side_of(const Imath::V3f& wo, const Imath::V3f& w) {
  return {w.x, w.y, wo.z < 0 ? -w.z : w.z};
}

/// The share of `part` in `all`, lane by lane; 0 of nothing.
[[nodiscard]] inline SampledSpectrum share_of(const SampledSpectrum& part, const SampledSpectrum& all) {
  return SampledSpectrum::map(part, all,
                              [](float x, float y) { return y > 0 ? std::min(x / y, 1.0F) : 0.0F; });
}

/// The fraction of the light that a facet sends from o into i that no other facet stops, by the lambda of
/// both. Masking is correlated by height in reflection, where o and i are on the same side [Heitz2014, eq.
/// 99], and independent in transmission.
[[nodiscard]] inline float unmasked(float lambda_o, float lambda_i, bool reflected) {
  return reflected ? (1 + lambda_o) / (1 + lambda_o + lambda_i) : 1 / (1 + lambda_i);
}

/// Random numbers for a second draw: hashes of those of the first, as good as independent of them.
[[nodiscard]] inline BsdfRandom redrawn(const BsdfRandom& u) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const std::uint32_t key = combine(combine(bits(u.lobe), bits(u.direction.x)), bits(u.direction.y));
  const auto number = [key](std::uint32_t i) { return static_cast<float>(combine(key, i) >> 8U) * 0x1p-24F; };
  return {number(0), {number(1), number(2)}};
}

/// The cosine at which facets are met that mirror o into i.
[[nodiscard]] inline float mirror_cosine(const Imath::V3f& o, const Imath::V3f& i) {
  return std::min((o + i).length() / 2, 1.0F);
}

/// Facets that mirror o into i: the density of i [1/sr] by all their light, and the cosine they are met at.
struct FacetMirror {
  float density;
  float cos;
};
[[nodiscard]] inline FacetMirror facet_mirror(const Microfacets<float>& facets, float seen,
                                              const Imath::V3f& o, const Imath::V3f& i) {
  return {seen * facets.D(o + i) / 4, mirror_cosine(o, i)};  // |dh/di| = 1/(4 o.h)
}

/// Facets that refract o into i, eta = n_i/n_o: their normal is that of o + eta i = m [Walter2007, eq. 16].
/// In double, and with what Fresnel's formulas ask for from the thinner side, so that both ways agree where
/// facets are met at grazing angles.
struct RefractingFacet {
  Imath::V3d m;
  double cos_o, cos_i;  ///< With m, times its length; none such facet is there unless both are positive.
  double m2;

  RefractingFacet(const Imath::V3f& o, const Imath::V3f& i, double eta)
      : m(Imath::V3d(o) + Imath::V3d(i) * eta) {
    const double upward = std::copysign(1.0, m.z);
    cos_o = m.dot(Imath::V3d(o)) * upward;
    cos_i = -m.dot(Imath::V3d(i)) * upward;
    m2 = m.length2();
  }
  [[nodiscard]] bool there() const { return cos_o > 0 && cos_i > 0 && m.z != 0; }
  [[nodiscard]] float cos_thin(float eta) const {
    return std::min(static_cast<float>((eta > 1 ? cos_o : cos_i) / std::sqrt(m2)), 1.0F);
  }
};
[[nodiscard]] inline float from_thin(float eta) {
  return eta > 1 ? eta : 1 / eta;
}

/// Density of i [1/sr] by the light that facets refract from o into it, eta = n_i/n_o; |dh/di| is
/// eta^2 |i.h|/m^2. [Walter2007, eq. 17]
[[nodiscard]] inline float facet_refraction(const Microfacets<float>& facets, float seen, const Imath::V3f& o,
                                            const Imath::V3f& i, float eta) {
  const double e = eta;
  const RefractingFacet facet(o, i, e);
  if (!facet.there()) return 0;
  const float transmitted = fresnel_dielectric(facet.cos_thin(eta), from_thin(eta)).transmitted();
  return transmitted * seen * facets.D(Imath::V3f(facet.m)) *
         static_cast<float>(facet.cos_o * facet.cos_i * e * e / (facet.m2 * facet.m2));
}

}  // namespace abbe
