#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "materials/material.h"

// Interfaces of matter: indices, and what lies on surfaces.
namespace abbe::spec {

struct ConstantIor {
  double n = 1;
  double k = 0;
};
struct MetalIor : ConstantIor {};  ///< Whose n may be 0: the perfect mirror.
/// Samples of n and k with straight lines between them, held beyond their ends.
struct TableIor {
  std::vector<double> wavelength_nm;
  std::vector<double> n;
  std::optional<std::vector<double>> k;  ///< 0 when absent.
  SourcePosition where;
};
/// n, n and k, these over wavelength, or the name of a table.
struct Ior : schema::Located<std::variant<double, ConstantIor, MetalIor, TableIor, std::string>> {};
[[nodiscard]] schema::Kind kind(schema::Tag<Ior::Wrapped>);
[[nodiscard]] schema::Kind metal_ior();

/// An index, whose absorption may be said beside it.
struct TintedIor {
  Ior ior;
  std::optional<Curve> absorption_per_m;
};
[[nodiscard]] schema::Fields fields(schema::Tag<TintedIor>);

struct LayerEntry;
struct Layer {
  Ior ior;
  double thickness_nm = 0;
};
struct LayerGroup {
  std::int64_t repeat = 1;
  std::vector<LayerEntry> layers;
};
struct LayerEntry : schema::Located<std::variant<Layer, LayerGroup>> {};
/// Layers and repeated groups of them, from the outside inwards.
[[nodiscard]] schema::Kind kind(schema::Tag<std::vector<LayerEntry>>);

/// A width, or those along the x and y axes.
using Alpha = std::variant<double, std::array<double, 2>>;
struct Facets {
  Alpha alpha;
  FacetShape distribution = FacetShape::ggx;
};
struct Roughness : schema::Located<std::variant<double, std::array<double, 2>, Facets>> {};
[[nodiscard]] schema::Kind kind(schema::Tag<Roughness::Wrapped>);

}  // namespace abbe::spec

namespace abbe::description {

/// A refractive index, and what it is called.
struct Ior {
  std::string name;
  RefractiveIndex index;
};
/// Reports an unknown name; nothing then.
[[nodiscard]] std::optional<Ior> build(const spec::Ior& ior, LoadContext& context);
/// Reports absorption beside an index that brings its own; nothing then.
[[nodiscard]] std::optional<Ior> build(const spec::TintedIor& ior, LoadContext& context);
/// Reports too many layers or materials.
[[nodiscard]] Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context);
/// None of a surface so smooth that it is so. Reports a rough surface under a coating.
[[nodiscard]] std::optional<Microfacets<float>> build(const spec::Roughness& roughness,
                                                      const Coating& coating, LoadContext& context);

}  // namespace abbe::description
