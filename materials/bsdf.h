#pragma once

#include <concepts>
#include <optional>
#include <utility>
#include <variant>

#include "materials/bsdf/diffuse.h"
#include "materials/bsdf/event.h"
#include "materials/bsdf/mirror.h"
#include "materials/bsdf/power_lobes.h"
#include "materials/bsdf/principled.h"
#include "materials/bsdf/rough.h"
#include "materials/bsdf/smooth.h"
#include "materials/bsdf/thin_element.h"
#include "materials/interface/mueller.h"
#include "materials/mixture.h"

namespace abbe {

/// A model that scatters into more than single directions.
template <typename Model>
concept SpreadModel = requires(const Model& model, const Imath::V3f& w) {
  { model.eval(w, w, TransportMode::radiance) } -> std::same_as<SampledSpectrum>;
  { model.pdf(w, w) } -> std::same_as<SampledSpectrum>;
};

/// A model that scatters into single directions.
template <typename Model>
concept DeltaModel = requires(const Model& model, const Imath::V3f& w) {
  { model.delta_power(w, true) } -> std::same_as<SampledSpectrum>;
};

/// Interface of the scattering models. Directions are unit vectors in the local frame of `BsdfSample`. No
/// function throws. The free functions of these names below describe the functions.
/// - Optional functions, with defaults: `index_inside` (1), `mueller` (depolarises) and `delta_probability`
///   (1 for a `DeltaModel`, else 0).
/// - Optional constants, declared only if true: `kGlossy` if all lobes are glossy, `kBothSides` if it
///   scatters to both sides, and `kAbsorbingFilms` if its delta lobes may cross absorbing films.
template <typename Model>
concept BsdfModel = requires(const Model& model, const Imath::V3f& w, const BsdfRandom& u) {
  requires SpreadModel<Model> || DeltaModel<Model>;
  { model.sample(w, u, 0, TransportMode::radiance) } -> std::same_as<std::optional<BsdfSample>>;
};

/// The closed list of scattering models, evaluated at a packet of wavelengths. A new model is a struct in
/// `materials/bsdf/` and an entry here; the statistical tests iterate the list.
using Bsdf = std::variant<DiffuseBsdf, DielectricBsdf, ConductorBsdf, CoatedDielectricBsdf,
                          CoatedConductorBsdf, RoughDielectricBsdf, RoughConductorBsdf, CoatedDiffuseBsdf,
                          ThinGlassBsdf, MixtureBsdf, MirrorBsdf, SchlickBsdf, OrenNayarBsdf, PrincipledBsdf,
                          CosinePowerBsdf<false>, CosinePowerBsdf<true>, PhongBsdf, RetroreflectorBsdf,
                          PolariserBsdf, WavePlateBsdf, DepolariserBsdf>;
static_assert(sizeof(Bsdf) <= 4 * sizeof(SampledSpectrum));  // every path vertex stores one

template <typename List>
inline constexpr bool kAllBsdfModels = false;
template <typename... Models>
inline constexpr bool kAllBsdfModels<std::variant<Models...>> = (BsdfModel<Models> && ...);
static_assert(kAllBsdfModels<Bsdf>);

/// Calls `visitor` with the model. The most frequent model is tested first, inline.
template <typename Visitor>
[[nodiscard]] decltype(auto) visit_model(Visitor&& visitor, const Bsdf& bsdf) {
  if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf)) return visitor(*diffuse);
  return std::visit(std::forward<Visitor>(visitor), bsdf);
}

/// Samples the local direction `wi` into which light from `wo` leaves; in radiance mode, from which it
/// arrives. `hero` is the number of the wavelength sample that draws it. Empty if wo.z is 0 or if the sampled
/// event carries no light; the path then ends.
[[nodiscard]] inline std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo,
                                                      const BsdfRandom& u, int hero, TransportMode mode) {
  return visit_model([&](const auto& model) { return model.sample(wo, u, hero, mode); }, bsdf);
}

/// f(wo, wi) [1/sr] at each wavelength, without the cosine of wi and without delta lobes. It is 0 for models
/// that have delta lobes only. Refraction scales it by `mode`, as `TransportMode` states.
[[nodiscard]] inline SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi,
                                          TransportMode mode) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (SpreadModel<Model>)
          return model.eval(wo, wi, mode);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Pdf [1/sr] with which `sample` draws wi by an event that is not delta, at each wavelength as if it were
