#pragma once

#include <optional>
#include <string>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/index_use.h"
#include "materials/model/opaque.h"

namespace abbe {

/// A Lambertian surface.
struct DiffuseMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};
/// A smooth interface to a transparent or absorbing medium, optionally under thin films.
struct DielectricMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};
  std::optional<Medium> interior_medium = {};  ///< Medium inside; empty if it does not scatter.

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
/// A smooth metal, optionally under thin films.
struct ConductorMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};

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
