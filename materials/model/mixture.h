#pragma once

#include <memory>
#include <vector>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"
#include "spectral/curve.h"

namespace abbe {

struct Material;

/// Several materials side by side, too fine to be resolved: f = sum_i w_i f_i. No component is a mixture, and
/// light enters none. `SurfaceModel` describes the member functions.
struct MixtureMaterial {
  /// A material with its weight.
  struct Component {
    Curve weight;  ///< In [0, 1]; the sum over the components is at most 1 at every wavelength.
    std::shared_ptr<const Material> material;
  };
  std::vector<Component> components;

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return MixtureBsdf(*this, at); }
  [[nodiscard]] Lobes lobes() const;
  [[nodiscard]] bool needs_coordinates() const;
  [[nodiscard]] bool depends_on_outside() const;
  [[nodiscard]] bool opaque() const;
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  /// Empty, as is `texture_bytes`: the scene lists the components as materials of their own.
  [[nodiscard]] static std::vector<IndexUse> indices() { return {}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

}  // namespace abbe
