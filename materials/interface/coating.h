#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "materials/index/refractive_index.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/interface/thin_film.h"

namespace abbe {

/// Coherent layers on a smooth surface, from the outside inwards; none of them is the bare surface. Layers of
/// one material share it.
struct Coating {
  struct Material {
    std::string index_name;
    RefractiveIndex index;
  };
  struct Layer {
    std::uint32_t material;
    double thickness_nm;
  };
  static constexpr std::size_t kMaxMaterials = 16;
  static constexpr std::size_t kMaxLayers = 256;

  std::vector<Material> materials;
  std::vector<Layer> layers;
};

/// Reflectance and transmittance of the surface of matter of index n + ik under `coating`, for light from
/// outside, or, when `inside`, from within matter of real index n. All indices are relative to air, that of
/// the matter `outside` too.
[[nodiscard]] FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n,
                                                double k, double cos_i, bool inside, double outside = 1);

/// What the same surface does to polarisation; light is let through to clear matter.
[[nodiscard]] MuellerBothWays<double> coated_mueller(const Coating& coating, double wavelength_nm, double n,
                                                     double k, double cos_i, bool inside, double outside = 1);

/// Its amplitudes of reflection, with the signs of `FresnelAmplitudes`.
[[nodiscard]] FilmReflection<double> coated_reflection(const Coating& coating, double wavelength_nm, double n,
                                                       double k, double cos_i, bool inside,
                                                       double outside = 1);

/// A coating at the lanes of a packet: its indices are looked up once for all of them, relative to the matter
/// `outside`, air if nullptr.
class CoatingAt {
 public:
  CoatingAt(const Coating& coating, const SampledSpectrum& wavelengths_nm,
            const RefractiveIndex* outside = nullptr);

  /// Reflectance and transmittance at one lane of matter of index n + ik, relative to what is outside.
  [[nodiscard]] FresnelPower<float> power(int lane, float n, float k, float cos_i, bool inside) const;
  /// What the surface does to polarisation at one lane.
  [[nodiscard]] MuellerBothWays<float> mueller(int lane, float n, float k, float cos_i, bool inside) const;

 private:
  const Coating& coating_;
  SampledSpectrum wavelengths_nm_;  // as they are outside
  std::array<SampledSpectrum, Coating::kMaxMaterials> n_;
  std::array<SampledSpectrum, Coating::kMaxMaterials> k_;
};

}  // namespace abbe
