#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "description/index.h"

namespace abbe::description {
namespace {

/// A coating under construction, with the first spec of each of its materials.
struct Films {
  Coating coating;
  std::vector<const spec::Ior*> specs;  // One for each material.
};

// True if neither index is a table, or both are tables with the same data. The names of tables do not
// distinguish them.
bool same_tables(const spec::Ior& a, const spec::Ior& b) {
  const auto* one = std::get_if<spec::TableIor>(&a.value);
  const auto* other = std::get_if<spec::TableIor>(&b.value);
  if (one == nullptr || other == nullptr) return one == other;
  return std::tie(one->wavelength_nm, one->n, one->k) == std::tie(other->wavelength_nm, other->n, other->k);
}

// Index of the material of `spec` in the coating, added if it is new. Equal names, numbers or tables are the
// same material.
std::optional<std::uint32_t> film_material(const spec::Ior& spec, Films& films, LoadContext& context) {
  auto ior = build(spec, context);
  if (!ior) return std::nullopt;
  const auto* words = std::get_if<std::string>(&spec.value);
  const std::string name = words ? *words : ior->name;
  std::vector<Coating::Material>& materials = films.coating.materials;
  std::uint32_t number = 0;
  for (; number < materials.size(); ++number)
    if (materials[number].index_name == name && same_tables(*films.specs[number], spec)) return number;
  if (number == Coating::kMaxMaterials) {
    context.diagnostics.error(
        spec.where, fmt::format("too many materials in a coating (allowed {})", Coating::kMaxMaterials));
    return std::nullopt;
  }
  materials.push_back({name, std::move(ior->index)});
  films.specs.push_back(&spec);
  return number;
}

void add_layers(const std::vector<spec::LayerEntry>& entries, Films& films, LoadContext& context) {
  std::vector<Coating::Layer>& layers = films.coating.layers;
  for (const spec::LayerEntry& entry : entries) {
    const std::size_t first = layers.size();
    std::int64_t repeats = 1;
    if (const auto* group = std::get_if<spec::LayerGroup>(&entry.value)) {
      repeats = group->repeat;
      add_layers(group->layers, films, context);
    } else {
      const auto& layer = std::get<spec::Layer>(entry.value);
      if (const auto material = film_material(layer.ior, films, context))
        layers.push_back({*material, layer.thickness_nm});
    }
    const std::size_t last = layers.size();
    if (first + (last - first) * static_cast<std::size_t>(repeats) > Coating::kMaxLayers) {
      context.diagnostics.error(entry.where,
                                fmt::format("too many layers (allowed {})", Coating::kMaxLayers));
      return;
    }
    for (; repeats > 1; --repeats)
      for (std::size_t i = first; i < last; ++i) layers.push_back(layers[i]);
  }
}

}  // namespace

Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context) {
  Films films;
  add_layers(layers, films, context);
  return std::move(films.coating);
}

}  // namespace abbe::description
