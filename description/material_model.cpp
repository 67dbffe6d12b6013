#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/material.h"
#include "materials/interface/fresnel.h"
#include "sampling/angle.h"

namespace abbe::spec {

using namespace schema;

namespace {

// Largest mean cosine. Above it, the cosine in single precision does not resolve the peak.
constexpr double kMaxMeanCosine = 0.9999;
constexpr Range kSigma = Range{0, 90}.in("degrees");
constexpr Range kExponent{0, 1e4};

constexpr char kCoating[] = "Coherent thin films on the surface, from the outside inwards.";
constexpr char kRoughness[] =
    "Roughness alpha of the microfacets in [0, 1], or two values along the surface coordinate u and across "
    "it. Below 1e-3 the surface is smooth. Not allowed with a coating.";

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

template <typename Element>
Field transmittance(std::string_view text) {
  std::optional<Curve> Element::*member = &ThinElement::transmittance;
  return field("transmittance", member, text);
}

}  // namespace

static Fields fields(Tag<HenyeyGreenstein>) {
  return describe("henyey_greenstein", "Henyey and Greenstein's phase function.",
                  {field("henyey_greenstein", &HenyeyGreenstein::g, {-kMaxMeanCosine, kMaxMeanCosine},
                         "Mean cosine of the scattering angle.")});
}

static Fields fields(Tag<Scattering>) {
  using Phase = std::variant<PhaseWord, HenyeyGreenstein>;
  return describe(
      "scattering", "",
      {field("scattering_per_m", &Scattering::per_m,
             "Scattering coefficient of the medium [1/m], 0 or more; 0 if absent."),
       field("phase", &Scattering::phase,
             forms<Phase>("phase", "a phase function: a name or an object",
                          form<PhaseWord>(Json::text, enumeration<PhaseWord>("phase function",
                                                                             {"isotropic", "rayleigh"})),
                          form<HenyeyGreenstein>(Json::object)),
             "Phase function of the medium; isotropic if absent.")});
}

static Fields fields(Tag<Grid>) {
  return describe("grid", "Densities that multiply absorption and scattering.",
                  {field("densities", &Grid::densities, "A NumPy file of axes z, y, x."),
                   field("from", &Grid::from, kCoordinate, "Position of the first node."),
                   field("to", &Grid::to, kCoordinate,
                         "Position of the last node, greater than the first along x, y and z.")});
}

static Fields fields(Tag<Diffuse>) {
  return describe("diffuse", "Lambertian reflection on both sides.",
                  {field("reflectance", &Diffuse::reflectance, "Reflectance in [0, 1].")});
}

static Fields fields(Tag<Dielectric>) {
  return describe("dielectric",
                  "An interface between the medium inside a closed shape and the medium around it.",
                  {inlined(&Dielectric::ior), inlined(&Dielectric::scattering),
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
  return describe("film", "Thin films with the same medium on both sides, such as a soap bubble.",
                  {field("layers", &Film::layers, "The films.")});
}

static Fields fields(Tag<Medium>) {
  return describe("medium", "A medium without an interface, such as fog or smoke.",
                  {field("absorption_per_m", &Medium::absorption_per_m,
                         "Absorption coefficient [1/m], 0 or more; 0 if absent."),
                   inlined(&Medium::scattering),
                   field("grid", &Medium::grid,
                         "Densities that multiply absorption and scattering; 1 everywhere if absent.")});
}

static Fields fields(Tag<CoatedDiffuse>) {
  return describe(
      "coated_diffuse", "A Lambertian base under a smooth clear coat.",
      {field("ior", &CoatedDiffuse::ior, "Refractive index of the coat; n is 1 or more, k practically 0."),
       field("reflectance", &CoatedDiffuse::reflectance,
             "Reflectance of the base without its coat, in [0, 1].")});
}

static Fields fields(Tag<ThinGlass>) {
  return describe("thin_glass", "A pane modelled as one surface, which light crosses without deflection.",
                  {inlined(&ThinGlass::ior),
                   defaulted("thickness", &ThinGlass::thickness, Range{0, kMaxLength}.in("units"),
                             "Thickness of the pane; 0 for no absorption.")});
}

static Fields fields(Tag<Mirror>) {
  return describe("mirror", "An ideal mirror.",
                  {field("reflectance", &Mirror::reflectance, "Reflectance in [0, 1], at every angle.")});
}

static Fields fields(Tag<Schlick>) {
  return describe("schlick", "A smooth mirror with Schlick's approximation, for comparisons.",
                  {one_of(&Schlick::normal, under<Ior>("ior", metal_ior(), "Refractive index."),
                          under<Reflectance>("reflectance", "Reflectance along the normal, in [0, 1]."))});
}

static Fields fields(Tag<OrenNayar>) {
  return describe(
      "oren_nayar", "A rough diffuse surface.",
      {field("reflectance", &OrenNayar::reflectance, "Reflectance in [0, 1]."),
       field("sigma_deg", &OrenNayar::sigma_deg, kSigma, "Standard deviation of the facets' slope angles.")});
}

static Fields fields(Tag<Principled>) {
  return describe(
      "principled", "Burley's principled model.",
      {field("base_color", &Principled::base_color, "Reflectance in [0, 1]."),
       amount("metallic", &Principled::metallic, "Fraction of metallic reflection."),
       amount("roughness", &Principled::roughness, "Roughness; the microfacet alpha is its square."),
       amount("specular", &Principled::specular,
              "Reflectance of the non-metallic part at normal incidence, divided by 0.08."),
       amount("sheen", &Principled::sheen, "Strength of a cloth-like sheen at grazing angles."),
       amount("clearcoat", &Principled::clearcoat, "Strength of a second highlight."),
       amount("clearcoat_gloss", &Principled::clearcoat_gloss,
              "Gloss of the second highlight; larger is narrower.")});
}

static Fields fields(Tag<CosinePower>) {
  std::vector<Field> fields = power<CosinePower>();
  fields.push_back(
      defaulted("reciprocal", &CosinePower::reciprocal, "True to apply the power to both cosines."));
  return describe("cosine_power", "A power of the cosine of the direction of light, or of both directions.",
                  std::move(fields));
}
static Fields fields(Tag<Phong>) {
  return describe("phong", "Phong's highlight, which is not reciprocal and does not conserve energy.",
                  power<Phong>());
}
static Fields fields(Tag<Retroreflector>) {
  return describe("retroreflector", "A lobe around the direction from which light comes.",
                  power<Retroreflector>());
}

static Fields fields(Tag<MixturePart>) {
  return describe("mixture_part", "A component of a mixture.",
                  {field("material", &MixturePart::material,
                         "A material that is not a mixture and has no medium inside."),
                   field("weight", &MixturePart::weight, "Weight of the component, in [0, 1].")});
}

static Fields fields(Tag<NormalMap>) {
  return describe("normal_map",
                  "Channels R, G, B in [0, 1], which encode [-1, 1] along u, v and the outward normal.",
                  {inlined(&NormalMap::file)});
}
static Fields fields(Tag<BumpMap>) {
  return describe(
      "bump_map", "One channel of heights above the surface.",
      {field("height", &BumpMap::height, kCoordinate, "Height for a value of 1."), inlined(&BumpMap::file)});
}

static Fields fields(Tag<Polariser>) {
  return describe(
      "polariser", "A linear polariser modelled as one surface, which light crosses without deflection.",
      {transmittance<Polariser>("Transmittance of light polarised along the axis, in [0, 1]; 1 if absent."),
       field("extinction_ratio", &Polariser::extinction_ratio,
             "Transmittance along the axis over that across it, 1 or more; infinite if absent."),
       defaulted("angle_deg", &Polariser::angle_deg, kAngle,
                 "Angle of its axis to u, counter-clockwise as seen from outside.")});
}
static Fields fields(Tag<Retardance>) {
  return describe("retardance", "The same retardance at all wavelengths.",
                  {field("retardance_deg", &Retardance::retardance_deg, kAngle,
                         "Phase lag of the field across the fast axis, at all wavelengths.")});
}
static Fields fields(Tag<Crystal>) {
  return describe("crystal", "A plate of a birefringent crystal.",
                  {field("birefringence", &Crystal::birefringence,
                         "Refractive index along the slow axis minus that along the fast axis, relative to "
                         "air, in [0, 10]."),
                   field("thickness", &Crystal::thickness, kLength, "Thickness of the plate.")});
}
static Fields fields(Tag<WavePlate>) {
  return describe("wave_plate",
                  "A wave plate modelled as one surface, which light crosses without deflection.",
                  {transmittance<WavePlate>("Transmittance, in [0, 1]; 1 if absent."),
                   one_of(&WavePlate::kind, inlined_by<Retardance>("retardance_deg"),
                          inlined_by<Crystal>("birefringence")),
                   defaulted("angle_deg", &WavePlate::angle_deg, kAngle,
                             "Angle of its fast axis to u, counter-clockwise as seen from outside.")});
}
static Fields fields(Tag<Depolariser>) {
  return describe("depolariser", "A surface that transmits light without deflection and depolarises it.",
                  {transmittance<Depolariser>("Transmittance, in [0, 1]; 1 if absent.")});
}

Fields fields(Tag<Material>) {
  return describe(
      "material", "Optical properties of a surface or of the medium inside.",
      {one_of(&Material::model,
              under<Mixture>("mixture", list<MixturePart>("parts", 1),
                             "Other materials side by side. Their weights must add up to at most 1."),
              under<Diffuse>("diffuse"), under<Dielectric>("dielectric"), under<Conductor>("conductor"),
              under<Film>("film"), under<Medium>("medium"), under<CoatedDiffuse>("coated_diffuse"),
              under<ThinGlass>("thin_glass"), under<Mirror>("mirror"), under<Schlick>("schlick"),
              under<OrenNayar>("oren_nayar"), under<Principled>("principled"),
              under<CosinePower>("cosine_power"), under<Phong>("phong"),
              under<Retroreflector>("retroreflector"), under<Polariser>("polariser"),
              under<WavePlate>("wave_plate"), under<Depolariser>("depolariser")),
       field("priority", &Material::priority, {-1000, 1000},
             "Priority of the medium inside a shape, 0 if absent. Where shapes overlap, the medium of "
             "highest priority applies; of equal priorities, that of the smallest shape."),
       at_most_one(&Material::relief, "a material has a normal_map or a bump_map",
                   under<NormalMap>("normal_map"), under<BumpMap>("bump_map"))});
}

ValueType materials() {
  return by_name<Material>("an object of materials by name", 0);
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// Reason why a clear coat cannot have this index, if there is one.
std::optional<std::string> coat_fault(const RefractiveIndex& index) {
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) {
    if (index.n(nm) < 1)
      return fmt::format("a clear coat must have n of 1 or more (got n = {:g} at {} nm)", index.n(nm), nm);
    if (index.k(nm) > kLargestGlassK)
      return fmt::format("a clear coat must not absorb (got k = {:g} at {} nm, allowed [0, {:g}])",
                         index.k(nm), nm, kLargestGlassK);
  }
  return std::nullopt;
}

// Reflectance of an interface of this index at normal incidence.
Curve normal_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
  return Curve(std::move(knots));
}

// Position of an absorption that the user gives by numbers; nullptr if there is none. The traces of
// absorption in glass tables do not count.
const SourcePosition* where_absorption_is_set(const spec::TintedIor& spec) {
  if (spec.absorption_per_m) return &spec.absorption_per_m->where;
  const auto* constant = std::get_if<spec::ConstantIor>(&spec.ior.value);
  const auto* table = std::get_if<spec::TableIor>(&spec.ior.value);
  const auto absorbs = [](const std::vector<double>& k) {
    return std::ranges::any_of(k, [](double v) { return v > 0; });
  };
  return (constant != nullptr && constant->k > 0) || (table != nullptr && table->k && absorbs(*table->k))
             ? &spec.ior.where
             : nullptr;
}

// A material made from its first part and further arguments; nothing if the part could not be built.
template <typename M, typename Part, typename... More>
std::optional<MaterialModel> make_model(std::optional<Part> part, More... more) {
  if (!part) return std::nullopt;
  return M{*std::move(part), more...};
}

// Reciprocal of a curve, sampled every nanometre.
Curve reciprocal(const Curve& curve) {
  if (curve.is_constant()) return Curve(1 / curve.max());
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), 1 / curve(nm)});
  return Curve(std::move(knots));
}

