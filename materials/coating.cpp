#include "materials/coating.h"

#include <array>
#include <span>

#include "materials/interface/thin_film.h"

namespace abbe {
namespace {

// `matter(i)` is n and k of matter i.
template <typename F>
FresnelPower<double> power_of(const Coating& coating, double wavelength_nm, double n, double k, double cos_i,
                              bool inside, F matter) {
  std::array<FilmLayer<double>, Coating::kMaxLayers> layers;
  const std::size_t count = coating.layers.size();
  const double n_i = inside ? n : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Coating::Layer& layer = coating.layers[inside ? count - 1 - i : i];
    const Complex<double> index = matter(layer.matter);
    layers[i] = {index.re / n_i, index.im / n_i, layer.thickness_nm / wavelength_nm * n_i};
  }
  return film_power<double>(cos_i, std::span(layers.data(), count), inside ? 1 / n : n, inside ? 0 : k);
}

}  // namespace

FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n, double k,
                                  double cos_i, bool inside) {
  if (coating.layers.empty()) {
    if (!inside && k > 0) return fresnel_conductor(cos_i, n, k);
    return fresnel_dielectric(cos_i, inside ? 1 / n : n);
  }
  return power_of(coating, wavelength_nm, n, k, cos_i, inside, [&](std::uint32_t i) {
    const RefractiveIndex& index = coating.matters[i].index;
    return Complex<double>{index.n(wavelength_nm), index.k(wavelength_nm)};
  });
}

CoatingAt::CoatingAt(const Coating& coating, const SampledSpectrum& wavelengths_nm)
    : coating_(coating), wavelengths_nm_(wavelengths_nm) {
  for (std::size_t i = 0; i < coating.matters.size(); ++i) {
    n_[i] = coating.matters[i].index.n(wavelengths_nm);
    k_[i] = coating.matters[i].index.k(wavelengths_nm);
  }
}

// In double: many layers wear out a float.
FresnelPower<float> CoatingAt::power(int lane, float n, float k, float cos_i, bool inside) const {
  const auto matter = [&](std::uint32_t i) { return Complex<double>{n_[i][lane], k_[i][lane]}; };
  const FresnelPower<double> f = power_of(coating_, wavelengths_nm_[lane], n, k, cos_i, inside, matter);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {narrow(f.Rs), narrow(f.Rp), narrow(f.Ts), narrow(f.Tp), narrow(f.cos_t)};
}

}  // namespace abbe
