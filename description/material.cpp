#include "description/material.h"

#include <utility>

#include <fmt/format.h>

namespace abbe::description {
namespace {

constexpr char kBlack[] = "black (light)";

// Builds a material. One with an error becomes black.
Material build_material(const schema::Named<spec::Material>& spec, LoadContext& context) {
  Material material{spec.name, DiffuseMaterial{Curve(0.0)}};
  if (auto model = build_model(spec.value, context)) material.model = *std::move(model);
  if (const auto& priority = spec.value.priority) {
    if (!encloses_medium(material))
      context.diagnostics.error(priority->where,
                                "priority applies only to a medium inside a shape: a dielectric or a medium");
    material.priority = priority->value;
  }
  if (const auto* normals = std::get_if<spec::NormalMap>(&spec.value.relief))
    material.relief = build(*normals, context);
  if (const auto* bumps = std::get_if<spec::BumpMap>(&spec.value.relief))
    material.relief = build(*bumps, context);
  if (material.relief && is_boundary(material))
    context.diagnostics.error(spec.where, "a medium has no surface and cannot have a normal_map or bump_map");
  return material;
}

}  // namespace

void build_materials(const spec::Materials& materials, LoadContext& context, Scene& scene) {
  for (const auto& spec : materials) {
    context.materials.emplace(spec.name, static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(build_material(spec, context));
  }
  for (const auto& [name, material, where] :
       materials) {  // Mixtures refer to the other materials and are built after them.
    const auto* mixture_spec = std::get_if<spec::Mixture>(&material.model);
    if (mixture_spec == nullptr) continue;
    if (auto mixture = build(*mixture_spec, context, scene))
      scene.materials[context.materials.at(name)].model = std::move(*mixture);
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
  if (!material.ignored.empty())
    context.diagnostics.warning(
        at, fmt::format("material \"{}\" of \"{}\": {} {} not represented", material.name, file,
                        fmt::join(material.ignored, ", "), material.ignored.size() == 1 ? "is" : "are"));
  return known->second;
}

std::uint32_t black_material(LoadContext& context, Scene& scene) {
  const auto [known, added] =
      context.materials.emplace(kBlack, static_cast<std::uint32_t>(scene.materials.size()));
  if (added) scene.materials.push_back({kBlack, DiffuseMaterial{Curve(0.0)}});
  return known->second;
}

}  // namespace abbe::description
