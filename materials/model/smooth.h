#pragma once

#include <optional>
#include <string>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/index_use.h"
#include "materials/model/opaque.h"

namespace abbe {

/// A Lambertian surface; `reflectance` is its hemispherical reflectance. `SurfaceModel` describes the member
/// functions.
struct DiffuseMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};
/// A smooth interface to a transparent or absorbing medium, optionally under thin films. `SurfaceModel`
/// describes the member functions.
struct DielectricMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};  ///< Thin films; no layers if the surface is bare.
  /// Medium inside that scatters or absorbs in addition to `index`; else empty.
  std::optional<Medium> interior_medium = {};

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] const RefractiveIndex* interior_index() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return interior_medium ? &*interior_medium : nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(index_name, index, coating); }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};
/// Thin films with the same medium on both sides, such as a soap bubble. Light crosses them undeflected.
/// `SurfaceModel` describes the member functions.
struct FilmMaterial {
  Coating layers;

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(layers); }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};
/// A smooth metal, optionally under thin films. `SurfaceModel` describes the member functions.
struct ConductorMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};  ///< Thin films; no layers if the metal is bare.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(index_name, index, coating); }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

}  // namespace abbe