/// the hero. It is 0 for models that have delta lobes only.
[[nodiscard]] inline SampledSpectrum pdf(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (SpreadModel<Model>)
          return model.pdf(wo, wi);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Probability with which `sample` draws a delta event, at each wavelength as if it were the hero. The
/// remaining probability belongs to the events of `pdf` and to empty samples. It is 0 for models without
/// delta lobes.
[[nodiscard]] inline SampledSpectrum delta_probability(const Bsdf& bsdf, const Imath::V3f& wo) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (requires { model.delta_probability(wo); })
          return model.delta_probability(wo);
        else
          return SampledSpectrum(DeltaModel<Model> ? 1.0F : 0.0F);
      },
      bsdf);
}

/// Fraction of the unpolarised light from `wo` that leaves in a single direction, at each wavelength: by
/// transmission if `through`, else by reflection. It is a fraction of power, without the factor 1/eta^2 of
/// radiance.
[[nodiscard]] inline SampledSpectrum delta_power(const Bsdf& bsdf, const Imath::V3f& wo, bool through) {
  return visit_model(
      [&]<typename Model>(const Model& model) {
        if constexpr (DeltaModel<Model>)
          return model.delta_power(wo, through);
        else
          return SampledSpectrum();
      },
      bsdf);
}

/// Density of the delta event `event` of `sample` at each wavelength, without unit and equal for both
/// directions of travel. It is the probability of the event, except for transmission by thin films, also in a
/// mixture. If films absorb, that probability depends on the side of incidence, so their transmittance
/// replaces it. `squared_eta` is the squared index on the far side divided by that on the side of incidence;
/// `mode` is that of `sample`.
[[nodiscard]] inline SampledSpectrum delta_density(const Bsdf& bsdf, const BsdfSample& event,
                                                   float squared_eta, TransportMode mode) {
  if (event.transmitted && visit_model(
                               []<typename Model>(const Model&) {
                                 return requires {
                                   Model::kAbsorbingFilms;
                                 };
                               },
                               bsdf))
    return event.weight * (event.pdf * (mode == TransportMode::radiance ? squared_eta : 1));
  return event.lane_pdf * event.pdf;
}

/// True if the model scatters into more than single directions, so that next-event estimation can contribute.
[[nodiscard]] inline bool scatters(const Bsdf& bsdf) {
  return visit_model([]<typename Model>(const Model&) { return SpreadModel<Model>; }, bsdf);
}

/// Index behind a surface that light enters, relative to the outside, at wavelength sample `lane`; 1 for
/// other surfaces.
[[nodiscard]] inline float index_inside(const Bsdf& bsdf, int lane) {
  return visit_model(
      [lane]<typename Model>(const Model& model) {
        if constexpr (requires { model.index_inside(lane); })
          return model.index_inside(lane);
        else
          return 1.0F;
      },
      bsdf);
}

/// True if the model refracts light in a single direction, each wavelength by its own index.
[[nodiscard]] inline bool refracts_smoothly(const Bsdf& bsdf) {
  return visit_model(
      []<typename Model>(const Model&) {
        return DeltaModel<Model> && requires(const Model& model) {
          model.index_inside(0);
        };
      },
      bsdf);
}

/// True if all lobes of the model are glossy. A mixture counts as not glossy.
[[nodiscard]] inline bool glossy(const Bsdf& bsdf) {
  return visit_model(
      []<typename Model>(const Model&) {
        return requires {
          Model::kGlossy;
        };
      },
      bsdf);
}

/// True if the model scatters to both sides of the surface, other than in single directions.
[[nodiscard]] inline bool scatters_to_both_sides(const Bsdf& bsdf) {
  return visit_model(
      []<typename Model>(const Model&) {
        return requires {
          Model::kBothSides;
        };
      },
      bsdf);
}

/// True if the model is `DiffuseBsdf` with reflectance 0 at all wavelengths. False for every other model,
/// even if it absorbs all light.
[[nodiscard]] inline bool is_black(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  return diffuse != nullptr && diffuse->reflectance.is_zero();
}

/// Mueller matrix of scattering between the local directions `wo` and `wi`, both pointing away from the
/// surface, about an axis in the same local frame. It is that of the delta lobe if `delta` is true, else that
/// of all other lobes. Empty if that lobe depolarises. The power is not included: it is in the event's weight
/// or in `eval`. If `lane` is given, only the elements of that wavelength sample are valid.
[[nodiscard]] inline std::optional<MuellerMatrix> mueller(const Bsdf& bsdf, const Imath::V3f& wo,
                                                          const Imath::V3f& wi, bool delta,
                                                          std::optional<int> lane = {}) {
  return visit_model(
      [&]<typename Model>(const Model& model) -> std::optional<MuellerMatrix> {
        if constexpr (requires { model.mueller(wo, wi, delta, lane); })
          return model.mueller(wo, wi, delta, lane);
        else
          return std::nullopt;
      },
      bsdf);
}

}  // namespace abbe
