#pragma once

#include <cmath>

#include "materials/bsdf/event.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/microfacet.h"

namespace abbe {

/// What rough surfaces have in common. Directions o and i are on the side of the surface where o.z > 0, and
/// `seen` is G1(o)/o.z, so that facets are drawn with the density seen (o.h) D(h).

/// Local directions as seen from the side of `wo`.
[[nodiscard]] inline Imath::V3f from_side_of(const Imath::V3f& wo, const Imath::V3f& w) {
  return {w.x, w.y, wo.z < 0 ? -w.z : w.z};
}

/// Facets that mirror o into i: the density of i [1/sr] by all their light, and the cosine they are met at.
struct FacetMirror {
  float density;
  float cos;
};
[[nodiscard]] inline FacetMirror facet_mirror(const Microfacets<float>& facets, float seen,
                                              const Imath::V3f& o, const Imath::V3f& i) {
  const Imath::V3f h = o + i;
  return {seen * facets.D(h) / 4, std::min(h.length() / 2, 1.0F)};  // |dh/di| = 1/(4 o.h)
}

/// Density of i [1/sr] by the light that facets refract from o into it, eta = n_i/n_o. Their normal is that
/// of o + eta i = m, and |dh/di| = eta^2 |i.h|/m^2. [Walter2007, eq. 16 and 17] In double, and by Fresnel's
/// formulas from the thinner side, so that both ways agree where facets are met at grazing angles.
[[nodiscard]] inline float facet_refraction(const Microfacets<float>& facets, float seen, const Imath::V3f& o,
                                            const Imath::V3f& i, float eta) {
  const double e = eta;
  const Imath::V3d m = Imath::V3d(o) + Imath::V3d(i) * e;
  const double upward = std::copysign(1.0, m.z);
  const double cos_o = m.dot(Imath::V3d(o)) * upward;
  const double cos_i = -m.dot(Imath::V3d(i)) * upward;
  if (!(cos_o > 0) || !(cos_i > 0) || m.z == 0) return 0;
  const double m2 = m.length2();
  const auto cos_thin = static_cast<float>((e > 1 ? cos_o : cos_i) / std::sqrt(m2));
  const float transmitted = fresnel_dielectric(std::min(cos_thin, 1.0F), e > 1 ? eta : 1 / eta).transmitted();
  return transmitted * seen * facets.D(Imath::V3f(m)) * static_cast<float>(cos_o * cos_i * e * e / (m2 * m2));
}

}  // namespace abbe
