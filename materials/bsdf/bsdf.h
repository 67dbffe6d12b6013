#pragma once

#include <concepts>
#include <optional>
#include <utility>
#include <variant>

#include "materials/bsdf/coated.h"
#include "materials/bsdf/coated_diffuse.h"
#include "materials/bsdf/comparison.h"
#include "materials/bsdf/diffuse.h"
#include "materials/bsdf/event.h"
#include "materials/bsdf/mixture.h"
#include "materials/bsdf/power_lobes.h"
#include "materials/bsdf/principled.h"
#include "materials/bsdf/rough.h"
#include "materials/bsdf/rough_diffuse.h"
#include "materials/bsdf/smooth.h"
#include "materials/bsdf/thin_glass.h"

namespace abbe {

/// The closed list of scattering models, evaluated at one packet of wavelengths. Each has `sample`; those
/// that send light in more than single directions have `eval` and `pdf` as well. A new model is a file pair
/// and an entry here; the statistical tests iterate the list.
using Bsdf = std::variant<DiffuseBsdf, DielectricBsdf, ConductorBsdf, CoatedDielectricBsdf,
                          CoatedConductorBsdf, RoughDielectricBsdf, RoughConductorBsdf, CoatedDiffuseBsdf,
                          ThinGlassBsdf, MixtureBsdf, MirrorBsdf, SchlickBsdf, OrenNayarBsdf, PrincipledBsdf,
                          CosinePowerBsdf<false>, CosinePowerBsdf<true>, PhongBsdf, RetroreflectorBsdf>;
static_assert(sizeof(Bsdf) <= 4 * sizeof(SampledSpectrum));  // every vertex of a path holds one

/// What `visitor` makes of the model, the commonest being asked for first, in line.
template <typename Visitor>
[[nodiscard]] decltype(auto) visit_model(Visitor&& visitor, const Bsdf& bsdf) {
  if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf)) return visitor(*diffuse);
  return std::visit(std::forward<Visitor>(visitor), bsdf);
}

/// A model that sends light in more than single directions.
template <typename Model>
concept Scattering = requires(const Model& model, const Imath::V3f& w) {
  { model.eval(w, w, TransportMode::radiance) } -> std::same_as<SampledSpectrum>;
  { model.pdf(w, w) } -> std::same_as<SampledSpectrum>;
};

/// Nothing where no light leaves.
[[nodiscard]] inline std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo,
                                                      const BsdfRandom& u, int hero, TransportMode mode) {
  return visit_model([&](const auto& model) { return model.sample(wo, u, hero, mode); }, bsdf);
}

/// f(wo, wi) [1/sr] lane by lane, without the cosine and without what goes in single directions.
[[nodiscard]] inline SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi,
                                          TransportMode mode) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (Scattering<Model>)
          return model.eval(wo, wi, mode);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Density with which `sample` would draw wi, by an event that is not delta, were each lane the hero [1/sr].
[[nodiscard]] inline SampledSpectrum pdf(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (Scattering<Model>)
          return model.pdf(wo, wi);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Whether light may leave in more than single directions, so that connecting to lights pays.
[[nodiscard]] inline bool scatters(const Bsdf& bsdf) {
  return visit_model([]<typename Model>(const Model&) { return Scattering<Model>; }, bsdf);
}

/// Index of the matter behind a surface that lets light in, relative to what is outside, at one lane; 1 for
/// the others.
[[nodiscard]] inline float index_inside(const Bsdf& bsdf, int lane) {
  return visit_model(
      [lane](const auto& model) {
        if constexpr (requires { model.index_inside(lane); })
          return model.index_inside(lane);
        else
          return 1.0F;
      },
      bsdf);
}

/// Whether nothing leaves, whatever arrives.
[[nodiscard]] inline bool is_black(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  return diffuse != nullptr && diffuse->reflectance.is_zero();
}

}  // namespace abbe
