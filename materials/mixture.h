#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"
#include "materials/interface/mueller.h"
#include "materials/medium/medium.h"
#include "spectral/curve.h"

namespace abbe {

struct MixtureMaterial;

/// A mixture of scattering models. It refers to the material, which must outlive it, and makes the component
/// models at each call, because a path vertex has no room for several. Each wavelength samples a component in
/// proportion to its weight there. Delta lobes are sampled separately; the pdfs of all other lobes add up.
/// Where the weights sum to less than 1, the rest of the light is absorbed.
class MixtureBsdf {
 public:
  static constexpr bool kAbsorbingFilms = true;

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
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;

 private:
  [[nodiscard]] SurfaceLookup at() const { return {wavelengths_nm_, uv_, outside_}; }
  template <typename Quantity>
  [[nodiscard]] SampledSpectrum weighted(Quantity quantity) const;

  const MixtureMaterial* material_;
  SampledSpectrum wavelengths_nm_;
  Imath::V2f uv_;
  const RefractiveIndex* outside_;
};

struct Material;

/// Several materials side by side, too fine to be resolved: f = sum_i w_i f_i. No component is a mixture, and
/// light enters none.
struct MixtureMaterial {
  struct Component {
    Curve weight;  ///< In [0, 1]; the sum over the components is at most 1 at every wavelength.
    std::shared_ptr<const Material> material;
  };
  std::vector<Component> components;

  [[nodiscard]] MixtureBsdf bsdf(const SurfaceLookup& at) const { return {*this, at}; }
  [[nodiscard]] Lobes lobes() const;
  [[nodiscard]] bool needs_coordinates() const;
  [[nodiscard]] bool depends_on_outside() const;
  [[nodiscard]] bool opaque() const;
  [[nodiscard]] bool polarises() const;
  [[nodiscard]] bool preserves_polarisation() const;
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
};

}  // namespace abbe
