#include "description/material.h"

namespace abbe::spec {
namespace {

using namespace schema;

// Beyond it a cosine's float says nothing about the peak.
constexpr double kMostPeaked = 0.9999;
constexpr Range kSigma{0, 90};  // [deg]
constexpr Range kExponent{0, 1e4};

constexpr char kCoating[] = "Coherent thin films on the surface, from the outside inwards.";
constexpr char kRoughness[] =
    "Width of the slopes of microfacets in [0, 1], below 1e-3 smooth, or widths along u and across it; not "
    "under a coating.";

template <typename T>
Field amount(std::string_view key, double T::*member, std::string_view text) {
  return field(key, member, number(Range::unit()), text).or_default();
}

}  // namespace

static const Fields& fields(Tag<HenyeyGreenstein>) {
  static const Fields kFields =
      describe<HenyeyGreenstein>("henyey_greenstein", "Henyey and Greenstein's phase function.",
                                 {field("henyey_greenstein", &HenyeyGreenstein::g,
                                        number({-kMostPeaked, kMostPeaked}), "Its mean cosine.")});
  return kFields;
}

static const Fields& fields(Tag<Scattering>) {
  using Phase = std::variant<PhaseWord, HenyeyGreenstein>;
  static const Fields kFields = describe<Scattering>(
      "scattering", "",
      {field("scattering_per_m", &Scattering::per_m, curve(),
             "Scattering coefficient inside, 0 or more, 0 when absent."),
       field("phase", &Scattering::phase,
             forms<Phase>(
                 "phase", "a phase function",
                 form<PhaseWord>(Json::text, word<PhaseWord>("phase function", {"isotropic", "rayleigh"})),
                 form<HenyeyGreenstein>(Json::any, thing<HenyeyGreenstein>())),
             "How matter scatters, isotropic when absent.")});
  return kFields;
}

static const Fields& fields(Tag<Grid>) {
  static const Fields kFields = describe<Grid>(
      "grid", "Densities that multiply absorption and scattering.",
      {field("densities", &Grid::densities, text(), "A NumPy file of axes z, y, x."),
       field("from", &Grid::from, point(), "Position of the first node."),
       field("to", &Grid::to, point(), "Position of the last node, beyond the first along x, y and z.")});
  return kFields;
}

static const Fields& fields(Tag<Diffuse>) {
  static const Fields kFields = describe<Diffuse>(
      "diffuse", "Lambertian matter, both sides alike.",
      {field("reflectance", &Diffuse::reflectance, reflectance(), "Reflectance in [0, 1].")});
  return kFields;
}

static const Fields& fields(Tag<Dielectric>) {
  static const Fields kFields = describe<Dielectric>(
      "dielectric", "An interface between the matter inside a closed shape and what is around it.",
      {lent(&Dielectric::ior), lent(&Dielectric::scattering),
       field("coating", &Dielectric::coating, layers(), kCoating).or_default(),
       field("roughness", &Dielectric::roughness, roughness(), kRoughness)});
  return kFields;
}

static const Fields& fields(Tag<Conductor>) {
  static const Fields kFields = describe<Conductor>(
      "conductor", "An opaque metal.",
      {field("ior", &Conductor::ior, metal_ior(),
             "Refractive index: n, n and k, a name of data/metal, or a FILE.csv or FILE.yml."),
       field("coating", &Conductor::coating, layers(), kCoating).or_default(),
       field("roughness", &Conductor::roughness, roughness(), kRoughness)});
  return kFields;
}

static const Fields& fields(Tag<Film>) {
  static const Fields kFields =
      describe<Film>("film", "Thin films with air on both sides, such as a soap bubble's.",
                     {field("layers", &Film::layers, layers(), "The films.")});
  return kFields;
}

static const Fields& fields(Tag<Medium>) {
  static const Fields kFields =
      describe<Medium>("medium", "Matter without an interface, such as fog or smoke.",
                       {field("absorption_per_m", &Medium::absorption_per_m, curve(),
                              "Absorption coefficient, 0 or more, 0 when absent."),
                        lent(&Medium::scattering),
                        field("grid", &Medium::grid, thing<Grid>(),
                              "Where there is how much of it; everywhere 1 when absent.")});
  return kFields;
}

static const Fields& fields(Tag<CoatedDiffuse>) {
  static const Fields kFields = describe<CoatedDiffuse>(
      "coated_diffuse", "Lambertian ground under a smooth clear coat.",
      {field("ior", &CoatedDiffuse::ior, ior(), "Index of the coat; n is 1 or more, and k next to nothing."),
       field("reflectance", &CoatedDiffuse::reflectance, reflectance(),
             "Reflectance of the bare ground, in [0, 1].")});
  return kFields;
}

static const Fields& fields(Tag<ThinGlass>) {
  static const Fields kFields = describe<ThinGlass>(
      "thin_glass", "A pane as one surface, which light crosses without being bent.",
      {lent(&ThinGlass::ior), field("thickness", &ThinGlass::thickness, number({0, kMaxLength}),
                                    "Length of its thickness; 0 absorbs nothing.")
                                  .or_default()});
  return kFields;
}

static const Fields& fields(Tag<Mirror>) {
  static const Fields kFields = describe<Mirror>(
      "mirror", "The ideal mirror.",
      {field("reflectance", &Mirror::reflectance, reflectance(), "Reflectance in [0, 1], at every angle.")});
  return kFields;
}

static const Fields& fields(Tag<Schlick>) {
  static const Fields kFields = describe<Schlick>(
      "schlick", "A smooth mirror by Schlick's approximation, to compare with.",
      {one_of(&Schlick::normal, under<Ior>("ior", metal_ior(), "Refractive index."),
              under<Reflectance>("reflectance", reflectance(), "Reflectance along the normal, in [0, 1]."))});
  return kFields;
}

static const Fields& fields(Tag<OrenNayar>) {
  static const Fields kFields = describe<OrenNayar>(
      "oren_nayar", "Rough diffuse matter.",
      {field("reflectance", &OrenNayar::reflectance, reflectance(), "Reflectance in [0, 1]."),
       field("sigma_deg", &OrenNayar::sigma_deg, number(kSigma), "Standard deviation of its slopes.")});
  return kFields;
}

static const Fields& fields(Tag<Principled>) {
  static const Fields kFields = describe<Principled>(
      "principled", "Burley's principled model.",
      {field("base_color", &Principled::base_color, reflectance(), "Reflectance in [0, 1]."),
       amount("metallic", &Principled::metallic, "How much of it is metal."),
       amount("roughness", &Principled::roughness, "The facets' width is its square."),
       amount("specular", &Principled::specular,
              "Reflectance along the normal of what is no metal, over 0.08."),
       amount("sheen", &Principled::sheen, "As of cloth at grazing angles."),
       amount("clearcoat", &Principled::clearcoat, "Strength of a second highlight."),
       amount("clearcoat_gloss", &Principled::clearcoat_gloss, "How narrow the second highlight is.")});
  return kFields;
}

static const Fields& fields(Tag<Power>) {
  static const Fields kFields = describe<Power>(
      "power", "",
      {field("reflectance", &Power::reflectance, reflectance(), "Reflectance of the lobe, in [0, 1]."),
       field("exponent", &Power::exponent, number(kExponent), "Power of the cosine.")});
  return kFields;
}
static const Fields& fields(Tag<CosinePower>) {
  static const Fields kFields = describe<CosinePower>(
      "cosine_power", "A power of the cosine of light's direction, or of both directions.",
      {lent(&CosinePower::power),
       field("reciprocal", &CosinePower::reciprocal, boolean(), "Whether it is of both.").or_default()});
  return kFields;
}
static const Fields& fields(Tag<Phong>) {
  static const Fields kFields = describe<Phong>(
      "phong", "Phong's highlight, which breaks reciprocity and makes energy.", {lent(&Phong::power)});
  return kFields;
}
static const Fields& fields(Tag<Retroreflector>) {
  static const Fields kFields = describe<Retroreflector>(
      "retroreflector", "A lobe back to where light comes from.", {lent(&Retroreflector::power)});
  return kFields;
}

static const Fields& fields(Tag<MixturePart>) {
  static const Fields kFields =
      describe<MixturePart>("mixture_part", "A part of a mixture.",
                            {field("material", &MixturePart::material, text(),
                                   "A material that is no mixture and that light does not enter."),
                             field("weight", &MixturePart::weight, curve(), "Its share, in [0, 1].")});
  return kFields;
}

static const Fields& fields(Tag<NormalMap>) {
  static const Fields kFields = describe<NormalMap>(
      "normal_map", "Channels R, G, B in [0, 1], which stand for [-1, 1] along u, v and the outward normal.",
      {lent(&NormalMap::file)});
  return kFields;
}
static const Fields& fields(Tag<BumpMap>) {
  static const Fields kFields = describe<BumpMap>(
      "bump_map", "One channel of heights above the surface.",
      {field("height", &BumpMap::height, number(kCoordinate), "Length that a value of 1 stands for."),
       lent(&BumpMap::file)});
  return kFields;
}

const Fields& fields(Tag<Material>) {
  static const Fields kFields = describe<Material>(
      "material", "What a surface is made of, or what is inside.",
      {one_of(&Material::model,
              under<Mixture>("mixture", list<MixturePart>(thing<MixturePart>(), "parts", 1),
                             "Other materials side by side, whose weights add up to at most 1."),
              under<Diffuse>("diffuse", thing<Diffuse>(), ""),
              under<Dielectric>("dielectric", thing<Dielectric>(), ""),
              under<Conductor>("conductor", thing<Conductor>(), ""), under<Film>("film", thing<Film>(), ""),
              under<Medium>("medium", thing<Medium>(), ""),
              under<CoatedDiffuse>("coated_diffuse", thing<CoatedDiffuse>(), ""),
              under<ThinGlass>("thin_glass", thing<ThinGlass>(), ""),
              under<Mirror>("mirror", thing<Mirror>(), ""), under<Schlick>("schlick", thing<Schlick>(), ""),
              under<OrenNayar>("oren_nayar", thing<OrenNayar>(), ""),
              under<Principled>("principled", thing<Principled>(), ""),
              under<CosinePower>("cosine_power", thing<CosinePower>(), ""),
              under<Phong>("phong", thing<Phong>(), ""),
              under<Retroreflector>("retroreflector", thing<Retroreflector>(), "")),
       field("priority", &Material::priority, integer<int>({-1000, 1000}),
             "Of the matter inside, 0 when absent: where shapes overlap, that of the highest priority is "
             "there, of equals the one "
             "that light enters last."),
       at_most_one(&Material::relief, "a material has a normal_map or a bump_map",
                   under<NormalMap>("normal_map", thing<NormalMap>(), ""),
                   under<BumpMap>("bump_map", thing<BumpMap>(), ""))});
  return kFields;
}

Kind materials() {
  return by_name<Material>(thing<Material>(), "an object of materials by name", 0);
}

}  // namespace abbe::spec
