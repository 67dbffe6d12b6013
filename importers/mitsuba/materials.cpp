#include "importers/mitsuba/scene_objects.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/mitsuba/spectra.h"
#include "importers/shared/materials.h"
#include "io/text.h"
#include "materials/interface/fresnel.h"

namespace abbe::importers::mitsuba {
namespace {

struct NamedIndex {
  std::string_view name;  ///< Name in Mitsuba, in lower case.
  double n;               ///< Refractive index relative to vacuum, the same at all wavelengths.
};
/// Mitsuba's dielectrics. Scene files may write their names in any case, so convert them to lower case first.
constexpr std::array<NamedIndex, 23> kDielectrics{
    {{"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
     {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
     {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
     {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
     {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
     {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
     {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
     {"pet", 1.575},       {"diamond", 2.419}}};

struct NamedMetal {
  std::string_view source_name;  ///< Case-sensitive name in Mitsuba.
  std::string_view table_name;   ///< Name of the table of n and k that Abbe ships.
};
/// All metals of Mitsuba for which Abbe ships a table.
constexpr std::array<NamedMetal, 14> kMetals{{{"Ag", "Ag_Johnson"},
                                              {"Al", "Al_Rakic"},
                                              {"Au", "Au_Johnson"},
                                              {"Be", "Be_Rakic-BB"},
                                              {"Cr", "Cr_Johnson"},
                                              {"Cu", "Cu_Johnson"},
                                              {"Hg", "Hg_Inagaki"},
                                              {"Ir", "Ir_Roberts"},
                                              {"Mo", "Mo_Kirillova"},
                                              {"Rh", "Rh_Weaver"},
                                              {"TiN", "TiN_Pfluger"},
                                              {"TiO2", "TiO2_Sarkar"},
                                              {"V", "V_Johnson"},
                                              {"W", "W_Weaver"}}};

const std::vector<std::string> kMaterialTypes{
    "blendbsdf",      "bumpmap",    "conductor",      "dielectric",     "diffuse",         "hair",
    "mask",           "measured",   "normalmap",      "null",           "phong",           "plastic",
    "pplastic",       "principled", "principledthin", "roughconductor", "roughdielectric", "roughplastic",
    "thindielectric", "twosided"};

using Phase = decltype(spec::Scattering::phase);

Phase phase_of(const Object& medium) {
  const auto phases = medium.all("phase");
  if (phases.empty()) return std::nullopt;
  const Object phase(*phases.front(), medium.state());
  if (phase.type() == "hg") return {{{spec::HenyeyGreenstein{phase.number("g", 0.8)}}, phase.where()}};
  if (phase.type() == "rayleigh") return {{{spec::PhaseWord::rayleigh}, phase.where()}};
  if (phase.type() != "isotropic")
    phase.note(
        fmt::format("a phase function \"{}\" is not supported: isotropic scattering is used", phase.type()));
  return std::nullopt;
}

// The product of a dimensionless factor and an extinction coefficient, each a number or a spectrum.
spec::Curve product_of(const Spectrum& fraction, const Spectrum& extinction, const SourcePosition& where,
                       SceneImporter& importer) {
  if (const auto* number = std::get_if<double>(&fraction))
    return curve_of(scaled(extinction, *number), where, importer);
  if (const auto* number = std::get_if<double>(&extinction))
    return curve_of(scaled(fraction, *number), where, importer);
  spec::Curve curve;
  curve.where = where;
  const std::vector<spec::Curve> factors{curve_of(fraction, where, importer),
                                         curve_of(extinction, where, importer)};
  curve.value = spec::CurveFormula{spec::Product{{factors}}};
  return curve;
}

// 1 - samples. It is 1 outside the range if the samples are 0 there.
Samples one_minus(Samples fraction) {
  for (double& value : fraction.values) value = 1 - value;
  return extend_constant(std::move(fraction), 1);
}

Spectrum one_minus(const Spectrum& fraction) {
  if (const auto* rgb = std::get_if<LinearRgb>(&fraction))
    return LinearRgb{1 - (*rgb)[0], 1 - (*rgb)[1], 1 - (*rgb)[2]};
  if (const auto* samples = std::get_if<Samples>(&fraction)) return one_minus(*samples);
  return 1 - number_of(fraction).value_or(0);
}

// Converts a homogeneous <medium>; its "sigma_t" is in 1/m. Other types of medium are noted and become empty,
// without absorption and scattering. Unsupported phase functions are noted and become isotropic.
spec::Medium medium_of(const Object& medium) {
  spec::Medium result;
  medium.importer().note_medium(medium.where());
  if (medium.type() != "homogeneous") {
    medium.note(fmt::format("a medium \"{}\" is not supported: replaced by an empty one", medium.type()));
    return result;
  }
  const Spectrum albedo = spectrum(medium, "albedo", 0.75);
  const Spectrum extinction = scaled(spectrum(medium, "sigma_t", 1.0), medium.number("scale", 1));
  result.absorption_per_m = product_of(one_minus(albedo), extinction, medium.where(), medium.importer());
  result.scattering.per_m = product_of(albedo, extinction, medium.where(), medium.importer());
  result.scattering.phase = phase_of(medium);
  medium.ignore({"sample_emitters", "has_spectral_extinction"});
  medium.note_unused();
  return result;
}

constexpr std::string_view kGlass = "bk7";  // Default of dielectrics.

std::optional<double> named_index(const std::string& name) {
  const auto known = std::ranges::find(kDielectrics, lower_case(name), &NamedIndex::name);
  return known == kDielectrics.end() ? std::nullopt : std::optional(known->n);
}

// Refractive index of a property, which is a number or a name.
double index_number(const Object& bsdf, std::string_view name, std::string_view fallback) {
  const Element* found = bsdf.find(name, {"float", "string", "spectrum"});
  if (found != nullptr && found->tag != "string") return number(bsdf, name, 1.5);
  const std::string index_name = found ? (*found)["value"] : std::string(fallback);
  if (const auto known = named_index(index_name)) return *known;
  std::vector<std::string> names;
  for (const NamedIndex& index : kDielectrics) names.emplace_back(index.name);
  bsdf.importer().fail(found->where, unknown_name("dielectric", index_name, names));
  return 1.5;
}

std::optional<double> interior_index(const Element& bsdf) {
  const auto found = std::ranges::find_if(
      bsdf.children, [](const Element& property) { return property["name"] == "int_ior"; });
  if (found == bsdf.children.end()) return named_index(std::string(kGlass));
  const std::string& value = (*found)["value"];
  const auto number = parse_number(value);
  return number ? number : named_index(value);
}

bool matches_other_dielectric(double index, const Object& bsdf) {
  constexpr double kSameIndex = 0.005;  // 1.33 and 1.333 both mean water.
  return std::ranges::any_of(bsdf.state().interior_indices, [&](const auto& entry) {
    return entry.first != &bsdf.element() && std::abs(entry.second - index) <= kSameIndex;
  });
}

/// Index of a surface. `relative` is the interior index over the exterior index, as declared in the scene.
/// `ior` is the index of the material in Abbe, relative to air; Abbe divides it by the index of the closed
/// shape around the surface, if there is one.
struct SurfaceIndex {
  double relative;
  spec::Ior ior;
};

SurfaceIndex surface_index(const Object& bsdf, std::string_view fallback) {
  constexpr double kGas = 1.001;  // Smaller indices count as air.
  const double interior = index_number(bsdf, "int_ior", fallback);
  const double exterior = index_number(bsdf, "ext_ior", "air");
  SurfaceIndex index{interior / exterior, {}};
  index.ior.value = index.relative;
  index.ior.where = bsdf.where();
  if (exterior <= kGas) return index;
  if (matches_other_dielectric(exterior, bsdf)) {
    index.ior.value = interior / *named_index("air");
    bsdf.importer().note(bsdf.position_of("ext_ior"),
                         "\"ext_ior\" is the index of another dielectric of the scene: Abbe takes the "
                         "exterior medium from the closed shape around the surface, or air");
  } else {
    bsdf.importer().note(
        bsdf.position_of("ext_ior"),
        "\"ext_ior\" is not the index of another dielectric of the scene: the relative index "
        "is kept, which is right outside all closed shapes");
  }
  return index;
}

void note_reflectance_factors(const Object& bsdf) {
  for (const char* name : {"specular_reflectance", "specular_transmittance"})
    if (bsdf.has(name) && number_of(spectrum(bsdf, name, 1.0)) != 1.0)
      bsdf.note(fmt::format("\"{}\" is not supported: dropped", name));
}

std::optional<spec::Roughness> roughness(const Object& bsdf) {
  if (!bsdf.type().starts_with("rough")) return std::nullopt;
  const double both = number(bsdf, "alpha", 0.1);
  const std::string distribution = lower_case(bsdf.text("distribution", "beckmann"));
  bsdf.importer().is_known("distribution", distribution, {"beckmann", "ggx"},
                           bsdf.position_of("distribution"));
  bsdf.ignore({"sample_visible"});
  return roughness_of(number(bsdf, "alpha_u", both), number(bsdf, "alpha_v", both),
                      distribution == "beckmann" ? FacetShape::beckmann : FacetShape::ggx, bsdf.where(),
                      bsdf.importer());
}

spec::Ior metal_index(const Object& bsdf) {
  spec::Ior ior;
  ior.where = bsdf.where();
  if (bsdf.has("eta") || bsdf.has("k"))
    return index_of(spectrum(bsdf, "eta", 0.0), spectrum(bsdf, "k", 1.0), bsdf.where(), bsdf.importer());
  const std::string name = bsdf.text("material", "none");
  ior.value = spec::MetalIor{{0, 0}};  // n = k = 0 reflects everything.
  if (name == "none") return ior;
  const auto known = std::ranges::find(kMetals, name, &NamedMetal::source_name);
  if (known != kMetals.end()) {
    ior.value = std::string(known->table_name);
    return ior;
  }
  std::vector<std::string> names;
  for (const NamedMetal& metal : kMetals) names.emplace_back(metal.source_name);
  bsdf.fail(unknown_name("metal", name, names));
  return ior;
}

spec::Conductor conductor(const Object& bsdf) {
  note_reflectance_factors(bsdf);
  return {metal_index(bsdf), {}, roughness(bsdf)};
}

spec::Dielectric dielectric(const Object& bsdf, const Element* interior) {
  note_reflectance_factors(bsdf);
  spec::Dielectric glass;
  glass.ior.ior = surface_index(bsdf, kGlass).ior;
  glass.roughness = roughness(bsdf);
  if (interior == nullptr) return glass;
  const spec::Medium medium = medium_of(Object(*interior, bsdf.state()));
  glass.ior.absorption_per_m = medium.absorption_per_m;
  glass.scattering = medium.scattering;
  return glass;
}

// Diffuse reflectance under a coat of index n. In Abbe, light that the coat reflects back is scattered by the
// base again. Mitsuba does so only if "nonlinear" is true; otherwise it applies a factor 1/(1 - r)
// independent of the base, with r the coat's internal reflectance for diffuse light. Both agree for the base
// reflectance rho' with rho'/(1 - rho' r) = rho/(1 - r).
spec::Reflectance base_reflectance(const Object& bsdf, double n, VDirection v) {
  constexpr std::string_view kName = "diffuse_reflectance";
  if (bsdf.boolean("nonlinear", false)) return reflectance(bsdf, kName, 0.5, v);
  TextureValue value = texture(bsdf, kName, 0.5, v);
  if (auto* image = std::get_if<spec::Texture>(&value)) {
    bsdf.importer().note(bsdf.position_of(kName),
                         "an image under a clear coat is darker and more saturated than in Mitsuba: it is "
                         "rendered as with \"nonlinear\"");
    return std::move(*image);
  }
  const double r = diffuse_reflectance_inside(n);
  const auto equivalent = [r](double rho) { return rho / (1 - r + rho * r); };
  const auto& spectrum = std::get<Spectrum>(value);
  if (auto curve = mapped_curve_of(spectrum, equivalent, bsdf.position_of(kName), bsdf.importer()))
    return *curve;
  return curve_of(spectrum, bsdf.position_of(kName), bsdf.importer());
}

spec::CoatedDiffuse plastic(const Object& bsdf, VDirection v) {
  note_reflectance_factors(bsdf);
  if (bsdf.type() == "roughplastic") bsdf.note("roughness of a clear coat is not supported: dropped");
  bsdf.ignore({"alpha", "distribution", "sample_visible"});
  SurfaceIndex coat = surface_index(bsdf, "polypropylene");
  spec::Reflectance paint = base_reflectance(bsdf, coat.relative, v);
  return {std::move(coat.ior), std::move(paint)};
}

spec::Principled principled(const Object& bsdf, VDirection v) {
  spec::Principled model;
  model.base_color = reflectance(bsdf, "base_color", 0.5, v);
  model.metallic = number(bsdf, "metallic", 0);
  model.roughness = number(bsdf, "roughness", 0.5);
  model.specular = number(bsdf, "specular", 0.5);
  model.sheen = number(bsdf, "sheen", 0);
  model.clearcoat = number(bsdf, "clearcoat", 0);
  model.clearcoat_gloss = number(bsdf, "clearcoat_gloss", 0);
  return model;
}

const Element* inner_bsdf(const Object& bsdf) {
  const auto inner = bsdf.all("bsdf");
  return inner.empty() ? nullptr : inner.front();
}

spec::Diffuse replacement(const Object& bsdf, VDirection v) {
  for (const char* name : {"reflectance", "base_color", "diffuse_reflectance"})
    if (bsdf.has(name)) return {reflectance(bsdf, name, 0.5, v)};
  return {curve_of(0.5, bsdf.where(), bsdf.importer())};
}

bool is_wrapper(const std::string& type) {
  return type == "twosided" || type == "mask" || type == "bumpmap" || type == "normalmap";
}

}  // namespace

void collect_dielectric_indices(const Element& element, ImportState& state) {
  for (const Element& child : element.children) {
    const std::string& type = child["type"];
    const bool is_dielectric = child.tag == "bsdf" && (type == "dielectric" || type == "roughdielectric");
    if (const auto n = is_dielectric ? interior_index(child) : std::nullopt)
      state.interior_indices.emplace(&child, *n);
    collect_dielectric_indices(child, state);
  }
}

std::optional<std::string> Materials::name_of(const Element& element, const Element* interior, VDirection v) {
  const Object bsdf(element, import_);
  if (bsdf.type() == "null" && interior == nullptr) return std::nullopt;
  const auto [known, is_new] = names_.try_emplace({&element, interior, v});
  if (!is_new) return known->second;
  spec::Material material = converted(bsdf, interior, v);
  bsdf.note_unused();
  std::string name = element["id"].empty() ? bsdf.type() : element["id"];
  if (interior != nullptr && !(*interior)["id"].empty()) name += " with " + (*interior)["id"];
  return names_[{&element, interior, v}] = import_.importer.add_material(name, std::move(material));
}

spec::Material Materials::converted(const Object& bsdf, const Element* interior, VDirection v) {
  const std::string& type = bsdf.type();
  if (is_wrapper(type)) {
    const Element* inner = inner_bsdf(bsdf);
    if (inner == nullptr) {
      bsdf.fail(fmt::format("\"{}\" needs a nested material", type));
      return {spec::Diffuse{curve_of(0.5, bsdf.where(), import_.importer)}, {}, {}};
    }
    const Object core(*inner, import_);
    const Element* back = bsdf.all("bsdf").back();
    if (type == "twosided" && back != inner)
      import_.importer.note(
          back->where, "different materials on both sides are not supported: that of the back is dropped");
    spec::Material material = converted(core, interior, v);
    core.note_unused();
    if (type == "mask") {
      bsdf.note("transparency masks are not supported: opacity is dropped");
      bsdf.ignore({"opacity"});
    } else if (type != "twosided") {
      if (bsdf.all("texture").empty()) bsdf.fail(fmt::format("\"{}\" needs a nested texture", type));
      for (const Element* texture : bsdf.all("texture")) {
        const Object relief(*texture, import_);
        const auto file = image(relief, v);
        if (file && holds_codes(file->image.value) && !relief.boolean("raw", false))
          import_.importer.note(relief.where(), kLinearRelief);
        if (file && type == "normalmap") material.relief = spec::NormalMap{*file};
        if (file && type == "bumpmap") material.relief = spec::BumpMap{*file, bsdf.number("scale", 1)};
      }
    }
    return material;
  }
  if (type == "blendbsdf") return mixture(bsdf, v);
  spec::Material material;
  if (type == "diffuse") {
    material.model = spec::Diffuse{reflectance(bsdf, "reflectance", 0.5, v)};
  } else if (type == "conductor" || type == "roughconductor") {
    material.model = conductor(bsdf);
  } else if (type == "dielectric" || type == "roughdielectric") {
    material.model = dielectric(bsdf, interior);
  } else if (type == "thindielectric") {
    note_reflectance_factors(bsdf);
    spec::ThinGlass pane;
    pane.ior.ior = surface_index(bsdf, kGlass).ior;
    material.model = pane;
  } else if (type == "plastic" || type == "roughplastic") {
    material.model = plastic(bsdf, v);
  } else if (type == "principled") {
    material.model = principled(bsdf, v);
  } else if (type == "null" && interior != nullptr) {
    material.model = medium_of(Object(*interior, import_));
  } else {
    if (import_.importer.is_known("bsdf", type, kMaterialTypes, bsdf.where()))
      bsdf.note(fmt::format("a material \"{}\" is not supported: replaced by a diffuse one", type));
    material.model = replacement(bsdf, v);
  }
  return material;
}

spec::Material Materials::mixture(const Object& blend, VDirection v) {
  const std::vector<const Element*> parts = blend.all("bsdf");
  const double second = number(blend, "weight", 0.5);
  spec::Mixture mixture;
  mixture.where = blend.where();
  for (std::size_t i = 0; i < parts.size() && i < 2; ++i) {
    spec::MixturePart part;
    const std::string& type = (*parts[i])["type"];
    if (type == "blendbsdf" || type.ends_with("dielectric") || type == "null") {
      import_.importer.fail(parts[i]->where, fmt::format("a mixture with \"{}\" is not supported", type));
      continue;
    }
    part.material = {{name_of(*parts[i], nullptr, v).value_or("")}, parts[i]->where};
    part.weight = curve_of(i == 0 ? 1 - second : second, blend.where(), import_.importer);
    mixture.value.push_back(std::move(part));
  }
  if (parts.size() != 2) blend.fail("a blend needs two materials");
  return {std::move(mixture), {}, {}};
}

}  // namespace abbe::importers::mitsuba
