#include "materials/smooth_power.h"

#include <variant>

#include "materials/interface/thin_sheet.h"

namespace abbe {
namespace {

using Power = std::optional<FresnelPower<double>>;

std::optional<double> reflectance_at(const OpaqueSurface& surface, const SmoothLookup& at) {
  if (!surface.reflectance.textured()) return surface.reflectance.curve()(at.wavelength_nm);
  if (!at.coordinates) return std::nullopt;
  const SampledSpectrum wavelengths_nm(static_cast<float>(at.wavelength_nm));
  return surface.reflectance({wavelengths_nm, *at.coordinates})[0];
}

struct PowerOf {
  const SmoothLookup& at;

  Power operator()(const DielectricMaterial& glass) const {
    return coated_power(glass.coating, at.wavelength_nm, glass.index.n(at.wavelength_nm), 0, at.cos_i,
                        at.inside, at.outside);
  }
  Power operator()(const ConductorMaterial& metal) const {
    const auto power = coated_power(metal.coating, at.wavelength_nm, metal.index.n(at.wavelength_nm),
                                    metal.index.k(at.wavelength_nm), at.cos_i, false, at.outside);
    return reflected(power);
  }
  Power operator()(const MirrorMaterial& mirror) const {
    const auto r = reflectance_at(mirror, at);
    return r ? Power({*r, *r, 0, 0, 0}) : std::nullopt;
  }
  Power operator()(const SchlickMaterial& mirror) const {
    const auto r0 = reflectance_at(mirror, at);
    if (!r0) return std::nullopt;
    const double r = schlick(at.cos_i, *r0);
    return {{r, r, 0, 0, 0}};
  }
  Power operator()(const ThinGlassMaterial& pane) const {
    return sheet_power(at.cos_i, pane.index.n(at.wavelength_nm) / at.outside,
                       pane.index.absorption_per_m(at.wavelength_nm) * pane.thickness);
  }
  Power operator()(const CoatedDiffuseMaterial& paint) const {
    return reflected(fresnel_dielectric(at.cos_i, paint.index.n(at.wavelength_nm) / at.outside));
  }
  // Matter that begins without an interface.
  Power operator()(const MediumMaterial&) const { return {{0, 0, 1, 1, at.cos_i}}; }
  Power operator()(const MixtureMaterial& mixture) const {
    Power sum;
    for (const MixtureMaterial::Component& component : mixture.components) {
      const Power part = smooth_power(*component.material, at);
      if (!part) continue;
      const double weight = component.weight(at.wavelength_nm);
      const FresnelPower<double> so_far = sum.value_or(FresnelPower<double>{0, 0, 0, 0, 0});
      sum = {{so_far.Rs + weight * part->Rs, so_far.Rp + weight * part->Rp, so_far.Ts + weight * part->Ts,
              so_far.Tp + weight * part->Tp, at.cos_i}};
    }
    return sum;
  }
  template <typename Spread>
  Power operator()(const Spread&) const {
    static_assert(!Spread::lobes().delta);
    return std::nullopt;
  }

  // Of an opaque surface.
  static Power reflected(const FresnelPower<double>& power) { return {{power.Rs, power.Rp, 0, 0, 0}}; }
};

}  // namespace

std::optional<FresnelPower<double>> smooth_power(const Material& material, const SmoothLookup& at) {
  return std::visit(PowerOf{at}, material.model);
}

}  // namespace abbe
