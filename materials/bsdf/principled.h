#pragma once

#include <array>
#include <optional>
#include <vector>

#include "materials/bsdf/event.h"

namespace abbe {

/// What an artist says of matter beside its colour, each in [0, 1].
struct PrincipledLook {
  float metallic = 0;
  float roughness = 0.5F;  ///< The facets' width is its square.
  float specular = 0.5F;   ///< Reflectance along the normal of what is no metal, over 0.08.
  float sheen = 0;         ///< As of cloth at grazing angles.
  float clearcoat = 0;     ///< Strength of a second highlight.
  float clearcoat_gloss = 1;
};

/// Share that a clear coat of strength 1 has of what a layer of its index reflects, and the widths of its
/// facets at a gloss of 0 and of 1.
inline constexpr double kCoatShare = 0.25;
inline constexpr double kDullCoatWidth = 0.1;
inline constexpr double kGlossyCoatWidth = 0.001;

/// A look with what it needs of all directions: how much light from one leaves in all. Both `white` and,
/// times the base colour, `coloured` are held at 32 cosines.
class Principled {
 public:
  /// Both terms of a scattering function [1/sr], or of its albedo.
  struct Terms {
    float white = 0;
    float coloured = 0;
  };

  explicit Principled(const PrincipledLook& look);

  /// The scattering function as Burley has it, not limited to what arrives; directions are on the side z > 0.
  [[nodiscard]] Terms unlimited(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Share of what arrives at an angle of that cosine which leaves, before it is limited; to 3e-3.
  [[nodiscard]] Terms albedo(float cosine) const;
  /// Density of the directions drawn [1/sr], the same for all lanes.
  [[nodiscard]] float density(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Draws a direction with that density; nothing where it leads below the surface.
  [[nodiscard]] std::optional<Imath::V3f> draw(const Imath::V3f& wo, const BsdfRandom& u) const;

 private:
  enum Lobe { ground, highlight, coat };
  static constexpr std::array kLobes{ground, highlight, coat};
  struct Facet;

  [[nodiscard]] Terms value(Lobe lobe, const Facet& at) const;
  [[nodiscard]] float density(Lobe lobe, const Facet& at) const;
  [[nodiscard]] std::optional<Imath::V3f> draw(Lobe lobe, const Imath::V3f& wo, const Imath::V2f& u) const;
  [[nodiscard]] Terms integrated(const Imath::V3f& wo) const;

  PrincipledLook look_;
  float n_;                             // of what is no metal
  float alpha_, coat_alpha_;            // widths of the facets
  std::array<float, 3> probability_{};  // of drawing each lobe; that of an absent one is 0
  std::vector<Terms> albedo_;
};

/// The principled model of Disney's animation studio [Burley2012]: a diffuse ground that is darker or lighter
/// at grazing angles by its roughness, sheen, a GGX highlight and a clear coat's, drawn to a measured look
/// and not from one surface; both sides alike. The base colour is a spectrum. What is no metal reflects by
/// Fresnel's equations, metals by Schlick's approximation from the base colour as there is no index.
///
/// Its lobes are not balanced: a white look may return half as much again as arrives. Here f is divided by
/// max(1, E(o), E(i)), E being the albedo of a direction in a lane, a little more than known, which leaves it
/// as it is where both directions conserve energy, makes all do so, and keeps it reciprocal.
struct PrincipledBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum base;  ///< In [0, 1].
  const Principled* look;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe
