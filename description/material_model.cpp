#include <algorithm>
#include <concepts>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/material.h"
#include "materials/interface/fresnel.h"

namespace abbe::spec {
namespace {

using namespace schema;

// Beyond it a cosine's float says nothing about the peak.
constexpr double kMostPeaked = 0.9999;
constexpr Range kSigma = Range{0, 90}.in("degrees");
constexpr Range kExponent{0, 1e4};

constexpr char kCoating[] = "Coherent thin films on the surface, from the outside inwards.";
constexpr char kRoughness[] =
    "Width of the slopes of microfacets in [0, 1], below 1e-3 smooth, or widths along u and across it; not "
    "under a coating.";

template <typename T>
Field amount(std::string_view key, double T::*member, std::string_view text) {
  return defaulted(key, member, Range::unit(), text);
}

template <typename P>
std::vector<Field> power() {
  Reflectance P::*reflectance = &Power::reflectance;
  double P::*exponent = &Power::exponent;
  return {field("reflectance", reflectance, "Reflectance of the lobe, in [0, 1]."),
          field("exponent", exponent, kExponent, "Power of the cosine.")};
}

}  // namespace

static Fields fields(Tag<HenyeyGreenstein>) {
  return describe(
      "henyey_greenstein", "Henyey and Greenstein's phase function.",
      {field("henyey_greenstein", &HenyeyGreenstein::g, {-kMostPeaked, kMostPeaked}, "Its mean cosine.")});
}

static Fields fields(Tag<Scattering>) {
  using Phase = std::variant<PhaseWord, HenyeyGreenstein>;
  return describe("scattering", "",
                  {field("scattering_per_m", &Scattering::per_m,
                         "Scattering coefficient inside [1/m], 0 or more, 0 when absent."),
                   field("phase", &Scattering::phase,
                         forms<Phase>("phase", "a phase function: a name or an object",
                                      form<PhaseWord>(Json::text, word<PhaseWord>("phase function",
                                                                                  {"isotropic", "rayleigh"})),
                                      form<HenyeyGreenstein>(Json::object)),
                         "How matter scatters, isotropic when absent.")});
}

static Fields fields(Tag<Grid>) {
  return describe(
      "grid", "Densities that multiply absorption and scattering.",
      {field("densities", &Grid::densities, "A NumPy file of axes z, y, x."),
       field("from", &Grid::from, kCoordinate, "Position of the first node."),
       field("to", &Grid::to, kCoordinate, "Position of the last node, beyond the first along x, y and z.")});
}

static Fields fields(Tag<Diffuse>) {
  return describe("diffuse", "Lambertian matter, both sides alike.",
                  {field("reflectance", &Diffuse::reflectance, "Reflectance in [0, 1].")});
}

static Fields fields(Tag<Dielectric>) {
  return describe("dielectric",
                  "An interface between the matter inside a closed shape and what is around it.",
                  {lent(&Dielectric::ior), lent(&Dielectric::scattering),
                   defaulted("coating", &Dielectric::coating, kCoating),
                   field("roughness", &Dielectric::roughness, kRoughness)});
}

static Fields fields(Tag<Conductor>) {
  return describe("conductor", "An opaque metal.",
                  {field("ior", &Conductor::ior, metal_ior(),
                         "Refractive index: n, n and k, a name of data/metal, or a FILE.csv or FILE.yml."),
                   defaulted("coating", &Conductor::coating, kCoating),
                   field("roughness", &Conductor::roughness, kRoughness)});
}

static Fields fields(Tag<Film>) {
  return describe("film", "Thin films with the same matter on both sides, such as a soap bubble's.",
                  {field("layers", &Film::layers, "The films.")});
}

static Fields fields(Tag<Medium>) {
  return describe("medium", "Matter without an interface, such as fog or smoke.",
                  {field("absorption_per_m", &Medium::absorption_per_m,
                         "Absorption coefficient [1/m], 0 or more, 0 when absent."),
                   lent(&Medium::scattering),
                   field("grid", &Medium::grid,
                         "Densities that multiply absorption and scattering; 1 everywhere when absent.")});
}

static Fields fields(Tag<CoatedDiffuse>) {
  return describe(
      "coated_diffuse", "Lambertian ground under a smooth clear coat.",
      {field("ior", &CoatedDiffuse::ior, "Index of the coat; n is 1 or more, and k next to nothing."),
       field("reflectance", &CoatedDiffuse::reflectance, "Reflectance of the bare ground, in [0, 1].")});
}

static Fields fields(Tag<ThinGlass>) {
  return describe(
      "thin_glass", "A pane as one surface, which light crosses without being bent.",
      {lent(&ThinGlass::ior), defaulted("thickness", &ThinGlass::thickness, Range{0, kMaxLength}.in("units"),
                                        "Length of its thickness; 0 absorbs nothing.")});
}

static Fields fields(Tag<Mirror>) {
  return describe("mirror", "The ideal mirror.",
                  {field("reflectance", &Mirror::reflectance, "Reflectance in [0, 1], at every angle.")});
}

static Fields fields(Tag<Schlick>) {
  return describe("schlick", "A smooth mirror by Schlick's approximation, to compare with.",
                  {one_of(&Schlick::normal, under<Ior>("ior", metal_ior(), "Refractive index."),
                          under<Reflectance>("reflectance", "Reflectance along the normal, in [0, 1]."))});
}

static Fields fields(Tag<OrenNayar>) {
  return describe("oren_nayar", "Rough diffuse matter.",
                  {field("reflectance", &OrenNayar::reflectance, "Reflectance in [0, 1]."),
                   field("sigma_deg", &OrenNayar::sigma_deg, kSigma, "Standard deviation of its slopes.")});
}

static Fields fields(Tag<Principled>) {
  return describe(
      "principled", "Burley's principled model.",
      {field("base_color", &Principled::base_color, "Reflectance in [0, 1]."),
       amount("metallic", &Principled::metallic, "How much of it is metal."),
       amount("roughness", &Principled::roughness, "The facets' width is its square."),
       amount("specular", &Principled::specular,
              "Reflectance along the normal of what is no metal, over 0.08."),
       amount("sheen", &Principled::sheen, "As of cloth at grazing angles."),
       amount("clearcoat", &Principled::clearcoat, "Strength of a second highlight."),
       amount("clearcoat_gloss", &Principled::clearcoat_gloss, "How narrow the second highlight is.")});
}

static Fields fields(Tag<CosinePower>) {
  std::vector<Field> fields = power<CosinePower>();
  fields.push_back(defaulted("reciprocal", &CosinePower::reciprocal, "Whether it is of both."));
  return describe("cosine_power", "A power of the cosine of light's direction, or of both directions.",
                  std::move(fields));
}
static Fields fields(Tag<Phong>) {
  return describe("phong", "Phong's highlight, which breaks reciprocity and makes energy.", power<Phong>());
}
static Fields fields(Tag<Retroreflector>) {
  return describe("retroreflector", "A lobe back to where light comes from.", power<Retroreflector>());
}

static Fields fields(Tag<MixturePart>) {
  return describe("mixture_part", "A part of a mixture.",
                  {field("material", &MixturePart::material,
                         "A material that is no mixture and that light does not enter."),
                   field("weight", &MixturePart::weight, "Its share, in [0, 1].")});
}

static Fields fields(Tag<NormalMap>) {
  return describe("normal_map",
                  "Channels R, G, B in [0, 1], which stand for [-1, 1] along u, v and the outward normal.",
                  {lent(&NormalMap::file)});
}
static Fields fields(Tag<BumpMap>) {
  return describe("bump_map", "One channel of heights above the surface.",
                  {field("height", &BumpMap::height, kCoordinate, "Length that a value of 1 stands for."),
                   lent(&BumpMap::file)});
}

Fields fields(Tag<Material>) {
  return describe(
      "material", "What a surface is made of, or what is inside.",
      {one_of(&Material::model,
              under<Mixture>("mixture", list<MixturePart>("parts", 1),
                             "Other materials side by side, whose weights add up to at most 1."),
              under<Diffuse>("diffuse"), under<Dielectric>("dielectric"), under<Conductor>("conductor"),
              under<Film>("film"), under<Medium>("medium"), under<CoatedDiffuse>("coated_diffuse"),
              under<ThinGlass>("thin_glass"), under<Mirror>("mirror"), under<Schlick>("schlick"),
              under<OrenNayar>("oren_nayar"), under<Principled>("principled"),
              under<CosinePower>("cosine_power"), under<Phong>("phong"),
              under<Retroreflector>("retroreflector"), under<Polariser>("polariser"),
              under<WavePlate>("wave_plate"), under<Depolariser>("depolariser")),
       field(
           "priority", &Material::priority, {-1000, 1000},
           "Of the matter within a shape, 0 when absent: where shapes overlap, that of the highest priority "
           "is there, of equals that of the smallest shape."),
       at_most_one(&Material::relief, "a material has a normal_map or a bump_map",
                   under<NormalMap>("normal_map"), under<BumpMap>("bump_map"))});
}

Kind materials() {
  return by_name<Material>("an object of materials by name", 0);
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// Why `index` cannot be a coat's, if it cannot.
std::optional<std::string> coat_fault(const RefractiveIndex& index) {
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) {
    if (index.n(nm) < 1)
      return fmt::format("a coat is denser than air (got n = {:g} at {} nm)", index.n(nm), nm);
    if (index.k(nm) > kLargestGlassK)
      return fmt::format("a coat is clear (got k = {:g} at {} nm, allowed [0, {:g}])", index.k(nm), nm,
                         kLargestGlassK);
  }
  return std::nullopt;
}

// What matter of this index reflects along the normal.
Curve normal_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
  return Curve(std::move(knots));
}

// Where the user says by numbers that matter absorbs, if at all: tables of glass tell of traces.
const SourcePosition* where_absorption_is_said(const spec::TintedIor& said) {
  if (said.absorption_per_m) return &said.absorption_per_m->where;
  const auto* constant = std::get_if<spec::ConstantIor>(&said.ior.value);
  const auto* table = std::get_if<spec::TableIor>(&said.ior.value);
  const auto absorbs = [](const std::vector<double>& k) {
    return std::ranges::any_of(k, [](double v) { return v > 0; });
  };
  return (constant != nullptr && constant->k > 0) || (table != nullptr && table->k && absorbs(*table->k))
             ? &said.ior.where
             : nullptr;
}

// The material of its first part and more, if that could be built.
template <typename M, typename Part, typename... More>
std::optional<MaterialModel> made(std::optional<Part> part, More... more) {
  if (!part) return std::nullopt;
  return M{*std::move(part), more...};
}

/// Each material of the list from what is said of it; none after an error.
struct ModelBuilder {
  using Model = std::optional<MaterialModel>;
  LoadContext& context;

  Model operator()(std::monostate) const { return std::nullopt; }
  Model operator()(const spec::Mixture&) const { return MixtureMaterial{}; }  // whose parts come later
  Model operator()(const spec::Diffuse& said) const {
    return made<DiffuseMaterial>(build(said.reflectance, context));
  }
  Model operator()(const spec::Dielectric& said) const {
    auto ior = build(said.ior, context);
    auto filling = build(said.scattering, std::nullopt, context);
    Coating coating = build(said.coating, context);
    const auto facets = said.roughness ? build(*said.roughness, coating, context) : std::nullopt;
    if (!ior || !filling) return std::nullopt;
    if (!filling->scatters()) filling.reset();
    if (facets)
      return RoughDielectricMaterial(std::move(ior->name), std::move(ior->index), *facets,
                                     std::move(filling));
    return DielectricMaterial{std::move(ior->name), std::move(ior->index), std::move(coating),
                              std::move(filling)};
  }
  Model operator()(const spec::Conductor& said) const {
    auto ior = build(said.ior, context);
    Coating coating = build(said.coating, context);
    const auto facets = said.roughness ? build(*said.roughness, coating, context) : std::nullopt;
    if (!ior) return std::nullopt;
    if (facets) return RoughConductorMaterial(std::move(ior->name), std::move(ior->index), *facets);
    return ConductorMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
  }
  Model operator()(const spec::Film& said) const { return FilmMaterial{build(said.layers, context)}; }
  Model operator()(const spec::Medium& said) const {
    auto filling = build(said.scattering, said.absorption_per_m, context);
    if (!filling) return std::nullopt;
    if (said.grid && !said.absorption_per_m && !said.scattering.per_m)
      context.diagnostics.warning(said.grid->where,
                                  "a grid without effect: without absorption_per_m and scattering_per_m "
                                  "there is nothing that its densities multiply");
    if (said.grid && !(filling->grid = build(*said.grid, context))) return std::nullopt;
    return MediumMaterial{std::move(*filling)};
  }
  Model operator()(const spec::CoatedDiffuse& said) const {
    auto ior = build(said.ior, context);
    auto reflectance = build(said.reflectance, context);
    if (!ior || !reflectance) return std::nullopt;
    if (const auto fault = coat_fault(ior->index)) {
      context.diagnostics.error(said.ior.where, *fault);
      return std::nullopt;
    }
    return CoatedDiffuseMaterial{std::move(ior->name), std::move(ior->index), std::move(*reflectance)};
  }
  Model operator()(const spec::ThinGlass& said) const {
    auto ior = build(said.ior, context);
    const SourcePosition* absorption = where_absorption_is_said(said.ior);
    if (absorption != nullptr && said.thickness == 0)
      context.diagnostics.warning(*absorption,
                                  "an absorption without effect: without a thickness nothing is absorbed");
    if (!ior) return std::nullopt;
    return ThinGlassMaterial{std::move(ior->name), std::move(ior->index), said.thickness * context.unit_m};
  }
  Model operator()(const spec::Mirror& said) const {
    return made<MirrorMaterial>(build(said.reflectance, context));
  }
  Model operator()(const spec::Schlick& said) const {
    std::optional<SpectralTexture> r0;
    if (const auto* reflectance = std::get_if<spec::Reflectance>(&said.normal))
      r0 = build(*reflectance, context);
    else if (const auto ior = build(std::get<spec::Ior>(said.normal), context))
      r0 = normal_reflectance(ior->index);
    return made<SchlickMaterial>(std::move(r0));
  }
  Model operator()(const spec::OrenNayar& said) const {
    return made<OrenNayarMaterial>(build(said.reflectance, context), said.sigma_deg);
  }
  Model operator()(const spec::Principled& said) const {
    const auto amount = [](double x) { return static_cast<float>(x); };
    const PrincipledLook look{amount(said.metallic), amount(said.roughness), amount(said.specular),
                              amount(said.sheen),    amount(said.clearcoat), amount(said.clearcoat_gloss)};
    return made<PrincipledMaterial>(build(said.base_color, context), Principled(look));
  }
  Model operator()(const spec::CosinePower& said) const {
    return made<CosinePowerMaterial>(build(said.reflectance, context), said.exponent, said.reciprocal);
  }
  Model operator()(const spec::Phong& said) const {
    return made<PhongMaterial>(build(said.reflectance, context), said.exponent);
  }
  Model operator()(const spec::Retroreflector& said) const {
    return made<RetroreflectorMaterial>(build(said.reflectance, context), said.exponent);
  }
  template <std::derived_from<spec::ThinElement> Element>
  Model operator()(const Element& said) const {
    return build(said, context);
  }
};

}  // namespace

std::optional<MaterialModel> build_model(const spec::Material& material, LoadContext& context) {
  return std::visit(ModelBuilder{context}, material.model);
}

}  // namespace abbe::description
