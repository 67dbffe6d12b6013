#pragma once

#include <optional>

#include "materials/bsdf/event.h"
#include "materials/bsdf/lookup.h"
#include "materials/interface/mueller.h"

namespace abbe {

struct MixtureMaterial;

/// A mixture of scattering models. It refers to the material, which must outlive it, and makes the component
/// models at each call, because a path vertex has no room for several. Each wavelength samples a component in
/// proportion to its weight there. Delta lobes are sampled separately; the pdfs of all other lobes add up.
/// Where the weights sum to less than 1, the rest of the light is absorbed.
class MixtureBsdf {
 public:
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = true;

  MixtureBsdf(const MixtureMaterial& material, const SurfaceLookup& at)
      : material_(&material), wavelengths_nm_(at.wavelengths_nm), uv_(at.uv), outside_(at.outside) {}

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  /// Mean of the components' Mueller matrices, weighted by the power that each scatters from wo to wi: by
  /// delta lobes if `delta`, else by all others. Empty if all depolarise.
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                     bool delta) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }

 private:
  [[nodiscard]] SurfaceLookup at() const { return {wavelengths_nm_, uv_, outside_}; }

  const MixtureMaterial* material_;
  SampledSpectrum wavelengths_nm_;
  Imath::V2f uv_;
  const RefractiveIndex* outside_;
};

}  // namespace abbe
