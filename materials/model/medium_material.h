#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"

namespace abbe {

/// The boundary of a medium without an interface, such as fog or smoke. Light passes it unchanged.
/// `SurfaceModel` describes the member functions.
struct MediumMaterial {
  Medium interior_medium;

  /// The interface between equal media, which changes nothing.
  [[nodiscard]] static Bsdf bsdf(const SurfaceLookup& /*at*/) {
    return DielectricBsdf{SampledSpectrum(1.0F), false};
  }
  /// The surface is no scattering event, so it has no lobes.
  [[nodiscard]] static constexpr Lobes lobes() { return {}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return false; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] const Medium* medium() const { return &interior_medium; }
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

}  // namespace abbe
