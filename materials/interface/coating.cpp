#include "materials/interface/coating.h"

#include <array>
#include <span>

#include "materials/index/relative_index.h"

namespace abbe {
namespace {

// Evaluates a quantity of the layers from one side. `material(i)` is n + ik of material i. It, n, k
// and the wavelength are relative to the medium outside.
template <typename Material, typename Evaluate>
auto eval_films(const Coating& coating, double wavelength_nm, double n, double k, double cos_i, bool inside,
                Material material, Evaluate evaluate) {
  std::array<FilmLayer<double>, Coating::kMaxLayers> layers;
  const std::size_t count = coating.layers.size();
  const double n_i = inside ? n : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Coating::Layer& layer = coating.layers[inside ? count - 1 - i : i];
    const Complex<double> index = material(layer.material);
    layers[i] = {index.re / n_i, index.im / n_i, layer.thickness_nm / wavelength_nm * n_i};
  }
  return evaluate(cos_i, std::span<const FilmLayer<double>>(layers.data(), count), inside ? 1 / n : n,
                  inside ? 0 : k);
}

// Evaluates a quantity with all indices relative to air.
template <typename Evaluate>
auto eval_coating(const Coating& coating, double wavelength_nm, double n, double k, double cos_i, bool inside,
                  double outside, Evaluate evaluate) {
  const auto material = [&](std::uint32_t i) {
    const RefractiveIndex& index = coating.materials[i].index;
    return Complex<double>{index.n(wavelength_nm) / outside, index.k(wavelength_nm) / outside};
  };
  return eval_films(coating, wavelength_nm / outside, n / outside, k / outside, cos_i, inside, material,
                    evaluate);
}

constexpr auto kPower = [](auto... films) { return film_power<double>(films...); };
constexpr auto kMueller = [](auto... films) { return film_mueller<double>(films...); };
constexpr auto kReflection = [](auto... films) { return film_reflection<double>(films...); };

float narrow(double x) {
  return static_cast<float>(x);
}
MuellerElements<float> narrow(const MuellerElements<double>& m) {
  return {narrow(m.d), narrow(m.p), narrow(m.c), narrow(m.s)};
}

}  // namespace

FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n, double k,
                                  double cos_i, bool inside, double outside) {
  if (coating.layers.empty()) {
    if (!inside && k > 0) return fresnel_conductor(cos_i, n / outside, k / outside);
    return fresnel_dielectric(cos_i, inside ? outside / n : n / outside);
  }
  return eval_coating(coating, wavelength_nm, n, k, cos_i, inside, outside, kPower);
}

InterfaceMueller<double> coated_mueller(const Coating& coating, double wavelength_nm, double n, double k,
                                        double cos_i, bool inside, double outside) {
  if (coating.layers.empty()) {
    const double eta = inside ? outside / n : n / outside;
    return {reflection_mueller(cos_i, eta, inside ? 0.0 : k / outside), refraction_mueller(cos_i, eta)};
  }
  return eval_coating(coating, wavelength_nm, n, k, cos_i, inside, outside, kMueller);
}

FilmReflection<double> coated_reflection(const Coating& coating, double wavelength_nm, double n, double k,
                                         double cos_i, bool inside, double outside) {
  return eval_coating(coating, wavelength_nm, n, k, cos_i, inside, outside, kReflection);
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

// Rounding errors of many layers are too large in float, so the computation is in double.
FresnelPower<float> CoatingAt::power(int lane, float n, float k, float cos_i, bool inside) const {
  const auto material = [&](std::uint32_t i) { return Complex<double>{n_[i][lane], k_[i][lane]}; };
  const FresnelPower<double> f =
      eval_films(coating_, wavelengths_nm_[lane], n, k, cos_i, inside, material, kPower);
  return {narrow(f.Rs), narrow(f.Rp), narrow(f.Ts), narrow(f.Tp), narrow(f.cos_t)};
}

InterfaceMueller<float> CoatingAt::mueller(int lane, float n, float k, float cos_i, bool inside) const {
  const auto material = [&](std::uint32_t i) { return Complex<double>{n_[i][lane], k_[i][lane]}; };
  const InterfaceMueller<double> m =
      eval_films(coating_, wavelengths_nm_[lane], n, k, cos_i, inside, material, kMueller);
  return {narrow(m.reflected), narrow(m.through)};
}

}  // namespace abbe
