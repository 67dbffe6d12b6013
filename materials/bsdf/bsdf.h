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
#include "materials/bsdf/thin_element.h"
#include "materials/bsdf/thin_glass.h"

namespace abbe {

/// What every scattering model has: `sample`; `index_inside`, of the matter behind a surface that lets light
/// in, relative to what is outside, at one lane, 1 for the others; whether it `kScatters`, in more than
/// single directions, for which it then has `eval` and `pdf`; and whether it sends light in single
/// directions, `kDelta`, for which it has `delta_probability` and `delta_power`.
template <typename Model>
concept BsdfModel = requires(const Model& model, const Imath::V3f& w, const BsdfRandom& u) {
  { model.sample(w, u, 0, TransportMode::radiance) } -> std::same_as<std::optional<BsdfSample>>;
  { model.index_inside(0) } -> std::same_as<float>;
  { Model::kScatters } -> std::same_as<const bool&>;
  { Model::kDelta } -> std::same_as<const bool&>;
}
&&(Model::kScatters || Model::kDelta) &&
    (!Model::kScatters ||
     requires(const Model& model, const Imath::V3f& w) {
       { model.eval(w, w, TransportMode::radiance) } -> std::same_as<SampledSpectrum>;
       { model.pdf(w, w) } -> std::same_as<SampledSpectrum>;
     }) &&
    (!Model::kDelta || requires(const Model& model, const Imath::V3f& w) {
      { model.delta_probability(w) } -> std::same_as<SampledSpectrum>;
      { model.delta_power(w, true) } -> std::same_as<SampledSpectrum>;
    });

/// The closed list of scattering models, evaluated at one packet of wavelengths. A new model is a file pair
/// and an entry here; the statistical tests iterate the list.
using Bsdf = std::variant<DiffuseBsdf, DielectricBsdf, ConductorBsdf, CoatedDielectricBsdf,
                          CoatedConductorBsdf, RoughDielectricBsdf, RoughConductorBsdf, CoatedDiffuseBsdf,
                          ThinGlassBsdf, MixtureBsdf, MirrorBsdf, SchlickBsdf, OrenNayarBsdf, PrincipledBsdf,
                          CosinePowerBsdf<false>, CosinePowerBsdf<true>, PhongBsdf, RetroreflectorBsdf,
                          PolariserBsdf, WavePlateBsdf, DepolariserBsdf>;
static_assert(sizeof(Bsdf) <= 4 * sizeof(SampledSpectrum));  // every vertex of a path holds one

template <typename List>
inline constexpr bool kAllBsdfModels = false;
template <typename... Models>
inline constexpr bool kAllBsdfModels<std::variant<Models...>> = (BsdfModel<Models> && ...);
static_assert(kAllBsdfModels<Bsdf>);

/// Whether a model is one of some.
template <typename... Models>
[[nodiscard]] bool is_any_of(const Bsdf& bsdf) {
  return (std::holds_alternative<Models>(bsdf) || ...);
}

/// What `visitor` makes of the model, the commonest being asked for first, in line.
template <typename Visitor>
[[nodiscard]] decltype(auto) visit_model(Visitor&& visitor, const Bsdf& bsdf) {
  if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf)) return visitor(*diffuse);
  return std::visit(std::forward<Visitor>(visitor), bsdf);
}

/// Draws a direction in which light leaves (radiance mode: from which it comes); nothing where none does.
[[nodiscard]] inline std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo,
                                                      const BsdfRandom& u, int hero, TransportMode mode) {
  return visit_model([&](const auto& model) { return model.sample(wo, u, hero, mode); }, bsdf);
}

/// f(wo, wi) [1/sr] lane by lane, without the cosine and without what goes in single directions.
[[nodiscard]] inline SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi,
                                          TransportMode mode) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (Model::kScatters)
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
        if constexpr (Model::kScatters)
          return model.pdf(wo, wi);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Probability with which `sample` would draw a delta event, were each lane the hero. What is left of 1 are
/// events of `pdf`, and those by which nothing leaves.
[[nodiscard]] inline SampledSpectrum delta_probability(const Bsdf& bsdf, const Imath::V3f& wo) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (Model::kDelta)
          return model.delta_probability(wo);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Share of the unpolarised light from `wo` that leaves in a single direction, lane by lane: through the
/// surface, or on the side that it came from.
[[nodiscard]] inline SampledSpectrum delta_power(const Bsdf& bsdf, const Imath::V3f& wo, bool through) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (Model::kDelta)
          return model.delta_power(wo, through);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// The density of a delta event of `bsdf`, lane by lane, that is the same whichever of its two ways light
/// takes: its probability. Films that absorb, in a mixture too, let light through with a probability that
/// depends on the side it comes from; the transmittance, which does not, stands there for both. `squared_eta`
/// is the square of the index it goes on in over that it came in.
[[nodiscard]] inline SampledSpectrum delta_density(const Bsdf& bsdf, const BsdfSample& event,
                                                   float squared_eta, TransportMode mode) {
  const bool may_be_film =
      std::holds_alternative<CoatedDielectricBsdf>(bsdf) || std::holds_alternative<MixtureBsdf>(bsdf);
  if (event.transmitted && may_be_film)
    return event.weight * (event.pdf * (mode == TransportMode::radiance ? squared_eta : 1));
  return event.lane_pdf * event.pdf;
}

/// Whether light may leave in more than single directions, so that connecting to lights pays.
[[nodiscard]] inline bool scatters(const Bsdf& bsdf) {
  return visit_model([]<typename Model>(const Model&) { return Model::kScatters; }, bsdf);
}

/// Index of the matter behind a surface that lets light in, relative to what is outside, at one lane; 1 for
/// the others.
[[nodiscard]] inline float index_inside(const Bsdf& bsdf, int lane) {
  return visit_model([lane](const auto& model) { return model.index_inside(lane); }, bsdf);
}

/// Whether nothing leaves, whatever arrives.
[[nodiscard]] inline bool is_black(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  return diffuse != nullptr && diffuse->reflectance.is_zero();
}

}  // namespace abbe
