#include "materials/bsdf/mirror.h"

namespace abbe {
namespace {

std::optional<double> reflectance_at(const OpaqueSurface& mirror, const SmoothLookup& at) {
  if (!mirror.reflectance.textured()) return mirror.reflectance.curve()(at.wavelength_nm);
  if (!at.coordinates) return std::nullopt;
  const SampledSpectrum wavelengths_nm(static_cast<float>(at.wavelength_nm));
  return mirror.reflectance({wavelengths_nm, *at.coordinates})[0];
}

}  // namespace

std::optional<FresnelPower<double>> MirrorMaterial::smooth_power(const SmoothLookup& at) const {
  const auto r = reflectance_at(*this, at);
  if (!r) return std::nullopt;
  return FresnelPower<double>{*r, *r, 0, 0, 0};
}

SmoothMueller MirrorMaterial::smooth_mueller(const SmoothLookup& /*at*/) const {
  return {{kIdealMirror<double>, {}}};
}

std::optional<FresnelPower<double>> SchlickMaterial::smooth_power(const SmoothLookup& at) const {
  const auto r0 = reflectance_at(*this, at);
  if (!r0) return std::nullopt;
  const double r = schlick(at.cos_i, *r0);
  return FresnelPower<double>{r, r, 0, 0, 0};
}

SmoothMueller SchlickMaterial::smooth_mueller(const SmoothLookup& /*at*/) const {
  return {{kIdealMirror<double>, {}}};
}

}  // namespace abbe
