#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"

namespace abbe {

/// Matter without an interface, such as fog or smoke: light passes the surface as if it were not there.
struct MediumMaterial {
  Medium filling;

  /// That of an interface between like and like.
  [[nodiscard]] static Bsdf bsdf(const SurfaceLookup& /*at*/) {
    return DielectricBsdf{SampledSpectrum(1.0F), false};
  }
  /// Neither: the surface is no event.
  [[nodiscard]] static constexpr Lobes lobes() { return {}; }
  [[nodiscard]] const Medium* medium() const { return &filling; }
};

}  // namespace abbe
