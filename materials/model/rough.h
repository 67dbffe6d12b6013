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

/// A rough dielectric interface; alpha_x of the facets is the roughness along u, alpha_y that perpendicular
/// to it. `SurfaceModel` describes the member functions. If both alphas are below `kMinAlpha`, the scene uses
/// a `DielectricMaterial` instead. A relative index within 1e-3 of 1 is replaced by the nearest one that
/// differs by 1e-3.
class RoughDielectricMaterial {
 public:
  /// Tabulates multiple scattering in air, which takes some tens of milliseconds.
  RoughDielectricMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets,
                          std::optional<Medium> interior_medium = {});

  /// Tabulates multiple scattering also in a medium of that index, unless an existing table covers it. In
  /// other media `bsdf` uses the table of the nearest relative index. Not thread-safe.
  void tabulate_in(const RefractiveIndex& medium);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] const RefractiveIndex* interior_index() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return interior_medium ? &*interior_medium : nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }

  std::string index_name;
  RefractiveIndex index;
  /// Medium inside that scatters or absorbs in addition to `index`; else empty.
  std::optional<Medium> interior_medium;
  std::shared_ptr<const RoughInterface> surface;                         ///< Tables in air.
  std::vector<std::shared_ptr<const RoughInterface>> surfaces_in_media;  ///< Tables added by `tabulate_in`.

 private:
  [[nodiscard]] const RoughInterface& nearest_surface(float low_n, float high_n) const;
};

/// A rough conductor; alpha_x of the facets is the roughness along u, alpha_y that perpendicular to it.
/// `SurfaceModel` describes the member functions.
class RoughConductorMaterial {
 public:
  RoughConductorMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }

  std::string index_name;
  RefractiveIndex index;
  Curve mean_reflectance;  ///< Diffuse reflectance of the smooth metal in air.
  std::shared_ptr<const RoughMetal> surface;
};

}  // namespace abbe
