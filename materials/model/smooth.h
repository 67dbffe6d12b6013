#pragma once

#include <optional>
#include <string>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/index/refractive_index.h"
#include "materials/medium/medium.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

struct DiffuseMaterial {
  SpectralTexture reflectance;

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};
struct DielectricMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};
  std::optional<Medium> filling = {};  ///< Scatters inside.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] const RefractiveIndex* interior() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return filling ? &*filling : nullptr; }
};
struct ConductorMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

}  // namespace abbe
