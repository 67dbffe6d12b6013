#include "description/material.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "description/material_readers.h"

namespace abbe::description {
namespace {

constexpr char kBlack[] = "black (lamp)";

constexpr std::array<std::pair<std::string_view, MaterialReader>, 14> kReaders{
    {{"diffuse", read_diffuse},
     {"dielectric", read_dielectric},
     {"conductor", read_conductor},
     {"film", read_film},
     {"medium", read_medium},
     {"coated_diffuse", read_coated_diffuse},
     {"thin_glass", read_thin_glass},
     {"mirror", read_mirror},
     {"schlick", read_schlick},
     {"oren_nayar", read_oren_nayar},
     {"principled", read_principled},
     {"cosine_power", read_cosine_power},
     {"phong", read_phong},
     {"retroreflector", read_retroreflector}}};

// Of the matter inside, which there must be.
int read_priority(const JsonValue& json, const Material& material, LoadContext& context) {
  const auto priority = read_integer(json, {-1000, 1000}, context.diagnostics);
  if (interior(material) == nullptr)
    context.diagnostics.error(json.where, "a priority goes with matter that light enters");
  return static_cast<int>(priority.value_or(0));
}

// A material that cannot be read stands as black, so that the shapes naming it are not reported as well.
Material read_material(const std::string& name, const JsonValue& json, LoadContext& context) {
  Material material{name, DiffuseMaterial{Curve(0.0)}};
  ObjectReader reader(json, context.diagnostics);
  std::vector<std::string_view> keys{"mixture"};  // made of the others, and read after them
  for (const auto& [key, read] : kReaders) keys.push_back(key);
  const auto key = reader.exactly_one(keys);
  const JsonValue* priority = reader.find("priority");
  for (const auto& [known, read] : kReaders)
    if (key == known)
      if (auto model = read(*reader.find(known), context)) {
        material.model = std::move(*model);
        if (priority != nullptr) material.priority = read_priority(*priority, material, context);
      }
  if (key == "mixture") material.model = MixtureMaterial{};
  material.relief = read_relief(reader, context);
  if (material.relief && is_boundary(material))
    context.diagnostics.error(json.where,
                              "a relief turns the light of a surface, which a medium has none of");
  if (key) reader.finish();
  return material;
}

}  // namespace

void read_materials(const JsonValue& json, LoadContext& context, Scene& scene) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members) {
    context.diagnostics.error(json.where,
                              fmt::format("expected an object of materials by name (got {})", json.kind()));
    return;
  }
  for (const auto& [name, value] : *members) {
    context.materials.emplace(name, static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(read_material(name, value, context));
  }
  for (const auto& [name, value] : *members) {
    MaterialModel& model = scene.materials[context.materials.at(name)].model;
    if (!std::holds_alternative<MixtureMaterial>(model)) continue;
    if (auto mixture = read_mixture(*value.find("mixture"), context, scene)) model = std::move(*mixture);
  }
}

std::optional<std::uint32_t> find_material(const schema::Located<std::string>& name, LoadContext& context,
                                           const Scene& scene) {
  if (const auto found = context.materials.find(name.value); found != context.materials.end())
    return found->second;
  std::vector<std::string> names;
  for (const Material& material : scene.materials) names.push_back(material.name);
  context.diagnostics.error(name.where, unknown_name("material", name.value, names));
  return std::nullopt;
}

std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                const SourcePosition& at, LoadContext& context, Scene& scene) {
  const std::string name = file + ":" + material.name;
  const auto [known, added] =
      context.materials.emplace(name, static_cast<std::uint32_t>(scene.materials.size()));
  if (!added) return known->second;
  if (material.index)
    scene.materials.push_back(
        {name, DielectricMaterial{fmt::format("{}", *material.index), RefractiveIndex(*material.index, 0)}});
  else
    scene.materials.push_back({name, DiffuseMaterial{rgb_spectrum(material.color)}});
  if (!material.lost.empty())
    context.diagnostics.warning(
        at, fmt::format("material \"{}\" of \"{}\": {} {} not represented", material.name, file,
                        fmt::join(material.lost, ", "), material.lost.size() == 1 ? "is" : "are"));
  return known->second;
}

std::uint32_t black_material(LoadContext& context, Scene& scene) {
  const auto [known, added] =
      context.materials.emplace(kBlack, static_cast<std::uint32_t>(scene.materials.size()));
  if (added) scene.materials.push_back({kBlack, DiffuseMaterial{Curve(0.0)}});
  return known->second;
}

}  // namespace abbe::description
