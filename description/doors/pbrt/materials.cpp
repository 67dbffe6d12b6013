#include "description/doors/pbrt/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "description/doors/pbrt/media.h"
#include "description/doors/pbrt/spectra.h"
#include "description/doors/shared/materials.h"
#include "io/schema/write.h"

namespace abbe::doors::pbrt {
namespace {

const std::vector<std::string> kMaterialTypes{
    "coatedconductor",     "coateddiffuse", "conductor", "dielectric", "diffuse",
    "diffusetransmission", "hair",          "interface", "measured",   "mix",
    "subsurface",          "thindielectric"};

// The width of slopes that a number stands for.
double slope_width(double said, bool remapped) {
  return remapped && said > 0 ? std::sqrt(said) : said;
}

// Widths of slopes as the parameters say them; the root of what they say unless told otherwise.
std::optional<spec::Roughness> roughness(const Parameters& p, const SourcePosition& where, World& world) {
  const bool remapped = p.truth("remaproughness", true, world.door);
  const double both = number(p, "roughness", 0, world);
  const double u = slope_width(number(p, "uroughness", both, world), remapped);
  const double v = slope_width(number(p, "vroughness", both, world), remapped);
  return roughness_of(u, v, FacetShape::ggx, where, world.door);
}

spec::Conductor conductor(const Made& made, World& world) {
  spec::Conductor metal;
  const Parameters& p = made.parameters;
  if (p.has("reflectance")) {
    metal.ior = index_for(spectrum(p, "reflectance", 0.5, world), made.where, world.door);
  } else {
    metal.ior = metal_index(p, "eta", "k", world);
  }
  metal.roughness = roughness(p, made.where, world);
  return metal;
}

spec::Conductor coated_conductor(const Made& made, World& world) {
  const Parameters& p = made.parameters;
  world.door.note(made.where, "a coated conductor has no counterpart here: the bare metal in its place");
  p.ignore({"interface.roughness", "thickness", "interface.eta", "g", "albedo", "maxdepth", "nsamples"});
  spec::Conductor metal;
  metal.ior = p.has("reflectance") ? index_for(spectrum(p, "reflectance", 0.5, world), made.where, world.door)
                                   : metal_index(p, "conductor.eta", "conductor.k", world);
  const bool remapped = p.truth("remaproughness", true, world.door);
  const double width = slope_width(number(p, "conductor.roughness", 0, world), remapped);
  metal.roughness = roughness_of(width, width, FacetShape::ggx, made.where, world.door);
  return metal;
}

spec::CoatedDiffuse coated_diffuse(const Made& made, World& world) {
  const Parameters& p = made.parameters;
  spec::CoatedDiffuse coated{glass_index(p, "eta", world), reflectance(p, "reflectance", 0.5, world)};
  if (roughness(p, made.where, world))
    world.door.note(made.where, "a clear coat is smooth here: its roughness is dropped");
  p.ignore(
      {"thickness", "maxdepth", "nsamples"});  // of how it is computed; without matter in it nothing else
  return coated;
}

spec::Dielectric dielectric(const Made& made, const std::string& inside, World& world) {
  spec::Dielectric glass;
  glass.ior.ior = glass_index(made.parameters, "eta", world);
  glass.roughness = roughness(made.parameters, made.where, world);
  if (inside.empty()) return glass;
  const spec::Medium medium = medium_of(inside, made.where, world);
  glass.ior.absorption_per_m = medium.absorption_per_m;
  glass.scattering = medium.scattering;
  return glass;
}

spec::ThinGlass thin_glass(const Made& made, World& world) {
  spec::ThinGlass pane;
  pane.ior.ior = glass_index(made.parameters, "eta", world);
  return pane;
}

spec::Diffuse replacement(const Made& made, World& world) {
  world.door.note(made.where,
                  fmt::format("a material \"{}\" has no counterpart here: diffuse in its place", made.type));
  return {reflectance(made.parameters, "reflectance", 0.5, world)};
}

// The relief beside any model.
void add_relief(const Made& made, spec::Material& material, World& world) {
  const Parameters& p = made.parameters;
  if (const Parameter* map = p.find("normalmap", {"string"}, world.door)) {
    const auto path = world.folder / map->texts.front();
    if (!world.door.take_file(path, map->where)) return;
    spec::TextureFile file;
    file.image = {{world.door.name_of(path)}, map->where};
    material.relief = spec::NormalMap{file};
  } else if (const Parameter* heights = p.find("displacement", {"texture"}, world.door)) {
    if (const auto file = image(heights->texts.front(), heights->where, world))
      material.relief = spec::BumpMap{*file, 1};
  }
}

}  // namespace

std::string Materials::name_of(const MaterialUse& use) {
  // A line that is included twice may stand under other attributes each time.
  const std::string key = use.name.empty() ? std::to_string(use.number) : "=" + use.name;
  const auto [known, is_new] = names_.try_emplace(key + "|" + use.inside);
  if (!is_new) return known->second;
  const std::string& type = use.made.type;
  std::string name = !use.name.empty() ? use.name : type.empty() ? "interface" : type;
  if (!use.inside.empty()) name += " with " + use.inside;
  spec::Material material = converted(use);
  add_relief(use.made, material, world_);
  use.made.parameters.note_unused(fmt::format("material \"{}\"", use.made.type), world_.door);
  std::string& named = names_[key + "|" + use.inside];
  if (!use.name.empty()) return named = world_.door.add_material(name, std::move(material));
  const spec::Materials alone{{name, material, {}}};
  const auto [equal, is_first] = shared_.try_emplace(to_text(schema::write(spec::materials(), &alone)));
  if (is_first) equal->second = world_.door.add_material(name, std::move(material));
  return named = equal->second;
}

spec::Material Materials::converted(const MaterialUse& use) {
  const Made& made = use.made;
  const std::string& type = made.type;
  if (type == "mix") return mixture(made);
  spec::Material material;
  if (type == "diffuse") {
    material.model = spec::Diffuse{reflectance(made.parameters, "reflectance", 0.5, world_)};
  } else if (type == "conductor") {
    material.model = conductor(made, world_);
  } else if (type == "coatedconductor") {
    material.model = coated_conductor(made, world_);
  } else if (type == "coateddiffuse") {
    material.model = coated_diffuse(made, world_);
  } else if (type == "dielectric") {
    material.model = dielectric(made, use.inside, world_);
  } else if (type == "thindielectric") {
    material.model = thin_glass(made, world_);
  } else if ((type == "interface" || type.empty()) && !use.inside.empty()) {
    material.model = medium_of(use.inside, made.where, world_);
  } else {
    if (std::ranges::find(kMaterialTypes, type) == kMaterialTypes.end())
      world_.door.diagnostics.error(made.where, unknown_name("material", type, kMaterialTypes));
    material.model = replacement(made, world_);
  }
  return material;
}

spec::Material Materials::mixture(const Made& made) {
  spec::Mixture parts;
  parts.where = made.where;
  const double second = number(made.parameters, "amount", 0.5, world_);
  const Parameter* names = made.parameters.find("materials", {"string"}, world_.door);
  if (names == nullptr || names->texts.size() != 2) {
    world_.door.diagnostics.error(made.where, "a mix takes \"materials\", the names of two");
    return {spec::Diffuse{curve_of(0.5, made.where, world_.door)}, {}, {}};
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Made* part = find(world_.materials, "material", names->texts[i], names->where, world_.door);
    if (part == nullptr) continue;
    if (part->type == "mix" || part->type == "dielectric" || part->type == "interface") {
      world_.door.diagnostics.error(names->where,
                                    fmt::format("a mix of \"{}\" has no counterpart here", part->type));
      continue;
    }
    spec::MixturePart share;
    share.material = {{name_of({*part, names->texts[i], ""})}, names->where};
    share.weight = curve_of(i == 0 ? 1 - second : second, made.where, world_.door);
    parts.value.push_back(std::move(share));
  }
  return {std::move(parts), {}, {}};
}

}  // namespace abbe::doors::pbrt
