#include "description/doors/mitsuba/materials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/doors/mitsuba/media.h"
#include "description/doors/mitsuba/named_indices.h"
#include "description/doors/shared/materials.h"
#include "description/doors/shared/picture.h"
#include "io/text.h"
#include "materials/interface/hemispherical.h"

namespace abbe::doors::mitsuba {
namespace {

const std::vector<std::string> kMaterialTypes{
    "blendbsdf",      "bumpmap",    "conductor",      "dielectric",     "diffuse",         "hair",
    "mask",           "measured",   "normalmap",      "null",           "phong",           "plastic",
    "pplastic",       "principled", "principledthin", "roughconductor", "roughdielectric", "roughplastic",
    "thindielectric", "twosided"};

constexpr std::string_view kGlass = "bk7";  // unless a dielectric says otherwise

std::optional<double> named_index(const std::string& name) {
  const auto known = std::ranges::find(kDielectrics, lower_case(name), &NamedIndex::name);
  return known == kDielectrics.end() ? std::nullopt : std::optional(known->n);
}

// An index that is a number or a name.
double index_number(const Object& bsdf, std::string_view name, std::string_view absent, const World& world) {
  const Element* found = bsdf.find(name, {"float", "string", "spectrum"});
  if (found != nullptr && found->tag != "string") return number(bsdf, name, 1.5, world);
  const std::string said = found ? (*found)["value"] : std::string(absent);
  if (const auto known = named_index(said)) return *known;
  std::vector<std::string> names;
  for (const NamedIndex& index : kDielectrics) names.emplace_back(index.name);
  world.door.diagnostics.error(found->where, unknown_name("dielectric", said, names));
  return 1.5;
}

std::optional<double> index_within(const Element& bsdf) {
  const auto said = std::ranges::find_if(
      bsdf.children, [](const Element& property) { return property["name"] == "int_ior"; });
  if (said == bsdf.children.end()) return named_index(std::string(kGlass));
  const std::string& value = (*said)["value"];
  const auto number = parse_number(value);
  return number ? number : named_index(value);
}

// Whether that is the index of other matter than the surface's own.
bool has_other_matter(double index, const Object& bsdf, const World& world) {
  constexpr double kAlike = 0.005;  // 1.33 and 1.333 are both water
  return std::ranges::any_of(world.matter, [&](const auto& matter) {
    return matter.first != &bsdf.element() && std::abs(matter.second - index) <= kAlike;
  });
}

/// Of a surface: the index within over that around, as the scene says them, and what matter has here, where
/// an index is over that of air, and is divided by that of the closed shape around where there is one.
struct SurfaceIndex {
  double relative;
  spec::Ior ior;
};

SurfaceIndex surface_index(const Object& bsdf, std::string_view absent, const World& world) {
  constexpr double kGas = 1.001;  // what is thinner is as air is
  const double inside = index_number(bsdf, "int_ior", absent, world);
  const double outside = index_number(bsdf, "ext_ior", "air", world);
  SurfaceIndex index{inside / outside, {}};
  index.ior.value = index.relative;
  index.ior.where = bsdf.where();
  if (outside <= kGas) return index;
  if (has_other_matter(outside, bsdf, world)) {
    index.ior.value = inside / *named_index("air");
    world.door.note(
        bsdf.place_of("ext_ior"),
        "\"ext_ior\" is that of other matter in the scene: here what is around a surface is the closed "
        "shape that it lies in, and air without one");
  } else {
    world.door.note(
        bsdf.place_of("ext_ior"),
        "\"ext_ior\" is that of no other matter in the scene: the index is over it, as there, for a "
        "surface that lies in no closed shape");
  }
  return index;
}

// A factor that changes what a surface does in no way that matter can.
void note_factors(const Object& bsdf, const World& world) {
  for (const char* name : {"specular_reflectance", "specular_transmittance"})
    if (bsdf.has(name) && number_of(spectrum(bsdf, name, 1.0, world)) != 1.0)
      world.door.note(bsdf.where(), fmt::format("\"{}\" has no counterpart here: dropped", name));
}

std::optional<spec::Roughness> roughness(const Object& bsdf, const World& world) {
  if (!bsdf.type().starts_with("rough")) return std::nullopt;
  const double both = number(bsdf, "alpha", 0.1, world);
  const std::string said = lower_case(bsdf.text("distribution", "beckmann"));
  const std::vector<std::string> distributions{"beckmann", "ggx"};
  if (std::ranges::find(distributions, said) == distributions.end())
    world.door.diagnostics.error(bsdf.place_of("distribution"),
                                 unknown_name("distribution", said, distributions));
  bsdf.ignore({"sample_visible"});
  return roughness_of(number(bsdf, "alpha_u", both, world), number(bsdf, "alpha_v", both, world),
                      said == "beckmann" ? FacetShape::beckmann : FacetShape::ggx, bsdf.where(), world.door);
}

spec::Ior metal_index(const Object& bsdf, const World& world) {
  spec::Ior ior;
  ior.where = bsdf.where();
  if (bsdf.has("eta") || bsdf.has("k"))
    return index_of(spectrum(bsdf, "eta", 0.0, world), spectrum(bsdf, "k", 1.0, world), bsdf.where(),
                    world.door);
  const std::string name = bsdf.text("material", "none");
  ior.value = spec::MetalIor{{0, 0}};  // which reflects everything
  if (name == "none") return ior;
  const auto known = std::ranges::find(kMetals, name, &NamedMetal::theirs);
  if (known != kMetals.end()) {
    ior.value = std::string(known->ours);
    return ior;
  }
  std::vector<std::string> names;
  for (const NamedMetal& metal : kMetals) names.emplace_back(metal.theirs);
  world.door.diagnostics.error(bsdf.where(), unknown_name("metal", name, names));
  return ior;
}

spec::Conductor conductor(const Object& bsdf, const World& world) {
  note_factors(bsdf, world);
  return {metal_index(bsdf, world), {}, roughness(bsdf, world)};
}

spec::Dielectric dielectric(const Object& bsdf, const Element* inside, const World& world) {
  note_factors(bsdf, world);
  spec::Dielectric glass;
  glass.ior.ior = surface_index(bsdf, kGlass, world).ior;
  glass.roughness = roughness(bsdf, world);
  if (inside == nullptr) return glass;
  const spec::Medium medium = medium_of(Object(*inside, world), world);
  glass.ior.absorption_per_m = medium.absorption_per_m;
  glass.scattering = medium.scattering;
  return glass;
}

// The reflectance of the ground under a coat of that index. Here light that the coat throws back meets the
// ground again; there it does so where "nonlinear" is true, and else counts as a factor 1/(1 - r) whatever
// the ground reflects, r being the coat's reflectance for diffuse light from within. As much leaves a ground
// of rho' here: rho'/(1 - rho' r) = rho/(1 - r).
spec::Reflectance ground(const Object& bsdf, double n, RunsOfV v, const World& world) {
  constexpr std::string_view kName = "diffuse_reflectance";
  if (bsdf.truth("nonlinear", false)) return reflectance(bsdf, kName, 0.5, v, world);
  TextureValue said = texture(bsdf, kName, 0.5, v, world);
  if (auto* image = std::get_if<spec::Texture>(&said)) {
    world.door.note(
        bsdf.place_of(kName),
        "an image under a clear coat is darker here, and its colours deeper, as with \"nonlinear\"");
    return std::move(*image);
  }
  const double r = diffuse_reflectance_inside(n);
  const auto there = [r](double rho) { return rho / (1 - r + rho * r); };
  const auto& spectrum = std::get<Spectrum>(said);
  if (auto curve = mapped_curve_of(spectrum, there, bsdf.place_of(kName), world.door)) return *curve;
  return curve_of(spectrum, bsdf.place_of(kName), world.door);
}

spec::CoatedDiffuse plastic(const Object& bsdf, RunsOfV v, const World& world) {
  note_factors(bsdf, world);
  if (bsdf.type() == "roughplastic")
    world.door.note(bsdf.where(), "a clear coat is smooth here: its roughness is dropped");
  bsdf.ignore({"alpha", "distribution", "sample_visible"});
  SurfaceIndex coat = surface_index(bsdf, "polypropylene", world);
  spec::Reflectance paint = ground(bsdf, coat.relative, v, world);
  return {std::move(coat.ior), std::move(paint)};
}

spec::Principled principled(const Object& bsdf, RunsOfV v, const World& world) {
  spec::Principled model;
  model.base_color = reflectance(bsdf, "base_color", 0.5, v, world);
  model.metallic = number(bsdf, "metallic", 0, world);
  model.roughness = number(bsdf, "roughness", 0.5, world);
  model.specular = number(bsdf, "specular", 0.5, world);
  model.sheen = number(bsdf, "sheen", 0, world);
  model.clearcoat = number(bsdf, "clearcoat", 0, world);
  model.clearcoat_gloss = number(bsdf, "clearcoat_gloss", 0, world);
  return model;
}

// What a surface is under all that is wrapped around it.
const Element* within(const Object& bsdf) {
  const auto inner = bsdf.all("bsdf");
  return inner.empty() ? nullptr : inner.front();
}

spec::Diffuse replacement(const Object& bsdf, RunsOfV v, const World& world) {
  for (const char* name : {"reflectance", "base_color", "diffuse_reflectance"})
    if (bsdf.has(name)) return {reflectance(bsdf, name, 0.5, v, world)};
  return {curve_of(0.5, bsdf.where(), world.door)};
}

bool is_wrapper(const std::string& type) {
  return type == "twosided" || type == "mask" || type == "bumpmap" || type == "normalmap";
}

}  // namespace

void find_matter(const Element& element, World& world) {
  for (const Element& child : element.children) {
    const std::string& type = child["type"];
    const bool is_matter = child.tag == "bsdf" && (type == "dielectric" || type == "roughdielectric");
    if (const auto n = is_matter ? index_within(child) : std::nullopt) world.matter.emplace(&child, *n);
    find_matter(child, world);
  }
}

std::optional<std::string> Materials::name_of(const Element& element, const Element* inside, RunsOfV v) {
  const Object bsdf(element, world_);
  if (bsdf.type() == "null" && inside == nullptr) return std::nullopt;
  const auto [known, is_new] = names_.try_emplace({&element, inside, v});
  if (!is_new) return known->second;
  spec::Material material = converted(bsdf, inside, v);
  bsdf.note_unused();
  std::string name = element["id"].empty() ? bsdf.type() : element["id"];
  if (inside != nullptr && !(*inside)["id"].empty()) name += " with " + (*inside)["id"];
  return names_[{&element, inside, v}] = world_.door.add_material(name, std::move(material));
}

spec::Material Materials::converted(const Object& bsdf, const Element* inside, RunsOfV v) {
  const std::string& type = bsdf.type();
  if (is_wrapper(type)) {
    const Element* inner = within(bsdf);
    if (inner == nullptr) {
      world_.door.diagnostics.error(bsdf.where(), fmt::format("\"{}\" needs a material within", type));
      return {spec::Diffuse{curve_of(0.5, bsdf.where(), world_.door)}, {}, {}};
    }
    const Object core(*inner, world_);
    const Element* back = bsdf.all("bsdf").back();
    if (type == "twosided" && back != inner)
      world_.door.note(back->where,
                       "a surface has one material on both sides here: that of the back is dropped");
    spec::Material material = converted(core, inside, v);
    core.note_unused();
    if (type == "mask") {
      world_.door.note(bsdf.where(), "surfaces have no holes here: opacity is dropped");
      bsdf.ignore({"opacity"});
    } else if (type != "twosided") {
      if (bsdf.all("texture").empty())
        world_.door.diagnostics.error(bsdf.where(), fmt::format("\"{}\" needs a texture within", type));
      for (const Element* texture : bsdf.all("texture")) {
        const Object relief(*texture, world_);
        const auto file = image(relief, v, world_);
        if (file && holds_codes(file->image.value) && !relief.truth("raw", false))
          world_.door.note(relief.where(), kLinearRelief);
        if (file && type == "normalmap") material.relief = spec::NormalMap{*file};
        if (file && type == "bumpmap") material.relief = spec::BumpMap{*file, bsdf.number("scale", 1)};
      }
    }
    return material;
  }
  if (type == "blendbsdf") return mixture(bsdf, v);
  spec::Material material;
  if (type == "diffuse") {
    material.model = spec::Diffuse{reflectance(bsdf, "reflectance", 0.5, v, world_)};
  } else if (type == "conductor" || type == "roughconductor") {
    material.model = conductor(bsdf, world_);
  } else if (type == "dielectric" || type == "roughdielectric") {
    material.model = dielectric(bsdf, inside, world_);
  } else if (type == "thindielectric") {
    note_factors(bsdf, world_);
    spec::ThinGlass pane;
    pane.ior.ior = surface_index(bsdf, kGlass, world_).ior;
    material.model = pane;
  } else if (type == "plastic" || type == "roughplastic") {
    material.model = plastic(bsdf, v, world_);
  } else if (type == "principled") {
    material.model = principled(bsdf, v, world_);
  } else if (type == "null" && inside != nullptr) {
    material.model = medium_of(Object(*inside, world_), world_);
  } else {
    if (std::ranges::find(kMaterialTypes, type) == kMaterialTypes.end())
      world_.door.diagnostics.error(bsdf.where(), unknown_name("bsdf", type, kMaterialTypes));
    else
      world_.door.note(bsdf.where(),
                       fmt::format("a material \"{}\" has no counterpart here: diffuse in its place", type));
    material.model = replacement(bsdf, v, world_);
  }
  return material;
}

spec::Material Materials::mixture(const Object& blend, RunsOfV v) {
  const std::vector<const Element*> parts = blend.all("bsdf");
  const double second = number(blend, "weight", 0.5, world_);
  spec::Mixture mixture;
  mixture.where = blend.where();
  for (std::size_t i = 0; i < parts.size() && i < 2; ++i) {
    spec::MixturePart part;
    const std::string& type = (*parts[i])["type"];
    if (type == "blendbsdf" || type.ends_with("dielectric") || type == "null") {
      world_.door.diagnostics.error(parts[i]->where,
                                    fmt::format("a mixture of \"{}\" has no counterpart here", type));
      continue;
    }
    part.material = {{name_of(*parts[i], nullptr, v).value_or("")}, parts[i]->where};
    part.weight = curve_of(i == 0 ? 1 - second : second, blend.where(), world_.door);
    mixture.value.push_back(std::move(part));
  }
  if (parts.size() != 2) world_.door.diagnostics.error(blend.where(), "a blend takes two materials");
  return {std::move(mixture), {}, {}};
}

}  // namespace abbe::doors::mitsuba
