#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"
#include "materials/interface/coating.h"
#include "materials/medium/medium.h"

namespace abbe {

/// A smooth dielectric interface with its normal towards the outside.
struct DielectricBsdf {
  SampledSpectrum n;  ///< Inside index relative to the outside.
  /// True if n may differ between wavelengths; then only the hero continues after refraction.
  bool dispersive;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
  [[nodiscard]] float index_inside(int lane) const { return n[lane]; }
  /// Index of the far side divided by that of the side of `wo`.
  [[nodiscard]] float eta(const Imath::V3f& wo, int lane) const { return wo.z < 0 ? 1 / n[lane] : n[lane]; }
  [[nodiscard]] float reflectance(const Imath::V3f& wo, int lane) const;
};

/// A smooth conductor, opaque, reflecting on both sides.
struct ConductorBsdf {
  SampledSpectrum n;  ///< Real part of the index relative to the outside.
  SampledSpectrum k;  ///< Imaginary part, 0 or more.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

/// A smooth dielectric interface under thin films, which absorb what they neither reflect nor transmit. It
/// refers to the material, which must outlive it, and holds the wavelengths of the packet.
struct CoatedDielectricBsdf {
  static constexpr bool kAbsorbingFilms = true;

  SampledSpectrum wavelengths_nm;  ///< Wavelengths in standard air [nm].
  const RefractiveIndex* index;    ///< Index inside; its k is ignored.
  const Coating* coating;
  const RefractiveIndex* outside = nullptr;  ///< Medium outside; nullptr is air.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
  [[nodiscard]] float index_inside(int lane) const {
    return relative_index(*index, outside, wavelengths_nm).n[lane];
  }
};

/// A smooth conductor under thin films, opaque, reflecting on both sides. It refers to the material, which
/// must outlive it.
struct CoatedConductorBsdf {
  SampledSpectrum wavelengths_nm;  ///< Wavelengths in standard air [nm].
  const RefractiveIndex* index;    ///< Complex index of the conductor.
  const Coating* coating;
  const RefractiveIndex* outside = nullptr;  ///< Medium outside; nullptr is air.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

/// A smooth interface to a transparent or absorbing medium, optionally under thin films.
struct DielectricMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};  ///< Thin films; no layers if the surface is bare.
  /// Medium inside that scatters or absorbs in addition to `index`; else empty.
  std::optional<Medium> interior_medium = {};

  [[nodiscard]] std::variant<DielectricBsdf, CoatedDielectricBsdf> bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] const RefractiveIndex* interior_index() const { return &index; }
  [[nodiscard]] const Medium* medium() const { return interior_medium ? &*interior_medium : nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(index_name, index, coating); }
};

/// Thin films with the same medium on both sides, such as a soap bubble. Light crosses them undeflected.
struct FilmMaterial {
  Coating layers;

  [[nodiscard]] CoatedDielectricBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(layers); }
};

/// A smooth metal, optionally under thin films.
struct ConductorMaterial {
  std::string index_name;
  RefractiveIndex index;
  Coating coating = {};  ///< Thin films; no layers if the metal is bare.

  [[nodiscard]] std::variant<ConductorBsdf, CoatedConductorBsdf> bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] bool preserves_polarisation() const;
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return indices_of(index_name, index, coating); }
};

/// The boundary of a medium without an interface, such as fog or smoke. Light passes it unchanged.
struct MediumMaterial {
  Medium interior_medium;

  [[nodiscard]] static DielectricBsdf bsdf(const SurfaceLookup& /*at*/) {
    return {SampledSpectrum(1.0F), false};
  }
  /// The surface is no scattering event, so it has no lobes.
  [[nodiscard]] static constexpr Lobes lobes() { return {}; }
  [[nodiscard]] static std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) {
    return at.undeflected(1);
  }
  [[nodiscard]] static SmoothMueller smooth_mueller(const SmoothLookup& /*at*/) { return {}; }
  [[nodiscard]] const Medium* medium() const { return &interior_medium; }
};

}  // namespace abbe
