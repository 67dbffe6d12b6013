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

template <MirrorKind Kind>
std::optional<FresnelPower<double>> IdealMirrorMaterial<Kind>::smooth_power(const SmoothLookup& at) const {
  const auto reflectance = reflectance_at(*this, at);
  if (!reflectance) return std::nullopt;
  const double r = Kind == MirrorKind::ideal ? *reflectance : schlick(at.cos_i, *reflectance);
  return FresnelPower<double>{r, r, 0, 0, 0};
}

template struct IdealMirrorMaterial<MirrorKind::ideal>;
template struct IdealMirrorMaterial<MirrorKind::schlick>;

}  // namespace abbe
