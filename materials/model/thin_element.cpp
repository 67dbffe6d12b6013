#include "materials/model/thin_element.h"

#include <cmath>
#include <numbers>

namespace abbe {

Imath::V2d surface_axis(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Bsdf PolariserMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum across = blocked(at.wavelengths_nm);
  return PolariserBsdf{{transmittance(at.wavelengths_nm) * (SampledSpectrum(1) + across) * 0.5F},
                       across,
                       Imath::V2f(surface_axis(angle))};
}

double WavePlateMaterial::retardance(double wavelength_nm) const {
  if (const auto* ideal = std::get_if<Ideal>(&kind)) return ideal->retardance;
  const auto& crystal = std::get<Crystal>(kind);
  return 2 * std::numbers::pi * crystal.birefringence(wavelength_nm) * crystal.thickness /
         (wavelength_nm * 1e-9);
}

// The retardance of plates of high order is many times 2 pi, so it is reduced in double.
Bsdf WavePlateMaterial::bsdf(const SurfaceLookup& at) const {
  return WavePlateBsdf{
      {transmittance(at.wavelengths_nm)},
      SampledSpectrum::map(at.wavelengths_nm,
                           [this](float nm) {
                             return static_cast<float>(std::remainder(retardance(nm), 2 * std::numbers::pi));
                           }),
      Imath::V2f(surface_axis(angle))};
}

Bsdf DepolariserMaterial::bsdf(const SurfaceLookup& at) const {
  return DepolariserBsdf{{transmittance(at.wavelengths_nm)}};
}

}  // namespace abbe
