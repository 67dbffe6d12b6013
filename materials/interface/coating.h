#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/json_values.h"
#include "materials/index/refractive_index.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/interface/thin_film.h"

namespace abbe {

/// Coherent layers on a smooth surface, ordered from the outside inwards: at most `kMaxLayers` of at most
/// `kMaxMaterials` materials. Without layers the surface is bare. Layers of the same material refer to one
/// entry of `materials`.
struct Coating {
  struct Material {
    std::string index_name;
    RefractiveIndex index;
  };
  struct Layer {
    std::uint32_t material;  ///< Index in `materials`.
    double thickness_nm;     ///< Above 0.
  };
  static constexpr std::size_t kMaxMaterials = 16;
  static constexpr std::size_t kMaxLayers = 256;

  std::vector<Material> materials;
  std::vector<Layer> layers;
};

/// Reflectance and transmittance of the coated surface of a medium with index n + ik, at the wavelength in
/// air and the cosine of incidence `cos_i` in [0, 1]. Light arrives from outside or, if `inside` is true,
/// from within the medium, whose k is then ignored. All indices, including that of the medium `outside`, are
/// relative to air. T is the power that enters the far medium, so the layers absorb 1 - R - T.
[[nodiscard]] FresnelPower<double> coated_power(const Coating& coating, double wavelength_nm, double n,
                                                double k, double cos_i, bool inside, double outside = 1);

/// Mueller matrices of the coated surface of `coated_power`, with the same arguments. The matrix of
/// transmission holds for a medium that does not absorb.
[[nodiscard]] InterfaceMueller<double> coated_mueller(const Coating& coating, double wavelength_nm, double n,
                                                      double k, double cos_i, bool inside,
                                                      double outside = 1);

/// Amplitude reflection coefficients of the coated surface of `coated_power`, with the same arguments.
[[nodiscard]] FilmReflection<double> coated_reflection(const Coating& coating, double wavelength_nm, double n,
                                                       double k, double cos_i, bool inside,
                                                       double outside = 1);

/// A coating at the wavelengths of a packet [nm in air], relative to the medium `outside`, or to air if that
/// is nullptr. It refers to the coating, which must outlive it.
class CoatingAt {
 public:
  CoatingAt(const Coating& coating, const SampledSpectrum& wavelengths_nm,
            const RefractiveIndex* outside = nullptr);

  /// Reflectance and transmittance at wavelength sample `lane`, as by `coated_power`. n + ik is relative to
  /// the medium outside.
  [[nodiscard]] FresnelPower<float> power(int lane, float n, float k, float cos_i, bool inside) const;
  /// Mueller matrices of reflection and transmission, with the arguments of `power`.
  [[nodiscard]] InterfaceMueller<float> mueller(int lane, float n, float k, float cos_i, bool inside) const;

 private:
  const Coating& coating_;
  SampledSpectrum wavelengths_nm_;  // in the medium outside
  std::array<SampledSpectrum, Coating::kMaxMaterials> n_;
  std::array<SampledSpectrum, Coating::kMaxMaterials> k_;
};

/// Allowed thickness of a thin film. Thicker layers are not coherent.
inline constexpr Range kFilmThickness{0, 1e5, true, false, "nm"};

}  // namespace abbe
