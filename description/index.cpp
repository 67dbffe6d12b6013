#include "description/index.h"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "materials/index/library.h"
#include "materials/interface/coating.h"

namespace abbe::spec {

using namespace schema;

namespace {

constexpr Range kIndex{0, 100, true, false};  // Wider than any measured index.
constexpr Range kMetalIndex{0, 100};          // n = 0 is the perfect mirror.
constexpr Range kExtinction{0, 100};
constexpr Range kRepeats{1, static_cast<double>(Coating::kMaxLayers)};

template <typename Constant>
Fields describe_constant(std::string_view name, Range range) {
  double Constant::*n = &ConstantIor::n;
  double Constant::*k = &ConstantIor::k;
  return describe(name, "A constant index.",
                  {field("n", n, range, "The refractive index."),
                   defaulted("k", k, kExtinction, "Extinction coefficient, positive for absorption.")});
}

template <typename Constant>
ValueType index(std::string_view name, Range range) {
  return forms<Ior::Wrapped>(name, "an index: n, an object of n and k, or a name",
                             form<double>(Json::number, range),
                             form<TableIor>(Json::object, {"wavelength_nm"}), form<Constant>(Json::object),
                             form<std::string>(Json::text));
}

}  // namespace

static Fields fields(Tag<ConstantIor>) {
  return describe_constant<ConstantIor>("constant_index", kIndex);
}
static Fields fields(Tag<MetalIor>) {
  return describe_constant<MetalIor>("constant_metal_index", kMetalIndex);
}
static Fields fields(Tag<TableIor>) {
  return describe(
      "table_index", "A refractive index over wavelength, linearly interpolated.",
      {field("wavelength_nm", &TableIor::wavelength_nm, kTableWavelength,
             "Strictly ascending wavelengths; outside them the values of the ends hold."),
       field("n", &TableIor::n, kIndex, "Refractive index at each wavelength, relative to air."),
       field("k", &TableIor::k, kExtinction,
             "Extinction coefficient at each wavelength, positive for absorption; 0 if absent.")});
}
ValueType value_type(Tag<Ior::Wrapped>) {
  return index<ConstantIor>("index", kIndex);
}
ValueType metal_ior() {
  return index<MetalIor>("metal_index", kMetalIndex);
}

Fields fields(Tag<TintedIor>) {
  return describe(
      "tinted_index", "",
      {field("ior", &TintedIor::ior,
             "Refractive index: n above 0, n and k, a name of data/glass, MAKER/GLASS, or a "
             "FILE.csv or FILE.yml."),
       field("absorption_per_m", &TintedIor::absorption_per_m,
             "Absorption coefficient of the medium inside [1/m], 0 or more; only with an index without k.")});
}

static Fields fields(Tag<Layer>) {
  return describe("layer", "A coherent thin film.",
                  {field("ior", &Layer::ior, "Refractive index of the film."),
                   field("thickness_nm", &Layer::thickness_nm, kFilmThickness, "Thickness of the film.")});
}
static Fields fields(Tag<LayerGroup>) {
  return describe("layer_group", "Layers that repeat.",
                  {defaulted("repeat", &LayerGroup::repeat, kRepeats, "Number of repetitions."),
                   field("layers", &LayerGroup::layers, "Layers of one repetition.")});
}
ValueType value_type(Tag<std::vector<LayerEntry>>) {
  return list<LayerEntry>(
      forms<LayerEntry::Wrapped>("layer_entry", "a layer", form<LayerGroup>(Json::object, {"layers"}),
                                 form<Layer>(Json::object)),
      "layers", 1);
}

static Fields fields(Tag<Facets>) {
  using Pair = std::array<double, 2>;
  return describe(
      "facets", "A microfacet distribution.",
      {field("alpha", &Facets::alpha,
             forms<Alpha>("", "a width, or two", form<Pair>(Json::list, vector<Pair>(Range::unit())),
                          form<double>(Json::number, Range::unit())),
             "Roughness alpha, the width of the distribution of slopes: one value, or one along the surface "
             "coordinate u and one across it."),
       defaulted("distribution", &Facets::distribution,
                 enumeration<FacetShape>("distribution", {"ggx", "beckmann"}),
                 "Shape of the distribution of slopes.")});
}
ValueType value_type(Tag<Roughness::Wrapped>) {
  using Pair = std::array<double, 2>;
  return forms<Roughness::Wrapped>(
      "roughness", "a roughness: a width, two, or an object", form<Facets>(Json::object),
      form<Pair>(Json::list, vector<Pair>(Range::unit())), form<double>(Json::number, Range::unit()));
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// Extinction coefficient k = alpha lambda/(4 pi) of an absorption coefficient alpha [1/m], lambda in metres.
Curve extinction(const Curve& absorption_per_m) {
  const auto k = [](double nm) { return nm * 1e-9 / (4 * std::numbers::pi); };
  const Curve per_alpha(
      std::vector<Knot>{{kMinWavelengthNm, k(kMinWavelengthNm)}, {kMaxWavelengthNm, k(kMaxWavelengthNm)}});
  return product(absorption_per_m, per_alpha);
}

std::optional<NamedIndex> table_ior(const spec::TableIor& spec, LoadContext& context) {
  const auto curve = [&](const std::vector<double>& values) {
    spec::Curve table;
    table.where = spec.where;
    table.value =
        spec::CurveFormula{spec::TableCurve{spec.wavelength_nm, values, Outside::clamp, spec.where}};
    return build(table, {"", spec::kValue}, context);
  };
  const auto n = curve(spec.n);
  const auto k = spec.k ? curve(*spec.k) : Curve();
  if (!n || !k) return std::nullopt;
  return NamedIndex{
      "of a table", "",
      RefractiveIndex(*n, *k, IndexMedium::air, spec.wavelength_nm.front(), spec.wavelength_nm.back())};
}

NamedIndex constant_ior(double n, double k) {
  return {k > 0 ? fmt::format("{} + {}i", n, k) : fmt::format("{}", n), "", RefractiveIndex(n, k)};
}

Imath::V2f widths(double alpha) {
  return Imath::V2f(static_cast<float>(alpha));
}
Imath::V2f widths(const std::array<double, 2>& alpha) {
  return {static_cast<float>(alpha[0]), static_cast<float>(alpha[1])};
}
Imath::V2f widths(const spec::Facets& facets) {
  return std::visit([](const auto& alpha) { return widths(alpha); }, facets.alpha);
}

/// A coating under construction, with the first spec of each of its materials.
struct Films {
  Coating coating;
  std::vector<const spec::Ior*> specs;
};

// True if neither index is a table, or both are tables with the same data. The names of tables do not
// distinguish them.
bool same_tables(const spec::Ior& a, const spec::Ior& b) {
  const auto* one = std::get_if<spec::TableIor>(&a.value);
  const auto* other = std::get_if<spec::TableIor>(&b.value);
  if (one == nullptr || other == nullptr) return one == other;
  return std::tie(one->wavelength_nm, one->n, one->k) == std::tie(other->wavelength_nm, other->n, other->k);
}

// Index of the material of `spec` in the coating, added if it is new. Equal names, numbers or tables are the
// same material.
std::optional<std::uint32_t> film_material(const spec::Ior& spec, Films& films, LoadContext& context) {
  auto ior = build(spec, context);
  if (!ior) return std::nullopt;
  const auto* words = std::get_if<std::string>(&spec.value);
  const std::string name = words ? *words : ior->name;
  std::vector<Coating::Material>& materials = films.coating.materials;
  std::uint32_t number = 0;
  for (; number < materials.size(); ++number)
    if (materials[number].index_name == name && same_tables(*films.specs[number], spec)) return number;
  if (number == Coating::kMaxMaterials)
    return context.refuse(
        spec.where, fmt::format("too many materials in a coating (allowed {})", Coating::kMaxMaterials));
  materials.push_back({name, std::move(ior->index)});
  films.specs.push_back(&spec);
  return number;
}

void add_layers(const std::vector<spec::LayerEntry>& entries, Films& films, LoadContext& context) {
  std::vector<Coating::Layer>& layers = films.coating.layers;
  for (const spec::LayerEntry& entry : entries) {
    const std::size_t first = layers.size();
    std::int64_t repeats = 1;
    if (const auto* group = std::get_if<spec::LayerGroup>(&entry.value)) {
      repeats = group->repeat;
      add_layers(group->layers, films, context);
    } else {
      const auto& layer = std::get<spec::Layer>(entry.value);
      if (const auto material = film_material(layer.ior, films, context))
        layers.push_back({*material, layer.thickness_nm});
    }
    const std::size_t last = layers.size();
    if (first + (last - first) * static_cast<std::size_t>(repeats) > Coating::kMaxLayers)
      return context.diagnostics.error(entry.where,
                                       fmt::format("too many layers (allowed {})", Coating::kMaxLayers));
    for (; repeats > 1; --repeats)
      for (std::size_t i = first; i < last; ++i) layers.push_back(layers[i]);
  }
}

}  // namespace

std::optional<NamedIndex> build(const spec::Ior& spec, LoadContext& context) {
  if (const auto* n = std::get_if<double>(&spec.value)) return constant_ior(*n, 0);
  const auto* metal = std::get_if<spec::MetalIor>(&spec.value);
  if (const auto* constant = metal ? metal : std::get_if<spec::ConstantIor>(&spec.value))
    return constant_ior(constant->n, constant->k);
  if (const auto* table = std::get_if<spec::TableIor>(&spec.value)) return table_ior(*table, context);
  const auto name = context.table(std::get<std::string>(spec.value), spec.where);
  return name ? load_index(*name, spec.where, context.diagnostics) : std::nullopt;
}

std::optional<NamedIndex> build(const spec::TintedIor& spec, LoadContext& context) {
  auto ior = build(spec.ior, context);
  if (!ior || !spec.absorption_per_m) return ior;
  if (ior->index.absorbing())
    return context.refuse(spec.absorption_per_m->where,
                          "absorption_per_m requires an index without k; this index already has one");
  const auto alpha = build(*spec.absorption_per_m, {"filter", spec::kPower, CurveUnit::per_metre}, context);
  if (!alpha) return std::nullopt;
  ior->index = ior->index.with_k(extinction(*alpha));
  return ior;
}

std::optional<Microfacets<float>> build(const spec::Roughness& spec, const Coating& coating,
                                        LoadContext& context) {
  const Imath::V2f alpha = std::visit([](const auto& form) { return widths(form); }, spec.value);
  const auto* facets = std::get_if<spec::Facets>(&spec.value);
  const FacetShape shape = facets ? facets->distribution : FacetShape::ggx;
  constexpr auto min_alpha = static_cast<float>(kMinAlpha);
  if (std::max(alpha.x, alpha.y) < min_alpha) return std::nullopt;
  if (!coating.layers.empty()) context.diagnostics.error(spec.where, "a coating needs a smooth surface");
  const float wide = std::max(alpha.x, alpha.y);
  const float narrow = std::max(std::min(alpha.x, alpha.y), min_alpha);
  if (wide > narrow * static_cast<float>(kMaxAlphaRatio))
    context.diagnostics.error(
        spec.where, fmt::format("the two alphas must not differ by more than a factor of {} (got {} and {})",
                                kMaxAlphaRatio, alpha.x, alpha.y));
  return Microfacets<float>{shape, std::max(alpha.x, min_alpha), std::max(alpha.y, min_alpha)};
}

Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context) {
  Films films;
  add_layers(layers, films, context);
  return std::move(films.coating);
}

}  // namespace abbe::description
