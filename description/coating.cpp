#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/index.h"

namespace abbe::description {
namespace {

// The number of the material that `said` names among those of `coating`, added if it is new: the same words
// name the same material.
std::optional<std::uint32_t> film_material(const spec::Ior& said, Coating& coating, LoadContext& context) {
  auto ior = build(said, context);
  if (!ior) return std::nullopt;
  const auto* words = std::get_if<std::string>(&said.value);
  const std::string name = words ? *words : ior->name;
  const auto known =
      std::find_if(coating.materials.begin(), coating.materials.end(),
                   [&](const Coating::Material& material) { return material.index_name == name; });
  const auto number = static_cast<std::uint32_t>(known - coating.materials.begin());
  if (known != coating.materials.end()) return number;
  if (number == Coating::kMaxMaterials) {
    context.diagnostics.error(
        said.where, fmt::format("too many materials in a coating (allowed {})", Coating::kMaxMaterials));
    return std::nullopt;
  }
  coating.materials.push_back({name, std::move(ior->index)});
  return number;
}

void add_layers(const std::vector<spec::LayerEntry>& entries, Coating& coating, LoadContext& context) {
  for (const spec::LayerEntry& entry : entries) {
    const std::size_t first = coating.layers.size();
    std::int64_t repeats = 1;
    if (const auto* group = std::get_if<spec::LayerGroup>(&entry.value)) {
      repeats = group->repeat;
      add_layers(group->layers, coating, context);
    } else {
      const auto& layer = std::get<spec::Layer>(entry.value);
      if (const auto material = film_material(layer.ior, coating, context))
        coating.layers.push_back({*material, layer.thickness_nm});
    }
    const std::size_t last = coating.layers.size();
    if (first + (last - first) * static_cast<std::size_t>(repeats) > Coating::kMaxLayers) {
      context.diagnostics.error(entry.where,
                                fmt::format("too many layers (allowed {})", Coating::kMaxLayers));
      return;
    }
    for (; repeats > 1; --repeats)
      for (std::size_t i = first; i < last; ++i) coating.layers.push_back(coating.layers[i]);
  }
}

}  // namespace

Coating build(const std::vector<spec::LayerEntry>& layers, LoadContext& context) {
  Coating coating;
  add_layers(layers, coating, context);
  return coating;
}

}  // namespace abbe::description
