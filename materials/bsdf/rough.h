#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "materials/bsdf/energy_compensation.h"
#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/refractive_index.h"
#include "materials/index/relative_index.h"
#include "materials/interface/microfacet.h"
#include "materials/medium/medium.h"

namespace abbe {

/// Reflecting microfacets with their table of lost energy, computed once for all wavelengths.
struct RoughMetal {
  explicit RoughMetal(const Microfacets<float>& facets);

  Microfacets<float> facets;
  EnergyCompensation lost;
};

/// Microfacets between two media, with tables of lost energy for inner indices relative to the outer one in
/// [low_n, high_n].
///
/// Energies are tabulated at an odd number of indices. From one even-numbered index to the next, they are
/// quadratic in the coordinate x = sign(n - 1) sqrt(|n - 1|). Near n = 1, where energies change fast, the
/// critical angle is proportional to x. They have a kink at n = 1, so a range that contains 1 is divided
/// there.
struct RoughInterface {
  static constexpr std::size_t kMaxIndices = 17;  ///< Largest number of tabulated indices.

  RoughInterface(const Microfacets<float>& facets, float low_n, float high_n);

  /// The coordinate x of a relative index n.
  [[nodiscard]] static float coordinate(float n) { return std::copysign(std::sqrt(std::abs(n - 1)), n - 1); }
  /// Largest distance by which the relative indices [low, high] exceed [low_n, high_n]; 0 if they do not.
  [[nodiscard]] float distance_to(float low, float high) const {
    return std::max({low_n - low, high - high_n, 0.0F});
  }
  /// Index in `coordinates` of the tables that sample multiple scattering.
  [[nodiscard]] std::size_t sampling_index() const { return coordinates.size() / 2; }

  Microfacets<float> facets;
  float low_n, high_n;
  std::vector<float> coordinates;  ///< Coordinates of the tabulated indices, ascending; an odd number.
  /// Lost energy for light from outside (first) and from inside (second), for each of `coordinates`.
  std::array<std::vector<EnergyCompensation>, 2> lost;
  float inside_probability;  ///< Fraction of multiple scattering to the inside, at `sampling_index`.
};

/// A rough conductor, opaque, reflecting on both sides and reciprocal. It refers to the material, which must
/// outlive it, and holds the wavelengths of the packet. Microfacets reflect [Walter2007, eq. 20] with
/// height-correlated masking [Heitz2014, eq. 99]. Multiple scattering [Kulla2017] is coloured by the
/// conductor's diffuse reflectance.
struct RoughConductorBsdf {
  static constexpr bool kGlossy = true;

  SampledSpectrum wavelengths_nm;    ///< In standard air.
  SampledSpectrum mean_reflectance;  ///< `diffuse_reflectance` relative to the outside.
  const RefractiveIndex* index;      ///< Complex index of the conductor.
  const RefractiveIndex* outside;    ///< Index outside; nullptr is air.
  const RoughMetal* surface;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
  /// Fraction of the light from wo to wi that a single facet has scattered, at each wavelength.
  [[nodiscard]] SampledSpectrum single_fraction(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

/// A rough dielectric interface with its normal towards the outside. The inside index relative to the outside
/// differs from 1 by at least 1e-3. Each wavelength refracts at its own facets [Walter2007, eq. 21], so all
/// wavelengths may continue with the hero. Masking is height-correlated in reflection and independent on the
/// two sides in transmission.
///
/// Multiply scattered light leaves on either side independently of the side of incidence. This split
/// preserves reciprocity (of radiance over n^2) and conserves energy together. Single transmission is still
/// masked towards n = 1, so the surface does not vanish in that limit as a real one does.
///
/// `sample` returns a direction for every wo that is not in the surface. Its weight differs from 1 by the
/// errors of the tables and, at other wavelengths than the hero, by the difference of indices. So weights do
/// not accumulate along long paths. The pdf of multiple scattering is as accurate as the tables, about 1e-3
/// of the light.
struct RoughDielectricBsdf {
  static constexpr bool kGlossy = true;
  static constexpr bool kBothSides = true;

  SampledSpectrum n;              ///< Inside index relative to the outside.
  const RoughInterface* surface;  ///< Holds the tables for n.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
  /// Fraction of the light from wo to wi that a single facet has scattered, at each wavelength.
  [[nodiscard]] SampledSpectrum single_fraction(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] float index_inside(int lane) const { return n[lane]; }
};

/// A rough dielectric interface; alpha_x of the facets is the roughness along u, alpha_y that perpendicular
/// to it. If both are below `kMinAlpha`, the scene uses a `DielectricMaterial` instead. A relative index
/// within 1e-3 of 1 is replaced by the nearest one that differs by 1e-3.
class RoughDielectricMaterial {
 public:
  /// Tabulates multiple scattering in air, which takes some tens of milliseconds.
  RoughDielectricMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets,
                          std::optional<Medium> interior_medium = {});

  /// Tabulates multiple scattering also in a medium of that index, unless an existing table covers it. In
  /// other media `bsdf` uses the table of the nearest relative index. Not thread-safe.
  void tabulate_in(const RefractiveIndex& medium);

  [[nodiscard]] RoughDielectricBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] static constexpr bool polarises() { return true; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] const RefractiveIndex* interior_index() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return interior_medium ? &*interior_medium : nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }

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
class RoughConductorMaterial {
 public:
  RoughConductorMaterial(std::string index_name, RefractiveIndex index, const Microfacets<float>& facets);

  [[nodiscard]] RoughConductorBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] static constexpr bool polarises() { return true; }
  [[nodiscard]] bool needs_coordinates() const { return surface->facets.brushed(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }

  std::string index_name;
  RefractiveIndex index;
  Curve mean_reflectance;  ///< Diffuse reflectance of the smooth metal in air.
  std::shared_ptr<const RoughMetal> surface;
};

}  // namespace abbe