std::optional<Curve> transmittance(const spec::ThinElement& spec, LoadContext& context) {
  if (!spec.transmittance) return Curve(1.0);
  return build(*spec.transmittance, {"filter", Range::unit(), CurveUnit::fraction}, context);
}

/// Builds each kind of material; nothing after an error.
struct ModelBuilder {
  using Model = std::optional<MaterialModel>;
  LoadContext& context;

  Model operator()(std::monostate) const { return std::nullopt; }
  Model operator()(const spec::Mixture&) const {
    return MixtureMaterial{};
  }  // Its components are added later.
  Model operator()(const spec::Diffuse& spec) const {
    return make_model<DiffuseMaterial>(build(spec.reflectance, context));
  }
  Model operator()(const spec::Dielectric& spec) const {
    auto ior = build(spec.ior, context);
    auto medium = build(spec.scattering, std::nullopt, context);
    Coating coating = build(spec.coating, context);
    const auto facets = spec.roughness ? build(*spec.roughness, coating, context) : std::nullopt;
    if (!ior || !medium) return std::nullopt;
    if (!medium->scatters()) medium.reset();
    if (facets)
      return RoughDielectricMaterial(std::move(ior->name), std::move(ior->index), *facets, std::move(medium));
    return DielectricMaterial{std::move(ior->name), std::move(ior->index), std::move(coating),
                              std::move(medium)};
  }
  Model operator()(const spec::Conductor& spec) const {
    auto ior = build(spec.ior, context);
    Coating coating = build(spec.coating, context);
    const auto facets = spec.roughness ? build(*spec.roughness, coating, context) : std::nullopt;
    if (!ior) return std::nullopt;
    if (facets) return RoughConductorMaterial(std::move(ior->name), std::move(ior->index), *facets);
    return ConductorMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
  }
  Model operator()(const spec::Film& spec) const { return FilmMaterial{build(spec.layers, context)}; }
  Model operator()(const spec::Medium& spec) const {
    auto medium = build(spec.scattering, spec.absorption_per_m, context);
    if (!medium) return std::nullopt;
    if (spec.grid && !spec.absorption_per_m && !spec.scattering.per_m)
      context.diagnostics.warning(spec.grid->where,
                                  "grid has no effect: its densities multiply absorption_per_m and "
                                  "scattering_per_m, and neither is given");
    if (spec.grid && !(medium->grid = build(*spec.grid, context))) return std::nullopt;
    return MediumMaterial{std::move(*medium)};
  }
  Model operator()(const spec::CoatedDiffuse& spec) const {
    auto ior = build(spec.ior, context);
    auto reflectance = build(spec.reflectance, context);
    if (!ior || !reflectance) return std::nullopt;
    if (const auto fault = coat_fault(ior->index)) return context.refuse(spec.ior.where, *fault);
    return CoatedDiffuseMaterial{std::move(*reflectance), std::move(ior->name), std::move(ior->index)};
  }
  Model operator()(const spec::ThinGlass& spec) const {
    auto ior = build(spec.ior, context);
    const SourcePosition* absorption = where_absorption_is_set(spec.ior);
    if (absorption != nullptr && spec.thickness == 0)
      context.diagnostics.warning(*absorption, "absorption has no effect in a pane of thickness 0");
    if (!ior) return std::nullopt;
    return ThinGlassMaterial{std::move(ior->name), std::move(ior->index), spec.thickness * context.unit_m};
  }
  Model operator()(const spec::Mirror& spec) const {
    return make_model<MirrorMaterial>(build(spec.reflectance, context));
  }
  Model operator()(const spec::Schlick& spec) const {
    std::optional<SpectralTexture> r0;
    if (const auto* reflectance = std::get_if<spec::Reflectance>(&spec.normal))
      r0 = build(*reflectance, context);
    else if (const auto ior = build(std::get<spec::Ior>(spec.normal), context))
      r0 = normal_reflectance(ior->index);
    return make_model<SchlickMaterial>(std::move(r0));
  }
  Model operator()(const spec::OrenNayar& spec) const {
    return make_model<OrenNayarMaterial>(build(spec.reflectance, context), spec.sigma_deg);
  }
  Model operator()(const spec::Principled& spec) const {
    const auto amount = [](double x) { return static_cast<float>(x); };
    const PrincipledParameters look{amount(spec.metallic),  amount(spec.roughness),
                                    amount(spec.specular),  amount(spec.sheen),
                                    amount(spec.clearcoat), amount(spec.clearcoat_gloss)};
    return make_model<PrincipledMaterial>(build(spec.base_color, context), Principled(look));
  }
  Model operator()(const spec::CosinePower& spec) const {
    return make_model<CosinePowerMaterial>(build(spec.reflectance, context), spec.exponent, spec.reciprocal);
  }
  Model operator()(const spec::Phong& spec) const {
    return make_model<PhongMaterial>(build(spec.reflectance, context), spec.exponent);
  }
  Model operator()(const spec::Retroreflector& spec) const {
    return make_model<RetroreflectorMaterial>(build(spec.reflectance, context), spec.exponent);
  }
  Model operator()(const spec::Polariser& spec) const {
    auto passed = transmittance(spec, context);
    std::optional<Curve> blocked(0.0);
    if (spec.extinction_ratio) {
      blocked = build(*spec.extinction_ratio, {"filter", {1, 1e30}}, context);
      if (blocked) blocked = reciprocal(*blocked);
    }
    if (!passed || !blocked) return std::nullopt;
    return PolariserMaterial{{std::move(*passed)}, std::move(*blocked), spec.angle_deg * kDegree};
  }
  Model operator()(const spec::WavePlate& spec) const {
    auto passed = transmittance(spec, context);
    WavePlateMaterial plate{{}, {}, spec.angle_deg * kDegree};
    if (const auto* crystal = std::get_if<spec::Crystal>(&spec.kind)) {
      auto birefringence = build(crystal->birefringence, {"filter", {0, 10}}, context);
      if (!birefringence) return std::nullopt;
      plate.kind = WavePlateMaterial::Crystal{crystal->thickness * context.unit_m, std::move(*birefringence)};
    } else if (const auto* ideal = std::get_if<spec::Retardance>(&spec.kind)) {
      plate.kind = WavePlateMaterial::Ideal{ideal->retardance_deg * kDegree};
    }
    if (!passed) return std::nullopt;
    plate.transmittance = std::move(*passed);
    return plate;
  }
  Model operator()(const spec::Depolariser& spec) const {
    auto passed = transmittance(spec, context);
    if (!passed) return std::nullopt;
    return DepolariserMaterial{{std::move(*passed)}};
  }
};

}  // namespace

std::optional<MaterialModel> build_model(const spec::Material& material, LoadContext& context) {
  return std::visit(ModelBuilder{context}, material.model);
}

}  // namespace abbe::description
