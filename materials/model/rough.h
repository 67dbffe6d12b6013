#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"

namespace abbe {

/// Rough interface to matter; slopes along u and across it. A surface of both alphas
/// below `kLeastAlpha` is a `DielectricMaterial`. Its matter differs from air by 1e-3 or more: an index
/// closer to 1 is taken as that far away.
class RoughDielectricMaterial {
 public:
  /// Tabulates multiple scattering in air, within some tens of ms.
  RoughDielectricMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets,
                          std::optional<Medium> filling = {});

  /// Tabulates multiple scattering in a medium of that index too, unless a table holds for it. A medium for
  /// which this was not called takes the table of the nearest relative index.
  void tabulate_in(const RefractiveIndex& medium);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] const RefractiveIndex* interior() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return filling ? &*filling : nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }

  std::string index_name;
  RefractiveIndex index;
  std::optional<Medium> filling;                  ///< Scatters inside.
  std::shared_ptr<const RoughInterface> surface;  ///< In air.
  std::vector<std::shared_ptr<const RoughInterface>> surfaces_in_media;

 private:
  [[nodiscard]] const RoughInterface& nearest_surface(float low_n, float high_n) const;
};

/// Rough conductor, in the same way.
class RoughConductorMaterial {
 public:
  RoughConductorMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }

  std::string index_name;
  RefractiveIndex index;
  Curve mean_reflectance;  ///< In air, by `diffuse_reflectance`.
  std::shared_ptr<const RoughMetal> surface;
};

}  // namespace abbe
