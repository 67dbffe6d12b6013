#pragma once

#include <string>
#include <variant>

#include "materials/bsdf/bsdf.h"
#include "materials/index/refractive_index.h"

namespace abbe {

struct DiffuseMaterial {
  Curve reflectance;  ///< In [0, 1].
};
struct DielectricMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};
};
struct ConductorMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};
};

/// What a surface is made of, over all wavelengths.
struct Material {
  std::string name;
  std::variant<DiffuseMaterial, DielectricMaterial, ConductorMaterial> model;
};

/// The scattering of `material` at the wavelengths of a packet, against air outside. It may refer to the
/// material, which must outlive it.
[[nodiscard]] Bsdf make_bsdf(const Material& material, const SampledSpectrum& wavelengths_nm);

/// Only delta scattering: light connections to it are pointless.
[[nodiscard]] bool is_specular(const Material& material);
/// Sends different wavelengths different ways.
[[nodiscard]] bool is_dispersive(const Material& material);
/// The index of the matter inside a closed surface of this material, or nullptr when light does not enter it.
[[nodiscard]] const RefractiveIndex* interior(const Material& material);

}  // namespace abbe
