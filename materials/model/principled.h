#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/opaque.h"

namespace abbe {

/// Burley's principled model; `reflectance` is its base colour. `SurfaceModel` describes the member
/// functions.
struct PrincipledMaterial : OpaqueSurface {
  Principled principled;

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const {
    return PrincipledBsdf{reflectance(at), &principled};
  }
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe
