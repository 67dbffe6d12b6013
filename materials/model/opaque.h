#pragma once

#include <cstddef>
#include <vector>

#include "materials/medium/medium.h"
#include "materials/model/index_use.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

/// The part common to all opaque surfaces without an index: a texture of reflectance. `SurfaceModel`
/// describes the member functions.
struct OpaqueSurface {
  SpectralTexture reflectance;  ///< In [0, 1]; the model defines for which light.

  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return false; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] std::size_t texture_bytes() const { return reflectance.memory_bytes(); }
};

}  // namespace abbe
