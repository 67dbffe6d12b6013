#pragma once

#include <array>
#include <optional>
#include <vector>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"

namespace abbe {

/// Parameters of the principled model besides its base colour, each in [0, 1].
struct PrincipledParameters {
  float metallic = 0;         ///< Fraction of the metallic part; the rest is dielectric.
  float roughness = 0.5F;     ///< Square root of the facets' alpha.
  float specular = 0.5F;      ///< Reflectance along the normal of the dielectric part, divided by 0.08.
  float sheen = 0;            ///< Strength of a lobe at grazing angles, as of cloth.
  float clearcoat = 0;        ///< Strength of a second highlight.
  float clearcoat_gloss = 1;  ///< Interpolates alpha of the coat between its dull (0) and glossy (1) value.
};

/// Reflectance of a clear coat of strength 1, relative to that of a layer of index 1.5.
inline constexpr double kCoatScale = 0.25;
/// Alpha of the clear coat at a gloss of 0 and of 1.
inline constexpr double kDullCoatAlpha = 0.1;
inline constexpr double kGlossyCoatAlpha = 0.001;

/// The principled model without its base colour, with its directional albedo at 32 cosines. Directions are
/// local unit vectors that point away from the surface.
class Principled {
 public:
  /// A scattering function [1/sr] or albedo as `white` + base colour * `coloured`.
  struct Terms {
    float white = 0;
    float coloured = 0;
  };

  explicit Principled(const PrincipledParameters& parameters);

  /// The scattering function of [Burley2012], without the limit on energy. It is 0 unless both directions
  /// have z > 0.
  [[nodiscard]] Terms unlimited(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Directional albedo at the cosine of a direction, clamped to [0, 1], before the limit on energy; accurate
  /// to 3e-3.
  [[nodiscard]] Terms albedo(float cosine) const;
  /// Pdf of `draw` [1/sr], equal for all wavelengths; 0 unless both directions have z > 0.
  [[nodiscard]] float density(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Samples a direction for wo, wo.z > 0; empty if it points below the surface.
  [[nodiscard]] std::optional<Imath::V3f> draw(const Imath::V3f& wo, const BsdfRandom& u) const;

 private:
  enum Lobe { ground, highlight, coat };
  static constexpr std::array kLobes{ground, highlight, coat};
  struct Facet;

  [[nodiscard]] Terms value(Lobe lobe, const Facet& at) const;
  [[nodiscard]] float density(Lobe lobe, const Facet& at) const;
  [[nodiscard]] std::optional<Imath::V3f> draw(Lobe lobe, const Imath::V3f& wo, const Imath::V2f& u) const;
  [[nodiscard]] Terms integrated(const Imath::V3f& wo) const;

  PrincipledParameters parameters_;
  float n_;                             // index of the dielectric part
  float alpha_, coat_alpha_;            // alpha of the highlight and of the coat
  std::array<float, 3> probability_{};  // of sampling each lobe; 0 for an absent one
  std::vector<Terms> albedo_;
};

/// The principled model of Disney [Burley2012]: a diffuse lobe that depends on roughness at grazing angles,
/// sheen, a GGX highlight and a clear coat. It is fitted to measured appearance, not derived from one
/// surface. Both sides reflect alike. The base colour is a spectrum. The dielectric part uses Fresnel's
/// equations. The metallic part has no index, so it uses Schlick's approximation with the base colour.
///
/// The lobes do not conserve energy: with a white base colour the albedo may be 1.5. So f is divided by
/// max(1, E(o), E(i)), with E the directional albedo at each wavelength, increased by the error of its table.
/// This leaves f unchanged where both directions conserve energy, makes all directions conserve it, and
/// preserves reciprocity.
struct PrincipledBsdf {
  SampledSpectrum base;          ///< In [0, 1].
  const Principled* principled;  ///< Model of the material, which must outlive this.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

/// Burley's principled model; `reflectance` is its base colour.
struct PrincipledMaterial : OpaqueSurface {
  Principled principled;

  [[nodiscard]] PrincipledBsdf bsdf(const SurfaceLookup& at) const { return {reflectance(at), &principled}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe
