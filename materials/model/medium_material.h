#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"

namespace abbe {

/// Matter without an interface, such as fog or smoke: light passes the surface as if it were not there.
struct MediumMaterial {
  Medium filling;

  /// Scatters as an interface between like and like does: not at all.
  [[nodiscard]] static Bsdf bsdf(const SurfaceLookup& /*at*/) {
    return DielectricBsdf{SampledSpectrum(1.0F), false};
  }
  /// The surface is no event, so light leaves it in no lobe.
  [[nodiscard]] static constexpr Lobes lobes() { return {}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return false; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior() { return nullptr; }
  [[nodiscard]] const Medium* medium() const { return &filling; }
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

}  // namespace abbe
