#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/material_readers.h"
#include "description/values.h"

namespace abbe::description {
namespace {

constexpr Range kFilmThickness{0, 1e5, true, false};  // [nm]; nothing thicker is coherent
constexpr Range kRepeats{1, static_cast<double>(Coating::kMaxLayers)};

// The number of the material that `json` names among those of `coating`, added if it is new: the same words
// name the same material.
std::optional<std::uint32_t> film_material(const JsonValue& json, Coating& coating, LoadContext& context) {
  auto ior = read_ior(json, kIndex, context);
  if (!ior) return std::nullopt;
  const auto* words = std::get_if<std::string>(&json.value);
  const std::string name = words ? *words : ior->name;
  const auto known =
      std::find_if(coating.materials.begin(), coating.materials.end(),
                   [&](const Coating::Material& material) { return material.index_name == name; });
  const auto number = static_cast<std::uint32_t>(known - coating.materials.begin());
  if (known != coating.materials.end()) return number;
  if (number == Coating::kMaxMaterials) {
    context.diagnostics.error(
        json.where, fmt::format("too many materials in a coating (allowed {})", Coating::kMaxMaterials));
    return std::nullopt;
  }
  coating.materials.push_back({name, std::move(ior->index)});
  return number;
}

// Layers and repeated groups of them, from the outside inwards.
void read_layers(const JsonValue& json, Coating& coating, LoadContext& context) {
  const JsonValue::Array* entries = read_array(json, "layers", 1, context.diagnostics);
  if (!entries) return;
  for (const JsonValue& entry : *entries) {
    ObjectReader reader(entry, context.diagnostics);
    const std::size_t first = coating.layers.size();
    std::int64_t repeats = 1;
    if (const JsonValue* group = reader.find("layers")) {
      repeats = reader.integer("repeat", kRepeats).value_or(1);
      read_layers(*group, coating, context);
    } else {
      const JsonValue* ior = reader.require("ior");
      const auto thickness = reader.require_number("thickness_nm", kFilmThickness);
      const auto material = ior ? film_material(*ior, coating, context) : std::nullopt;
      if (material && thickness) coating.layers.push_back({*material, *thickness});
    }
    reader.finish();
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

Coating read_coating(const JsonValue* layers, LoadContext& context) {
  Coating coating;
  if (layers) read_layers(*layers, coating, context);
  return coating;
}

}  // namespace abbe::description
