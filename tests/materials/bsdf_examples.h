#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "materials/bsdf.h"
#include "materials/interface/fresnel.h"
#include "materials/material.h"

namespace abbe {

/// Instances of a scattering model for the laws that all models obey. A test over the list compiles only if
/// its newest member has them.
template <typename Model>
std::vector<Model> examples();

/// Tolerance of the total albedo against 1 if the model does not absorb; empty if it does.
template <typename Model>
std::optional<double> lossless_within(const Model& /*model*/) {
  return std::nullopt;
}
template <>
inline std::optional<double> lossless_within(const DielectricBsdf& /*model*/) {
  return 1e-3;
}
template <>
inline std::optional<double> lossless_within(const CoatedDielectricBsdf& model) {
  const auto& films = model.coating->materials;
  const bool absorbing = std::any_of(films.begin(), films.end(),
                                     [](const Coating::Material& film) { return film.index.absorbing(); });
  return absorbing ? std::nullopt : std::optional(1e-3);
}

template <>
inline std::optional<double> lossless_within(const RoughDielectricBsdf& /*model*/) {
  return 1e-2;
}
template <>
inline std::optional<double> lossless_within(const RoughConductorBsdf& model) {
  return model.index->n(500.0) == 0 ? std::optional(5e-3) : std::nullopt;
}

/// True if several lobes scatter into the same direction, so that the pdf is a sum.
template <typename Model>
inline constexpr bool kLobesOverlap = false;
template <>
inline constexpr bool kLobesOverlap<RoughDielectricBsdf> = true;
template <>
inline constexpr bool kLobesOverlap<RoughConductorBsdf> = true;
template <>
inline constexpr bool kLobesOverlap<MixtureBsdf> = true;
template <>
inline constexpr bool kLobesOverlap<PrincipledBsdf> = true;

template <>
inline std::optional<double> lossless_within(const CoatedDiffuseBsdf& model) {
  return model.n[0] == 1.5F ? std::optional(1e-3) : std::nullopt;  // the white instance
}
template <>
inline std::optional<double> lossless_within(const ThinGlassBsdf& model) {
  return model.depth.is_zero() ? std::optional(1e-5) : std::nullopt;
}

inline SampledSpectrum ramp(float first, float last) {
  SampledSpectrum::Values s;
  for (std::size_t j = 0; j < kLanes; ++j)
    s[j] = first + (last - first) * static_cast<float>(j) / (kLanes - 1);
  return SampledSpectrum(s);
}

template <>
inline std::vector<DiffuseBsdf> examples() {
  return {{SampledSpectrum(1)}, {ramp(0, 0.8F)}};
}
template <>
inline std::vector<DielectricBsdf> examples() {
  return {{SampledSpectrum(1.5F), false},
          {ramp(1.45F, 1.9F), true},
          {ramp(0.8F, 0.6F), true},
          {SampledSpectrum(1), true}};
}
template <>
inline std::vector<ConductorBsdf> examples() {
  return {{ramp(0.1F, 1.4F), ramp(7, 2)}, {SampledSpectrum(1.5F), SampledSpectrum(0)}};
}

// Media under films with the lifetime of the tests: a broad-band coat, a mirror stack and an absorbing film,
// on dispersive glass, on a constant index and without a substrate.
struct Coated {
  RefractiveIndex index;
  Coating coating;
};
inline const RefractiveIndex& dispersive_glass() {
  static const RefractiveIndex glass(Curve({{300, 1.6}, {1100, 1.45}}), Curve(0.0), IndexMedium::air, 300,
                                     1100);
  return glass;
}
inline Coating broad_coat() {
  return {{{"low", RefractiveIndex(1.38)}}, {{0, 100}}};
}
inline Coating mirror_stack() {
  return {{{"high", RefractiveIndex(2.35)}, {"low", RefractiveIndex(1.38)}}, {{0, 60}, {1, 100}, {0, 60}}};
}
inline Coating absorbing_film() {
  return {{{"grey", RefractiveIndex(1.9, 0.4)}, {"low", RefractiveIndex(1.38)}}, {{0, 40}, {1, 250}}};
}
inline SampledSpectrum packet() {
  return ramp(390, 770);
}
template <>
inline std::vector<CoatedDielectricBsdf> examples() {
  static const std::vector<Coated> all{{dispersive_glass(), broad_coat()},
                                       {RefractiveIndex(1.5), absorbing_film()},
                                       {RefractiveIndex(1), mirror_stack()},
                                       {dispersive_glass(), absorbing_film()},
                                       {RefractiveIndex(0.7), mirror_stack()}};
  std::vector<CoatedDielectricBsdf> models;
  for (const Coated& c : all) models.push_back({packet(), &c.index, &c.coating});
  return models;
}
template <>
inline std::vector<CoatedConductorBsdf> examples() {
  static const std::vector<Coated> all{{RefractiveIndex(0.2, 3), absorbing_film()},
                                       {RefractiveIndex(3, 3), broad_coat()}};
  std::vector<CoatedConductorBsdf> models;
  for (const Coated& c : all) models.push_back({packet(), &c.index, &c.coating});
  return models;
}

// Rough materials with the lifetime of the tests.
inline Microfacets<float> facets_of(FacetShape shape, float alpha_x, float alpha_y) {
  return {shape, alpha_x, alpha_y};
}
template <>
inline std::vector<RoughDielectricBsdf> examples() {
  static const RoughInterface wide(facets_of(FacetShape::ggx, 0.5F, 0.5F), 1.45F, 1.9F);
  static const RoughInterface brushed(facets_of(FacetShape::beckmann, 0.3F, 0.6F), 1.5F, 1.5F);
  static const RoughInterface thin(facets_of(FacetShape::ggx, 1, 1), 0.6F, 0.8F);
  static const RoughInterface needle(facets_of(FacetShape::ggx, 5e-3F, 5e-3F), 1.45F, 1.9F);
  return {{ramp(1.45F, 1.9F), &wide},
          {SampledSpectrum(1.5F), &brushed},
          {ramp(0.8F, 0.6F), &thin},
          {ramp(1.9F, 1.45F), &needle}};
}
template <>
inline std::vector<RoughConductorBsdf> examples() {
  static const std::vector<RoughConductorMaterial> all{
      {"metal",
       RefractiveIndex(Curve({{390, 0.1}, {770, 1.4}}), Curve({{390, 7}, {770, 2}}), IndexMedium::air, 300,
                       1100),
       facets_of(FacetShape::ggx, 0.4F, 0.4F)},
      {"mirror", RefractiveIndex(0, 1), facets_of(FacetShape::ggx, 1, 1)},
      {"brushed", RefractiveIndex(0.2, 3), facets_of(FacetShape::beckmann, 0.3F, 0.5F)},
      {"needle", RefractiveIndex(0.2, 3), facets_of(FacetShape::beckmann, 2e-3F, 5e-3F)}};
  std::vector<RoughConductorBsdf> models;
  for (const RoughConductorMaterial& m : all) models.push_back(m.bsdf({packet()}));
  return models;
}

template <>
inline std::vector<CoatedDiffuseBsdf> examples() {
  const auto coated = [](const SampledSpectrum& n, const SampledSpectrum& rho) {
    const auto inner = [](float x) { return static_cast<float>(diffuse_reflectance_inside(x)); };
    return coated_diffuse(n, rho, SampledSpectrum::map(n, inner), n[0] != n[kLanes - 1]);
  };
  return {coated(SampledSpectrum(1.5F), SampledSpectrum(1)), coated(ramp(1.3F, 1.7F), ramp(0.9F, 0)),
          coated(SampledSpectrum(1), SampledSpectrum(0.5F)), coated(SampledSpectrum(2.4F), ramp(0.1F, 0.8F))};
}
template <>
inline std::vector<ThinGlassBsdf> examples() {
  return {{SampledSpectrum(1.5F), SampledSpectrum(0)},
          {ramp(1.45F, 1.9F), ramp(0, 2)},
          {SampledSpectrum(0.8F), SampledSpectrum(0.1F)},
          {SampledSpectrum(1), SampledSpectrum(0)}};
}
template <>
inline std::vector<MirrorBsdf> examples() {
  return {{SampledSpectrum(1)}, {ramp(0, 0.8F)}};
}
template <>
inline std::vector<SchlickBsdf> examples() {
  return {{SampledSpectrum(0.04F)}, {ramp(0.5F, 1)}};
}
template <>
inline std::vector<OrenNayarBsdf> examples() {
  return {{SampledSpectrum(1), oren_nayar_roughness(20)}, {ramp(0, 0.9F), 1}, {ramp(1, 0.3F), 0}};
}

template <>
inline std::vector<PrincipledBsdf> examples() {
  static const Principled plain(PrincipledParameters{});
  static const Principled cloth(PrincipledParameters{.roughness = 1, .specular = 0.2F, .sheen = 1});
  static const Principled metal(PrincipledParameters{.metallic = 1, .roughness = 0.3F});
  static const Principled lacquer(PrincipledParameters{
      .metallic = 0.4F, .roughness = 0.6F, .specular = 1, .clearcoat = 1, .clearcoat_gloss = 0.3F});
  return {{SampledSpectrum(1), &plain},
          {SampledSpectrum(1), &cloth},
          {ramp(0.2F, 1), &metal},
          {ramp(0, 0.9F), &lacquer}};
}
template <>
inline std::vector<CosinePowerBsdf<false>> examples() {
  return {{SampledSpectrum(1), 3}, {ramp(0, 0.9F), 0.5F}};
}
template <>
inline std::vector<CosinePowerBsdf<true>> examples() {
  return {{SampledSpectrum(1), 0}, {SampledSpectrum(1), 7}, {ramp(0, 0.9F), 0.5F}};
}
template <>
inline std::vector<PhongBsdf> examples() {
  return {{SampledSpectrum(1), 20}, {ramp(0.2F, 0.9F), 3}};
}
template <>
inline std::vector<RetroreflectorBsdf> examples() {
  return {{SampledSpectrum(1), 2}, {SampledSpectrum(1), 50}, {ramp(0, 0.9F), 2000}};
}

template <>
inline std::optional<double> lossless_within(const WavePlateBsdf& model) {
  return model.transmittance[0] == 1 ? std::optional(1e-6) : std::nullopt;
}
template <>
inline std::vector<PolariserBsdf> examples() {
  return {{{SampledSpectrum(0.5F)}, SampledSpectrum(0), {1, 0}},
          {{ramp(0.2F, 0.4F)}, ramp(0, 1), {0.6F, -0.8F}}};
}
template <>
inline std::vector<WavePlateBsdf> examples() {
  return {{{SampledSpectrum(1)}, SampledSpectrum(1.5707964F), {0, 1}},
          {{ramp(0.9F, 0.3F)}, ramp(-3, 3), {0.6F, 0.8F}}};
}
template <>
inline std::vector<DepolariserBsdf> examples() {
  return {{{SampledSpectrum(1)}}, {{ramp(0, 0.9F)}}};
}

// A mirror with Lambertian and rougher materials; a sheet of glass with holes and spots; a spotted film,
// which absorbs more from one side. Only one component of each reflects specularly, so that its reverse
// direction is unambiguous.
inline const std::vector<MixtureMaterial>& mixtures() {
  const auto part = [](double red, double blue, MaterialModel model) {
    return MixtureMaterial::Component{Curve({{390, blue}, {770, red}}),
                                      std::make_shared<const Material>(Material{"part", std::move(model)})};
  };
  static const std::vector<MixtureMaterial> all{
      {{part(0.2, 0.5, MirrorMaterial{Curve(0.8)}), part(0.8, 0.1, OrenNayarMaterial{Curve(0.7), 30}),
        part(0, 0.4, DiffuseMaterial{Curve(1.0)})}},
      {{part(0.3, 0.2, DiffuseMaterial{Curve(0.5)}),
        part(0.5, 0.8, ThinGlassMaterial{"1.5", RefractiveIndex(1.5)})}},
      {{part(0.3, 0.2, DiffuseMaterial{Curve(0.5)}), part(0.5, 0.8, FilmMaterial{absorbing_film()})}}};
  return all;
}
template <>
inline std::vector<MixtureBsdf> examples() {
  static const SampledSpectrum wavelengths = packet();
  std::vector<MixtureBsdf> models;
  for (const MixtureMaterial& mixture : mixtures()) models.push_back({mixture, {wavelengths}});
  return models;
}

}  // namespace abbe
