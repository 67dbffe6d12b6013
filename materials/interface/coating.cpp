#include "materials/interface/coating.h"

#include <array>
#include <span>

#include "materials/index/relative_index.h"
#include "materials/interface/thin_film.h"

namespace abbe {
namespace {

// `material(i)` is n and k of material i; these, n, k and the wavelength are relative to what is outside.
template <typename F>
FresnelPower<double> power_of(const Coating& coating, double wavelength_nm, double n, double k, double cos_i,
                              bool inside, F material) {
  std::array<FilmLayer<double>, Coating::kMaxLayers> layers;
  const std::size_t count = coating.layers.size();
  const double n_i = inside ? n : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Coating::Layer& layer = coating.layers[inside ? count - 1 - i : i];
    const Complex<double> index = material(layer.material);
    layers[i] = {index.re / n_i, index.im / n_i, layer.thickness_nm / wavelength_nm * n_i};
  }
  return film_power<double>(cos_i, std::span(layers.data(), count), inside ? 1 / n : n, inside ? 0 : k);
}

}  // namespace

FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n, double k,
                                  double cos_i, bool inside, double outside) {
  if (coating.layers.empty()) {
    if (!inside && k > 0) return fresnel_conductor(cos_i, n / outside, k / outside);
    return fresnel_dielectric(cos_i, inside ? outside / n : n / outside);
  }
  const auto material = [&](std::uint32_t i) {
    const RefractiveIndex& index = coating.materials[i].index;
    return Complex<double>{index.n(wavelength_nm) / outside, index.k(wavelength_nm) / outside};
  };
  return power_of(coating, wavelength_nm / outside, n / outside, k / outside, cos_i, inside, material);
}

CoatingAt::CoatingAt(const Coating& coating, const SampledSpectrum& wavelengths_nm,
                     const RefractiveIndex* outside)
    : coating_(coating), wavelengths_nm_(wavelengths_nm) {
  for (std::size_t i = 0; i < coating.materials.size(); ++i) {
    const RelativeIndex material = relative_index(coating.materials[i].index, outside, wavelengths_nm);
    n_[i] = material.n;
    k_[i] = material.k;
  }
  if (outside != nullptr) wavelengths_nm_ = wavelengths_nm / outside->n(wavelengths_nm);
}

// In double: many layers wear out a float.
FresnelPower<float> CoatingAt::power(int lane, float n, float k, float cos_i, bool inside) const {
  const auto material = [&](std::uint32_t i) { return Complex<double>{n_[i][lane], k_[i][lane]}; };
  const FresnelPower<double> f = power_of(coating_, wavelengths_nm_[lane], n, k, cos_i, inside, material);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {narrow(f.Rs), narrow(f.Rp), narrow(f.Ts), narrow(f.Tp), narrow(f.cos_t)};
}

}  // namespace abbe
