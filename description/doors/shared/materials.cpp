#include "description/doors/shared/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/schema/read.h"
#include "io/text.h"

namespace abbe::doors {

std::optional<spec::Roughness> roughness_of(double along, double across, FacetShape distribution,
                                            const SourcePosition& where, Door& door) {
  const double u = std::clamp(along, 0.0, 1.0);
  const double v = std::clamp(across, 0.0, 1.0);
  if (u != along || v != across) door.note(where, "a width of facets outside [0, 1] is cut to that");
  if (u == 0 && v == 0) return std::nullopt;
  spec::Roughness roughness;
  roughness.where = where;
  const spec::Alpha alpha = u == v ? spec::Alpha(u) : spec::Alpha(std::array{u, v});
  if (distribution != FacetShape::ggx)
    roughness.value = spec::Facets{alpha, distribution};
  else if (u == v)
    roughness.value = u;
  else
    roughness.value = std::array{u, v};
  return roughness;
}

spec::Ior index_for(const Spectrum& reflectance, const SourcePosition& where, Door& door) {
  const auto k_of = [](double r) {
    const double kept = std::clamp(r, 0.0, 0.9996);  // what an extinction of 100 reflects, the most there is
    return 2 * std::sqrt(kept / (1 - kept));
  };
  door.note(where, "a metal's colour has no index: one with n = 1 that reflects it along the normal");
  const auto* rgb = std::get_if<LinearRgb>(&reflectance);
  const auto* samples = std::get_if<Samples>(&reflectance);
  if (rgb != nullptr || samples != nullptr) {
    return index_of(1.0, held(mapped(rgb ? samples_of(*rgb) : *samples, k_of), k_of(0)), where, door);
  }
  const auto* number = std::get_if<double>(&reflectance);
  return index_of(1.0, number ? Spectrum(k_of(*number)) : reflectance, where, door);
}

namespace {

template <typename Scene>
auto* find_material(const std::string& name, Scene& scene) {
  const auto found = std::ranges::find(scene.materials, name, &schema::Named<spec::Material>::name);
  return found == scene.materials.end() ? nullptr : &found->value;
}

// Gives `with` what of the model may be an image, if it has such.
template <typename Model, typename With>
void with_reflectance(Model& model, With with) {
  if constexpr (requires { model.reflectance; })
    with(model.reflectance);
  else if constexpr (requires { model.base_color; })
    with(model.base_color);
}

}  // namespace

bool is_textured(const std::string& name, const Door& door) {
  const spec::Material* material = find_material(name, door.scene);
  if (material == nullptr) return false;
  bool textured = !std::holds_alternative<std::monostate>(material->relief);
  const auto look = [&textured](const spec::Reflectance& reflectance) {
    textured = textured || std::holds_alternative<spec::Texture>(reflectance);
  };
  std::visit([&](const auto& model) { with_reflectance(model, look); }, material->model);
  if (const auto* mixture = std::get_if<spec::Mixture>(&material->model))
    for (const spec::MixturePart& part : mixture->value)
      textured = textured || is_textured(part.material.value, door);
  return textured;
}

bool is_matter(const std::string& name, const Door& door) {
  const spec::Material* material = find_material(name, door.scene);
  return material != nullptr && (std::holds_alternative<spec::Dielectric>(material->model) ||
                                 std::holds_alternative<spec::Medium>(material->model));
}

std::string without_images(const std::string& name, Door& door) {
  std::string plain = name + " without images";
  const spec::Material* given = find_material(name, door.scene);
  if (given == nullptr || find_material(plain, door.scene) != nullptr) return plain;
  spec::Material material = *given;
  material.relief = std::monostate{};
  const auto clear = [](spec::Reflectance& reflectance) {
    if (!std::holds_alternative<spec::Texture>(reflectance)) return;
    spec::Curve grey;
    grey.value = 0.5;
    reflectance = grey;
  };
  std::visit([&](auto& model) { with_reflectance(model, clear); }, material.model);
  if (auto* mixture = std::get_if<spec::Mixture>(&material.model))
    for (spec::MixturePart& part : mixture->value)
      if (is_textured(part.material.value, door))
        part.material.value = without_images(part.material.value, door);
  return door.add_material(plain, std::move(material));
}

void replace_materials(const std::filesystem::path& map, Door& door) {
  const auto source = door.read(map);
  if (!source) return;
  HeldMemory tree(door.inputs, 0);
  const auto json = parse_json(source, door.diagnostics, &tree);
  if (!json) return;
  const auto chosen = schema::read<spec::Materials>(*json, spec::materials(), door.diagnostics);
  if (!chosen) return;
  std::vector<std::string> names;
  for (const auto& material : door.scene.materials) names.push_back(material.name);
  for (const auto& material : *chosen) {
    spec::Material* replaced = find_material(material.name, door.scene);
    if (replaced == nullptr)
      door.diagnostics.error(material.where, unknown_name("material", material.name, names));
    else
      *replaced = material.value;
  }
}

}  // namespace abbe::doors
