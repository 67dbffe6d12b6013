#include "materials/smooth_power.h"

#include <variant>

#include "materials/interface/fresnel_mueller.h"
#include "materials/interface/thin_element.h"
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
  Power operator()(const FilmMaterial& film) const {
    return coated_power(film.layers, at.wavelength_nm, at.outside, 0, at.cos_i, at.inside, at.outside);
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
  Power operator()(const PolariserMaterial& sheet) const {
    return straight_on(sheet.mean_transmittance(at.wavelength_nm));
  }
  Power operator()(const WavePlateMaterial& plate) const {
    return straight_on(plate.transmittance(at.wavelength_nm));
  }
  Power operator()(const DepolariserMaterial& sheet) const {
    return straight_on(sheet.transmittance(at.wavelength_nm));
  }
  // The boundary of a medium without an interface transmits all light.
  Power operator()(const MediumMaterial&) const { return straight_on(1); }
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

  [[nodiscard]] Power straight_on(double T) const { return {{0, 0, T, T, at.cos_i}}; }
  // Opaque surfaces transmit nothing.
  static Power reflected(const FresnelPower<double>& power) { return {{power.Rs, power.Rp, 0, 0, 0}}; }
};

constexpr MuellerElements<double> kUnpolarised{0, 0, 0, 0};

struct SmoothMuellerOf {
  const SmoothLookup& at;

  SmoothMueller operator()(const DielectricMaterial& glass) const {
    return {coated_mueller(glass.coating, at.wavelength_nm, glass.index.n(at.wavelength_nm), 0, at.cos_i,
                           at.inside, at.outside)};
  }
  SmoothMueller operator()(const FilmMaterial& film) const {
    return {coated_mueller(film.layers, at.wavelength_nm, at.outside, 0, at.cos_i, at.inside, at.outside)};
  }
  SmoothMueller operator()(const ConductorMaterial& metal) const {
    return {coated_mueller(metal.coating, at.wavelength_nm, metal.index.n(at.wavelength_nm),
                           metal.index.k(at.wavelength_nm), at.cos_i, false, at.outside)};
  }
  SmoothMueller operator()(const MirrorMaterial& /*mirror*/) const { return {{kIdealMirror<double>, {}}}; }
  SmoothMueller operator()(const SchlickMaterial& /*mirror*/) const { return {{kIdealMirror<double>, {}}}; }
  SmoothMueller operator()(const ThinGlassMaterial& pane) const {
    return {sheet_mueller(at.cos_i, pane.index.n(at.wavelength_nm) / at.outside,
                          pane.index.absorption_per_m(at.wavelength_nm) * pane.thickness)};
  }
  SmoothMueller operator()(const CoatedDiffuseMaterial& paint) const {
    return {{reflection_mueller(at.cos_i, paint.index.n(at.wavelength_nm) / at.outside, 0.0), {}}};
  }
  SmoothMueller operator()(const PolariserMaterial& sheet) const {
    return {{{}, polariser_mueller(sheet.blocked(at.wavelength_nm))}, surface_axis(sheet.angle)};
  }
  SmoothMueller operator()(const WavePlateMaterial& plate) const {
    return {{{}, wave_plate_mueller(plate.retardance(at.wavelength_nm))}, surface_axis(plate.angle)};
  }
  SmoothMueller operator()(const DepolariserMaterial& /*sheet*/) const { return {{{}, kUnpolarised}}; }
  SmoothMueller operator()(const MediumMaterial& /*boundary*/) const { return {}; }
  // Mean over the components, weighted by the power that each reflects or transmits.
  SmoothMueller operator()(const MixtureMaterial& mixture) const {
    MuellerMean<double> reflected;
    MuellerMean<double> through;
    for (const MixtureMaterial::Component& component : mixture.components) {
      const auto power = smooth_power(*component.material, at);
      if (!power) continue;
      const double weight = component.weight(at.wavelength_nm);
      const InterfaceMueller<double> part = smooth_mueller(*component.material, at)->matrices;
      reflected.add(weight * power->R(), part.reflected);
      through.add(weight * power->transmitted(), part.through);
    }
    return {{reflected.mean(), through.mean()}};
  }
  template <typename Spread>
  SmoothMueller operator()(const Spread&) const {
    static_assert(!Spread::lobes().delta);
    return {};
  }
};

}  // namespace

std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at) {
  if (!smooth_power(material, at)) return std::nullopt;
  return std::visit(SmoothMuellerOf{at}, material.model);
}

std::optional<FresnelPower<double>> smooth_power(const Material& material, const SmoothLookup& at) {
  return std::visit(PowerOf{at}, material.model);
}

}  // namespace abbe
