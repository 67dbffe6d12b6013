#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "materials/material.h"

// Interfaces of media: refractive indices, coatings and roughness.
namespace abbe::spec {

struct ConstantIor {
  double n = 1;
  double k = 0;
};
struct MetalIor : ConstantIor {};  ///< n may be 0: the perfect mirror.
/// Samples of n and k, linearly interpolated, constant outside their range.
struct TableIor {
  std::vector<double> wavelength_nm;
  std::vector<double> n;
  std::optional<std::vector<double>> k;  ///< 0 if absent.
  SourcePosition where;
};
/// A refractive index: n, n and k, a table of both over wavelength, or the name of a table.
struct Ior : schema::Located<std::variant<double, ConstantIor, MetalIor, TableIor, std::string>> {};
[[nodiscard]] schema::ValueType value_type(schema::Tag<Ior::Wrapped>);
/// The kind of an index that may be that of a metal, whose n may be 0.
[[nodiscard]] schema::ValueType metal_ior();

/// A refractive index with an optional absorption coefficient [1/m].
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
/// A list of layers and repeated groups of layers, from the outside inwards.
[[nodiscard]] schema::ValueType value_type(schema::Tag<std::vector<LayerEntry>>);

/// Microfacet roughness alpha: one value, or one along the surface coordinate u and one across it.
using Alpha = std::variant<double, std::array<double, 2>>;
struct Facets {
  Alpha alpha;
  FacetShape distribution = FacetShape::ggx;
};
struct Roughness : schema::Located<std::variant<double, std::array<double, 2>, Facets>> {};
[[nodiscard]] schema::ValueType value_type(schema::Tag<Roughness::Wrapped>);

}  // namespace abbe::spec

namespace abbe::description {

/// A refractive index and its name for messages.
struct Ior {
  std::string name;
  RefractiveIndex index;
};
/// Builds a refractive index. Returns nothing after an error, such as an unknown name.
[[nodiscard]] std::optional<Ior> build(const spec::Ior& ior, LoadContext& context);
/// Builds a refractive index with its absorption. Returns nothing after an error, such as an absorption
/// coefficient with an index that already has a k.
[[nodiscard]] std::optional<Ior> build(const spec::TintedIor& ior, LoadContext& context);
/// Builds a coating. Reports too many layers or materials.
[[nodiscard]] Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context);
/// Builds the microfacet distribution; nothing if the surface is so smooth that it counts as specular.
/// Reports a rough surface under a coating, and alphas that differ by too large a factor.
[[nodiscard]] std::optional<Microfacets<float>> build(const spec::Roughness& roughness,
                                                      const Coating& coating, LoadContext& context);

}  // namespace abbe::description
