#include "importers/pbrt/scene_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "importers/pbrt/spectra.h"
#include "importers/shared/materials.h"
#include "io/schema/write.h"

namespace abbe::importers::pbrt {

namespace {

const std::vector<std::string> kMaterialTypes{
    "coatedconductor",     "coateddiffuse", "conductor", "dielectric", "diffuse",
    "diffusetransmission", "hair",          "interface", "measured",   "mix",
    "subsurface",          "thindielectric"};

// Converts the homogeneous medium called `name`; its coefficients are in 1/m. Reports an unknown name at
// `where`. Other types of medium are noted. Both become empty, without absorption and scattering.
spec::Medium medium_of(const std::string& name, const SourcePosition& where, ImportState& state) {
  spec::Medium medium;
  const Directive* directive = find(state.media, "medium", name, where, state.importer);
  if (directive == nullptr) return medium;
  state.importer.note_medium(directive->where);
  const Parameters& p = directive->parameters;
  if (directive->type != "homogeneous") {
    state.importer.note(
        directive->where,
        fmt::format("a medium \"{}\" is not supported: replaced by an empty one", directive->type));
    return medium;
  }
  if (p.has("preset"))
    state.importer.note(directive->where, "presets of media are not supported: pbrt's defaults are used");
  p.ignore({"preset"});
  const double scale = p.number("scale", 1);
  // pbrt's defaults, per unit of length.
  const LinearRgb absorption{0.0011, 0.0024, 0.014};
  const LinearRgb scattering{2.55, 3.21, 3.77};
  medium.absorption_per_m =
      curve_of(scaled(spectrum(p, "sigma_a", absorption, state), scale), directive->where, state.importer);
  medium.scattering.per_m =
      curve_of(scaled(spectrum(p, "sigma_s", scattering, state), scale), directive->where, state.importer);
  const double g = p.number("g", 0);
  if (g != 0) medium.scattering.phase = {{spec::HenyeyGreenstein{g}}, directive->where};
  if (p.has("Le")) state.importer.note(directive->where, "emission of media is not supported: dropped");
  p.ignore({"Le", "Lescale"});
  p.note_unused("medium");
  return medium;
}

double slope_width(double value, bool remapped) {
  return remapped && value > 0 ? std::sqrt(value) : value;
}

// Microfacet widths of a material. pbrt takes the square root of roughness parameters unless "remaproughness"
// is false.
std::optional<spec::Roughness> roughness(const Parameters& p, const SourcePosition& where,
                                         ImportState& state) {
  const bool remapped = p.boolean("remaproughness", true);
  const double both = number(p, "roughness", 0, state);
  const double u = slope_width(number(p, "uroughness", both, state), remapped);
  const double v = slope_width(number(p, "vroughness", both, state), remapped);
  return roughness_of(u, v, FacetShape::ggx, where, state.importer);
}

spec::Ior conductor_index(const Directive& directive, std::string_view eta, std::string_view k,
                          ImportState& state) {
  const Parameters& p = directive.parameters;
  if (!p.has("reflectance")) return metal_index(p, eta, k, state);
  return index_of_reflectance(spectrum(p, "reflectance", 0.5, state), directive.where, state.importer);
}

spec::Conductor conductor(const Directive& directive, ImportState& state) {
  return {conductor_index(directive, "eta", "k", state),
          {},
          roughness(directive.parameters, directive.where, state)};
}

spec::Conductor coated_conductor(const Directive& directive, ImportState& state) {
  const Parameters& p = directive.parameters;
  directive.note("a coated conductor is not supported: replaced by the bare metal");
  p.ignore({"interface.roughness", "thickness", "interface.eta", "g", "albedo", "maxdepth", "nsamples"});
  spec::Conductor metal;
  metal.ior = conductor_index(directive, "conductor.eta", "conductor.k", state);
  const bool remapped = p.boolean("remaproughness", true);
  const double width = slope_width(number(p, "conductor.roughness", 0, state), remapped);
  metal.roughness = roughness_of(width, width, FacetShape::ggx, directive.where, state.importer);
  return metal;
}

spec::CoatedDiffuse coated_diffuse(const Directive& directive, ImportState& state) {
  const Parameters& p = directive.parameters;
  spec::CoatedDiffuse coated{glass_index(p, state), reflectance(p, "reflectance", 0.5, state)};
  if (roughness(p, directive.where, state))
    directive.note("roughness of a clear coat is not supported: dropped");
  p.ignore(
      // These parameters concern pbrt's random walk; without a medium in the coat they have no other effect.
      {"thickness", "maxdepth", "nsamples"});
  return coated;
}

spec::Dielectric dielectric(const Directive& directive, const std::string& interior, ImportState& state) {
  spec::Dielectric glass;
  glass.ior.ior = glass_index(directive.parameters, state);
  glass.roughness = roughness(directive.parameters, directive.where, state);
  if (interior.empty()) return glass;
  const spec::Medium medium = medium_of(interior, directive.where, state);
  glass.ior.absorption_per_m = medium.absorption_per_m;
  glass.scattering = medium.scattering;
  return glass;
}

spec::ThinGlass thin_glass(const Directive& directive, ImportState& state) {
  spec::ThinGlass pane;
  pane.ior.ior = glass_index(directive.parameters, state);
  return pane;
}

spec::Diffuse replacement(const Directive& directive, ImportState& state) {
  directive.note(
      fmt::format("a material \"{}\" is not supported: replaced by a diffuse one", directive.type));
  return {reflectance(directive.parameters, "reflectance", 0.5, state)};
}

void add_relief(const Directive& directive, spec::Material& material, ImportState& state) {
  const Parameters& p = directive.parameters;
  if (const Parameter* map = p.find("normalmap", {"string"})) {
    const auto path = state.folder / map->texts.front();
    if (!state.importer.check_file(path, map->where)) return;
    spec::TextureFile file;
    file.image = {{state.importer.name_of(path)}, map->where};
    material.relief = spec::NormalMap{file};
  } else if (const Parameter* heights = p.find("displacement", {"texture"})) {
    if (const auto file = image(heights->texts.front(), heights->where, state))
      material.relief = spec::BumpMap{*file, 1};
  }
}

}  // namespace

std::string Materials::name_of(const MaterialUse& use) {
  // A file that is included twice may have another graphics state each time.
  const std::string key = use.name.empty() ? std::to_string(use.number) : "=" + use.name;
  const auto [known, is_new] = names_.try_emplace(key + "|" + use.interior);
  if (!is_new) return known->second;
  const std::string& type = use.directive.type;
  std::string name = !use.name.empty() ? use.name : type.empty() ? "interface" : type;
  if (!use.interior.empty()) name += " with " + use.interior;
  spec::Material material = converted(use);
  add_relief(use.directive, material, import_);
  use.directive.parameters.note_unused(fmt::format("material \"{}\"", use.directive.type));
  std::string& result = names_[key + "|" + use.interior];
  if (!use.name.empty()) return result = import_.importer.add_material(name, std::move(material));
  const spec::Materials alone{{name, material, {}}};
  const auto [equal, is_first] = unnamed_.try_emplace(to_text(schema::write(spec::materials(), &alone)));
  if (is_first) equal->second = import_.importer.add_material(name, std::move(material));
  return result = equal->second;
}

spec::Material Materials::converted(const MaterialUse& use) {
  const Directive& directive = use.directive;
  const std::string& type = directive.type;
  if (type == "mix") return mixture(directive);
  spec::Material material;
  if (type == "diffuse") {
    material.model = spec::Diffuse{reflectance(directive.parameters, "reflectance", 0.5, import_)};
  } else if (type == "conductor") {
    material.model = conductor(directive, import_);
  } else if (type == "coatedconductor") {
    material.model = coated_conductor(directive, import_);
  } else if (type == "coateddiffuse") {
    material.model = coated_diffuse(directive, import_);
  } else if (type == "dielectric") {
    material.model = dielectric(directive, use.interior, import_);
  } else if (type == "thindielectric") {
    material.model = thin_glass(directive, import_);
  } else if ((type == "interface" || type.empty()) && !use.interior.empty()) {
    material.model = medium_of(use.interior, directive.where, import_);
  } else {
    import_.importer.is_known("material", type, kMaterialTypes, directive.where);
    material.model = replacement(directive, import_);
  }
  return material;
}

spec::Material Materials::mixture(const Directive& directive) {
  spec::Mixture parts;
  parts.where = directive.where;
  const double second = number(directive.parameters, "amount", 0.5, import_);
  const Parameter* names = directive.parameters.find("materials", {"string"});
  if (names == nullptr || names->texts.size() != 2) {
    directive.fail("a mix needs \"materials\" with two names");
    return {spec::Diffuse{curve_of(0.5, directive.where, import_.importer)}, {}, {}};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Directive* part =
        find(import_.materials, "material", names->texts[i], names->where, import_.importer);
    if (part == nullptr) continue;
    if (part->type == "mix" || part->type == "dielectric" || part->type == "interface") {
      import_.importer.fail(names->where, fmt::format("a mix with \"{}\" is not supported", part->type));
      continue;
    }
    spec::MixturePart mixed;
    mixed.material = {{name_of({*part, names->texts[i], ""})}, names->where};
    mixed.weight = curve_of(i == 0 ? 1 - second : second, directive.where, import_.importer);
    parts.value.push_back(std::move(mixed));
  }
  return {std::move(parts), {}, {}};
}

}  // namespace abbe::importers::pbrt
