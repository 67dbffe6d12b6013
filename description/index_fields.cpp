#include "description/index.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kIndex{0, 100, true, false};  // every measured index lies well inside
constexpr Range kMetalIndex{0, 100};          // n = 0 is the perfect mirror
constexpr Range kExtinction{0, 100};
constexpr Range kFilmThickness{0, 1e5, true, false};  // [nm]; nothing thicker is coherent
constexpr Range kRepeats{1, static_cast<double>(Coating::kMaxLayers)};

template <typename Constant>
Fields describe_constant(std::string_view name, Range range) {
  double Constant::*n = &ConstantIor::n;
  double Constant::*k = &ConstantIor::k;
  return describe<Constant>(
      name, "A constant index.",
      {field("n", n, number(range), "The refractive index."),
       field("k", k, number(kExtinction), "Extinction, absorbing when positive.").or_default()});
}

template <typename Constant>
Kind index(std::string_view name, Range range) {
  return forms<Ior::Wrapped>(name, "an index", form<double>(Json::number, number(range)),
                             form<Constant>(Json::object, thing<Constant>()),
                             form<std::string>(Json::any, text()));
}

}  // namespace

static const Fields& fields(Tag<ConstantIor>) {
  static const Fields kFields = describe_constant<ConstantIor>("constant_index", kIndex);
  return kFields;
}
static const Fields& fields(Tag<MetalIor>) {
  static const Fields kFields = describe_constant<MetalIor>("constant_metal_index", kMetalIndex);
  return kFields;
}
Kind ior() {
  return index<ConstantIor>("index", kIndex);
}
Kind metal_ior() {
  return index<MetalIor>("metal_index", kMetalIndex);
}

const Fields& fields(Tag<TintedIor>) {
  static const Fields kFields = describe<TintedIor>(
      "tinted_index", "",
      {field("ior", &TintedIor::ior, ior(),
             "Refractive index: n above 0, n and k, a name of data/glass, MAKER/GLASS, or a FILE.csv or "
             "FILE.yml."),
       field("absorption_per_m", &TintedIor::absorption_per_m, curve(),
             "Absorption coefficient inside, 0 or more, with a constant real index only.")});
  return kFields;
}

static const Fields& fields(Tag<Layer>) {
  static const Fields kFields = describe<Layer>(
      "layer", "A coherent thin film.",
      {field("ior", &Layer::ior, ior(), "Its refractive index."),
       field("thickness_nm", &Layer::thickness_nm, number(kFilmThickness), "Its thickness.")});
  return kFields;
}
static const Fields& fields(Tag<LayerGroup>) {
  static const Fields kFields = describe<LayerGroup>(
      "layer_group", "Layers that repeat.",
      {field("repeat", &LayerGroup::repeat, integer<std::int64_t>(kRepeats), "How often they stand there.")
           .or_default(),
       field("layers", &LayerGroup::layers, layers(), "What repeats.")});
  return kFields;
}
Kind layers() {
  return list<LayerEntry>(
      forms<LayerEntry::Wrapped>("layer_entry", "a layer",
                                 form<LayerGroup>(Json::object, thing<LayerGroup>(), {"layers"}),
                                 form<Layer>(Json::any, thing<Layer>())),
      "layers", 1);
}

static const Fields& fields(Tag<Facets>) {
  using Pair = std::array<double, 2>;
  static const Fields kFields = describe<Facets>(
      "facets", "Microfacets.",
      {field("alpha", &Facets::alpha,
             forms<Alpha>("", "a width", form<Pair>(Json::list, vector<Pair>(Range::unit())),
                          form<double>(Json::any, number(Range::unit()))),
             "Width of their slopes, or widths along the surface coordinate u and across it."),
       field("distribution", &Facets::distribution, word<FacetShape>("distribution", {"ggx", "beckmann"}),
             "How their slopes are distributed.")
           .or_default()});
  return kFields;
}
Kind roughness() {
  using Pair = std::array<double, 2>;
  return forms<Roughness::Wrapped>("roughness", "a roughness", form<Facets>(Json::object, thing<Facets>()),
                                   form<Pair>(Json::list, vector<Pair>(Range::unit())),
                                   form<double>(Json::any, number(Range::unit())));
}

}  // namespace abbe::spec
