#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

/// Burley's principled model.
struct PrincipledMaterial {
  SpectralTexture base_color;  ///< In [0, 1].
  Principled look;

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return PrincipledBsdf{base_color(at), &look}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return base_color.textured(); }
};

}  // namespace abbe
