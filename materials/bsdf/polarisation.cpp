#include "materials/bsdf/polarisation.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/facet_event.h"
#include "materials/index/relative_index.h"
#include "materials/interface/fresnel_mueller.h"
#include "materials/interface/thin_element.h"
#include "materials/interface/thin_sheet.h"

namespace abbe {
namespace {

using Elements = MuellerElements<float>;

struct MuellerOf {
  const Imath::V3f& wo;
  const Imath::V3f& wi;
  bool delta;
  std::optional<int> single_lane;  // the only wavelength sample needed, if given
  float cos_i = std::min(std::abs(wo.z), 1.0F);
  bool through = wo.z * wi.z < 0;

  using Matrix = std::optional<MuellerMatrix>;

  // Smooth surfaces: the plane of incidence contains the surface normal.

  Matrix operator()(const DielectricBsdf& glass) const {
    const auto at = [&](int lane) {
      const float eta = glass.eta(wo, lane);
      return through ? refraction_mueller(cos_i, eta) : reflection_mueller(cos_i, eta, 0.0F);
    };
    return glass.dispersive ? smooth(at) : uniform(at(0));
  }
  Matrix operator()(const ConductorBsdf& metal) const {
    return smooth([&](int lane) { return reflection_mueller(cos_i, metal.n[lane], metal.k[lane]); });
  }
  Matrix operator()(const CoatedDielectricBsdf& glass) const {
    const SampledSpectrum n = relative_index(*glass.index, glass.outside, glass.wavelengths_nm).n;
    const CoatingAt coating(*glass.coating, glass.wavelengths_nm, glass.outside);
    return smooth([&](int lane) { return taken(coating.mueller(lane, n[lane], 0, cos_i, wo.z < 0)); });
  }
  Matrix operator()(const CoatedConductorBsdf& metal) const {
    const RelativeIndex at = relative_index(*metal.index, metal.outside, metal.wavelengths_nm);
    const CoatingAt coating(*metal.coating, metal.wavelengths_nm, metal.outside);
    return smooth(
        [&](int lane) { return coating.mueller(lane, at.n[lane], at.k[lane], cos_i, false).reflected; });
  }
  Matrix operator()(const ThinGlassBsdf& pane) const {
    return smooth([&](int lane) { return taken(sheet_mueller(cos_i, pane.n[lane], pane.depth[lane])); });
  }
  Matrix operator()(const CoatedDiffuseBsdf& paint) const {
    if (!delta) return std::nullopt;
    const auto at = [&](int lane) { return reflection_mueller(cos_i, paint.n[lane], 0.0F); };
    return paint.dispersive ? smooth(at) : uniform(at(0));
  }
  Matrix operator()(const MirrorBsdf& /*mirror*/) const { return uniform(kIdealMirror<float>); }
  Matrix operator()(const SchlickBsdf& /*mirror*/) const { return uniform(kIdealMirror<float>); }

  // Thin elements have their own axes.

  Matrix operator()(const PolariserBsdf& sheet) const {
    return mueller_of_lanes(projected_axis(sheet.axis, wo),
                            [&](int lane) { return polariser_mueller(sheet.blocked[lane]); });
  }
  Matrix operator()(const WavePlateBsdf& plate) const {
    return mueller_of_lanes(projected_axis(plate.axis, wo),
                            [&](int lane) { return wave_plate_mueller(plate.retardance[lane]); });
  }
  Matrix operator()(const DepolariserBsdf& /*sheet*/) const { return std::nullopt; }

  // Rough surfaces: the plane of incidence of a facet contains both directions. Multiply scattered light is
  // assumed unpolarised.

  Matrix operator()(const RoughConductorBsdf& metal) const {
    const RelativeIndex at = relative_index(*metal.index, metal.outside, metal.wavelengths_nm);
    const float cos = mirror_cosine(wo, wi);
    return rough(metal, [&](int lane) { return reflection_mueller(cos, at.n[lane], at.k[lane]); });
  }
  Matrix operator()(const RoughDielectricBsdf& glass) const {
    return rough(glass, [&](int lane) {
      const float eta = wo.z < 0 ? 1 / glass.n[lane] : glass.n[lane];
      if (!through) return reflection_mueller(mirror_cosine(wo, wi), eta, 0.0F);
      const RefractingFacet facet(from_side_of(wo, wo), from_side_of(wo, wi), eta);
      return facet.exists() ? refraction_mueller(facet.cos_rarer_side(eta), eta_from_rarer_side(eta))
                            : Elements{};
    });
  }

  Matrix operator()(const MixtureBsdf& mixture) const { return mixture.mueller(wo, wi, delta); }

  // All other models depolarise. A model with a delta lobe needs an overload.
  template <typename Other>
  Matrix operator()(const Other&) const {
    static_assert(!Other::kDelta);
    return std::nullopt;
  }

  template <typename F>
  [[nodiscard]] MuellerMatrix smooth(F elements) const {
    if (single_lane) return uniform(elements(*single_lane));
    return mueller_of_lanes(across(wo, {0, 0, 1}), elements);
  }
  [[nodiscard]] MuellerMatrix uniform(const Elements& m) const {
    return {across(wo, {0, 0, 1}), SampledSpectrum(m.d), SampledSpectrum(m.p), SampledSpectrum(m.c),
            SampledSpectrum(m.s)};
  }
  [[nodiscard]] Elements taken(const InterfaceMueller<float>& m) const {
    return through ? m.through : m.reflected;
  }
  template <typename Rough, typename F>
  [[nodiscard]] MuellerMatrix rough(const Rough& surface, F elements) const {
    MuellerMatrix m = mueller_of_lanes(across(wo, wi), elements);
    const SampledSpectrum fraction = surface.single_fraction(wo, wi);
    for (SampledSpectrum* element : {&m.d, &m.p, &m.c, &m.s}) *element *= fraction;
    return m;
  }
};

}  // namespace

std::optional<MuellerMatrix> mueller(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                     std::optional<int> lane) {
  return visit_model(MuellerOf{wo, wi, delta, lane}, bsdf);
}

}  // namespace abbe
