#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "materials/bsdf/energy_compensation.h"
#include "materials/bsdf/event.h"
#include "materials/index/refractive_index.h"
#include "materials/interface/microfacet.h"

namespace abbe {

/// Microfacets that reflect alone: what is worked out once for all wavelengths and directions.
struct RoughMetal {
  explicit RoughMetal(const Microfacets<float>& facets);

  Microfacets<float> facets;
  EnergyCompensation lost;
};

/// Microfacets between two media, the inner one of an index relative to the outer one in [low_n, high_n].
///
/// Energies are tabulated at some indices. From one of even number to the next they are quadratic in the
/// coordinate x = sqrt(|n - 1|), which has the sign of n - 1: the angle at which total reflection begins is
/// in proportion to x near n = 1, where they change fast. At n = 1 itself they have a kink, so that a range
/// that holds 1 is divided there.
struct RoughInterface {
  static constexpr std::size_t kMostIndices = 17;

  RoughInterface(const Microfacets<float>& facets, float low_n, float high_n);

  [[nodiscard]] static float coordinate(float n) { return std::copysign(std::sqrt(std::abs(n - 1)), n - 1); }
  /// Largest distance of a relative index of [low, high] from [low_n, high_n].
  [[nodiscard]] float distance_to(float low, float high) const {
    return std::max({low_n - low, high - high_n, 0.0F});
  }
  /// Number of the index whose tables multiple scattering is sampled by.
  [[nodiscard]] std::size_t middle() const { return coordinates.size() / 2; }

  Microfacets<float> facets;
  float low_n, high_n;
  std::vector<float> coordinates;                       ///< Of the indices, ascending; an odd number of them.
  std::array<std::vector<EnergyCompensation>, 2> lost;  ///< For light from outside, from inside; by index.
  float inside_share;  ///< Fraction of multiple scattering that goes inside, at the middle index.
};

/// Rough conductor, opaque, reflecting on both sides; it refers to the material and sees the packet
/// `wavelengths_nm`. Microfacets in mirror reflection [Walter2007, eq. 20] with height-correlated masking
/// [Heitz2014, eq. 99], and what they scatter more than once [Kulla2017], coloured by the conductor's
/// reflectance averaged over the hemisphere. Reciprocal.
struct RoughConductorBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum wavelengths_nm;
  SampledSpectrum mean_reflectance;  ///< `diffuse_reflectance` against the outside.
  const RefractiveIndex* index;
  const RefractiveIndex* outside;  ///< nullptr is air.
  const RoughMetal* surface;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Of the light sent from wo to wi, lane by lane, what one facet alone has scattered.
  [[nodiscard]] SampledSpectrum single_share(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// Rough dielectric interface with the normal towards the outside; `n` is the inside index relative to the
/// outside, not within 1e-3 of 1. Each lane refracts at its own facets [Walter2007, eq. 21], so that all
/// lanes may follow the hero. Masking is height-correlated in reflection, independent on the two sides in
/// transmission. What is scattered more than once leaves on either side as if it had forgotten from which it
/// came, which is the split that keeps reciprocity (radiance over n^2 reverses) and energy together. Towards
/// n = 1 single transmission keeps its masking: the surface does not fade away as a real one does.
///
/// `sample` always finds a direction, whose weight differs from 1 by the errors of the tables, and in lanes
/// other than the hero's by what their indices differ: weights do not pile up along paths of many events. The
/// density of multiple scattering is known to the precision of the tables, about 1e-3 of all light.
struct RoughDielectricBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum n;
  const RoughInterface* surface;  ///< Holds the tables for n.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  /// Of the light sent from wo to wi, lane by lane, what one facet alone has scattered.
  [[nodiscard]] SampledSpectrum single_share(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] float index_inside(int lane) const { return n[lane]; }
};

}  // namespace abbe
