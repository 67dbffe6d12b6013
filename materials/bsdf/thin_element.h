#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"
#include "materials/medium/medium.h"

namespace abbe {

/// Thin sheets that change the polarisation of light and transmit it undeflected, alike from both sides. They
/// do not reflect. Axes lie in the surface, with x along u. At oblique incidence the effective axis is the
/// projection perpendicular to the ray.

/// The part common to all thin elements: their action on unpolarised light.
struct ThinElement {
  SampledSpectrum transmittance;  ///< Transmittance of unpolarised light, in [0, 1].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                 TransportMode /*mode*/) const {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = -wo, .weight = transmittance, .pdf = 1, .delta = true, .transmitted = true};
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& /*wo*/, bool through) const {
    return through ? transmittance : SampledSpectrum();
  }
};

/// A linear polariser.
struct PolariserBsdf : ThinElement {
  SampledSpectrum blocked;  ///< Transmittance perpendicular to the axis divided by that along it, in [0, 1].
  Imath::V2f axis;          ///< Unit vector along which fields are transmitted.
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

struct WavePlateBsdf : ThinElement {
  SampledSpectrum retardance;  ///< Phase lag of fields perpendicular to the fast axis [rad].
  Imath::V2f axis;             ///< Unit vector along the fast axis.
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

/// A sheet that depolarises the light it transmits.
struct DepolariserBsdf : ThinElement {};

/// A sheet of transparent or absorbing glass with the same medium on both sides. It reflects light or
/// transmits it undeflected, in the same directions at all wavelengths. Its powers include all reflections
/// between the faces, without interference (`sheet_power`).
struct ThinGlassBsdf {
  SampledSpectrum n;  ///< Index relative to the medium outside.
  /// Optical depth of one passage along the normal, 0 or more: -ln a, where a is the internal transmittance.
  SampledSpectrum depth;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  /// Probability of a delta event: 1, or 0 at wavelengths at which no light leaves.
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  /// Transmittance of the sheet if `through`, else its reflectance.
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

/// A pane of glass modelled as one surface that does not deflect light, by `ThinGlassBsdf`.
struct ThinGlassMaterial {
  std::string index_name;
  RefractiveIndex index;  ///< k makes the pane absorb.
  double thickness = 0;   ///< Thickness of the pane [m].

  [[nodiscard]] ThinGlassBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] const RefractiveIndex* clear_index() const { return &index; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
};

struct ThinElementMaterial {
  Curve transmittance;  ///< In [0, 1]; the model defines for which light.

  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const {
    return at.undeflected(transmittance(at.wavelength_nm));
  }
};

/// A linear polariser; `transmittance` is that of light polarised along its axis.
struct PolariserMaterial : ThinElementMaterial {
  Curve blocked;  ///< Transmittance perpendicular to the axis divided by that along it, in [0, 1].
  double angle;   ///< Angle of the transmission axis [rad].

  [[nodiscard]] double mean_transmittance(double wavelength_nm) const {
    return transmittance(wavelength_nm) * (1 + blocked(wavelength_nm)) / 2;
  }
  [[nodiscard]] PolariserBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

/// A wave plate: ideal, or a birefringent plate with perfect antireflection coatings.
struct WavePlateMaterial : ThinElementMaterial {
  struct Ideal {
    double retardance;  ///< Retardance at all wavelengths [rad].
  };
  struct Crystal {
    double thickness;     ///< Thickness of the plate [m].
    Curve birefringence;  ///< Index of the slow axis minus that of the fast axis, relative to air; 0 or more.
  };
  std::variant<Ideal, Crystal> kind;
  double angle;  ///< Angle of the fast axis [rad].

  /// Phase lag of fields perpendicular to the fast axis [rad]: 2 pi Delta n d/lambda along the normal. The
  /// plate is treated as thin, so the value holds for all directions.
  [[nodiscard]] double retardance(double wavelength_nm) const;
  [[nodiscard]] WavePlateBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr bool needs_coordinates() { return true; }
};

struct DepolariserMaterial : ThinElementMaterial {
  [[nodiscard]] DepolariserBsdf bsdf(const SurfaceLookup& at) const {
    return {{transmittance(at.wavelengths_nm)}};
  }
  [[nodiscard]] static SmoothMueller smooth_mueller(const SmoothLookup& /*at*/) {
    return {{{}, {0, 0, 0, 0}}};
  }
};

}  // namespace abbe
