#include "description/index.h"

#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "materials/index/library.h"
#include "materials/interface/coating.h"

namespace abbe::spec {
namespace {

using namespace schema;

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

std::optional<Ior> table_ior(const spec::TableIor& spec, LoadContext& context) {
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
  return Ior{"of a table", RefractiveIndex(*n, *k, IndexMedium::air, spec.wavelength_nm.front(),
                                           spec.wavelength_nm.back())};
}

Ior constant_ior(double n, double k) {
  return {k > 0 ? fmt::format("{} + {}i", n, k) : fmt::format("{}", n), RefractiveIndex(n, k)};
}

}  // namespace

std::optional<Ior> build(const spec::Ior& spec, LoadContext& context) {
  if (const auto* n = std::get_if<double>(&spec.value)) return constant_ior(*n, 0);
  if (const auto* constant = std::get_if<spec::ConstantIor>(&spec.value))
    return constant_ior(constant->n, constant->k);
  if (const auto* constant = std::get_if<spec::MetalIor>(&spec.value))
    return constant_ior(constant->n, constant->k);
  if (const auto* table = std::get_if<spec::TableIor>(&spec.value)) return table_ior(*table, context);
  const auto name = context.table(std::get<std::string>(spec.value), spec.where);
  if (!name) return std::nullopt;
  auto named = load_index(*name, spec.where, context.diagnostics);
  if (!named) return std::nullopt;
  return Ior{std::move(named->name), std::move(named->index)};
}

std::optional<Ior> build(const spec::TintedIor& spec, LoadContext& context) {
  auto ior = build(spec.ior, context);
  if (!ior || !spec.absorption_per_m) return ior;
  if (ior->index.absorbing()) {
    context.diagnostics.error(spec.absorption_per_m->where,
                              "absorption_per_m requires an index without k; this index already has one");
    return std::nullopt;
  }
  const auto alpha = build(*spec.absorption_per_m, {"filter", spec::kPower, CurveUnit::per_metre}, context);
  if (!alpha) return std::nullopt;
  ior->index = ior->index.with_k(extinction(*alpha));
  return ior;
}

}  // namespace abbe::description
