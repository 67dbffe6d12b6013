#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "materials/material.h"

namespace abbe {

/// Some instances of a scattering model, for the laws that all of them obey: a test over the list does not
/// compile before its newest member has them.
template <typename Model>
std::vector<Model> examples();

/// How far from 1 what leaves may be in all, if nothing is absorbed; nothing for matter that absorbs.
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
  const auto& films = model.coating->matters;
  const bool absorbing = std::any_of(films.begin(), films.end(),
                                     [](const Coating::Matter& matter) { return matter.index.absorbing(); });
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

/// Whether several lobes send light the same way, so that a density is the sum of what each leads there.
template <typename Model>
inline constexpr bool kLobesOverlap = false;
template <>
inline constexpr bool kLobesOverlap<RoughDielectricBsdf> = true;
template <>
inline constexpr bool kLobesOverlap<RoughConductorBsdf> = true;

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

// Matter under films that live as long as the tests: a broad coat, a mirror stack, an absorbing film; on
// glass, on plain matter, on nothing.
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

// Rough matter that lives as long as the tests.
inline Microfacets<float> facets_of(FacetShape shape, float alpha_x, float alpha_y) {
  return {shape, alpha_x, alpha_y};
}
template <>
inline std::vector<RoughDielectricBsdf> examples() {
  static const RoughBoundary wide(facets_of(FacetShape::ggx, 0.5F, 0.5F), 1.45F, 1.9F);
  static const RoughBoundary brushed(facets_of(FacetShape::beckmann, 0.3F, 0.6F), 1.5F, 1.5F);
  static const RoughBoundary thin(facets_of(FacetShape::ggx, 1, 1), 0.6F, 0.8F);
  static const RoughBoundary needle(facets_of(FacetShape::ggx, 5e-3F, 5e-3F), 1.45F, 1.9F);
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
  for (const RoughConductorMaterial& m : all)
    models.push_back(std::get<RoughConductorBsdf>(m.bsdf({packet()})));
  return models;
}

}  // namespace abbe
