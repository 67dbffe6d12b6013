#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "materials/index/catalogue.h"
#include "materials/material.h"

// Interfaces of media: refractive indices, coatings and roughness, as scene files describe them. Indices are
// relative to air. Functions `build` report errors to `context.diagnostics`.
namespace abbe::spec {

/// The index n + ik at all wavelengths, with n in (0, 100] and k in [0, 100].
struct ConstantIor {
  double n = 1;
  double k = 0;
};
struct MetalIor : ConstantIor {};  ///< n may be 0: the perfect mirror.
/// Samples of n and k, linearly interpolated, constant outside their range.
struct TableIor {
  std::vector<double> wavelength_nm;     ///< Strictly ascending.
  std::vector<double> n;                 ///< One value per wavelength.
  std::optional<std::vector<double>> k;  ///< 0 if absent.
  SourcePosition where;
};
/// A refractive index: n, n and k, a table of both over wavelength, or the name of a table.
struct Ior : schema::Located<std::variant<double, ConstantIor, MetalIor, TableIor, std::string>> {};
// Key tables and forms by which scene files are read, written and documented.
[[nodiscard]] schema::ValueType value_type(schema::Tag<Ior::Wrapped>);
/// The form in which scene files write an index that may be that of a metal, whose n may be 0.
[[nodiscard]] schema::ValueType metal_ior();

/// A refractive index with an optional absorption coefficient [1/m].
struct TintedIor {
  Ior ior;
  std::optional<Curve> absorption_per_m;  ///< 0 or more; only for an index without k. None if absent.
};
[[nodiscard]] schema::Fields fields(schema::Tag<TintedIor>);

struct LayerEntry;
/// A coherent thin film.
struct Layer {
  Ior ior;
  double thickness_nm = 0;
};
/// Layers that repeat `repeat` times.
struct LayerGroup {
  std::int64_t repeat = 1;
  std::vector<LayerEntry> layers;
};
struct LayerEntry : schema::Located<std::variant<Layer, LayerGroup>> {};
/// A list of layers and repeated groups of layers, from the outside inwards.
[[nodiscard]] schema::ValueType value_type(schema::Tag<std::vector<LayerEntry>>);

/// Microfacet roughness alpha: one value, or one along the surface coordinate u and one across it.
using Alpha = std::variant<double, std::array<double, 2>>;
/// A microfacet distribution.
struct Facets {
  Alpha alpha;
  FacetShape distribution = FacetShape::ggx;
};
/// A roughness: alpha of GGX, two alphas, or a distribution with its alphas. All alphas are in [0, 1].
struct Roughness : schema::Located<std::variant<double, std::array<double, 2>, Facets>> {};
[[nodiscard]] schema::ValueType value_type(schema::Tag<Roughness::Wrapped>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds a refractive index; nothing after an error, such as an unknown name. Its name for messages is that
/// of its table, or its numbers.
[[nodiscard]] std::optional<NamedIndex> build(const spec::Ior& ior, LoadContext& context);
/// Builds a refractive index whose k follows from the absorption coefficient alpha: k = alpha lambda/(4 pi).
/// Reports an absorption coefficient with an index that already has a k.
[[nodiscard]] std::optional<NamedIndex> build(const spec::TintedIor& ior, LoadContext& context);
/// Builds a coating, with its layers from the outside inwards; empty for an empty list. Reports more than 256
/// layers or 16 materials, and the errors of indices; layers with an error are missing in the result.
[[nodiscard]] Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context);
/// Builds the microfacet distribution. Nothing if both alphas are below 1e-3, so that the surface counts as
/// specular; a single smaller alpha becomes 1e-3. Reports a rough surface under a coating, and alphas that
/// differ by a factor above 20; the result is then still given.
[[nodiscard]] std::optional<Microfacets<float>> build(const spec::Roughness& roughness,
                                                      const Coating& coating, LoadContext& context);

}  // namespace abbe::description
