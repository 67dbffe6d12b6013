#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "materials/index/refractive_index.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/interface/thin_film.h"

namespace abbe {

/// Coherent layers on a smooth surface, ordered from the outside inwards. Without layers the surface is bare.
/// Layers of the same material refer to one entry of `materials`.
struct Coating {
  struct Material {
    std::string index_name;
    RefractiveIndex index;
  };
  /// A layer of `materials[material]`.
  struct Layer {
    std::uint32_t material;
    double thickness_nm;
  };
  static constexpr std::size_t kMaxMaterials = 16;
  static constexpr std::size_t kMaxLayers = 256;

  std::vector<Material> materials;
  std::vector<Layer> layers;
};

/// Reflectance and transmittance of the coated surface of a medium with index n + ik. Light arrives from
/// outside or, if `inside` is true, from within a medium of real index n. All indices, including that of the
/// medium `outside`, are relative to air.
[[nodiscard]] FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n,
                                                double k, double cos_i, bool inside, double outside = 1);

/// Mueller matrices of the same surface. The matrix of transmission holds for a medium that does not absorb.
[[nodiscard]] InterfaceMueller<double> coated_mueller(const Coating& coating, double wavelength_nm, double n,
                                                      double k, double cos_i, bool inside,
                                                      double outside = 1);

/// Amplitude reflection coefficients of the same surface, with the signs of `FresnelAmplitudes`.
[[nodiscard]] FilmReflection<double> coated_reflection(const Coating& coating, double wavelength_nm, double n,
                                                       double k, double cos_i, bool inside,
                                                       double outside = 1);

/// A coating at the wavelengths of a packet. The constructor looks up its indices once for all wavelengths,
/// relative to the medium `outside`, or to air if that is nullptr.
class CoatingAt {
 public:
  CoatingAt(const Coating& coating, const SampledSpectrum& wavelengths_nm,
            const RefractiveIndex* outside = nullptr);

  /// Reflectance and transmittance at one wavelength for a medium of index n + ik, relative to the medium
  /// outside.
  [[nodiscard]] FresnelPower<float> power(int lane, float n, float k, float cos_i, bool inside) const;
  /// Mueller matrices of reflection and transmission at one wavelength.
  [[nodiscard]] InterfaceMueller<float> mueller(int lane, float n, float k, float cos_i, bool inside) const;

 private:
  const Coating& coating_;
  SampledSpectrum wavelengths_nm_;  // in the medium outside
  std::array<SampledSpectrum, Coating::kMaxMaterials> n_;
  std::array<SampledSpectrum, Coating::kMaxMaterials> k_;
};

}  // namespace abbe
