#include <memory>
#include <utility>

#include <fmt/format.h>

#include "description/curve.h"
#include "description/material.h"
#include "description/material_readers.h"
#include "description/values.h"

namespace abbe::description {
namespace {

constexpr double kSlack = 1e-9;  // thirds written to ten digits may add up to 1

// The material of that name, if a mixture may be made of it.
std::shared_ptr<const Material> mixable_material(const JsonValue& name, LoadContext& context,
                                                 const Scene& scene) {
  const auto words = read_string(name, context.diagnostics);
  if (!words) return nullptr;
  const auto number = find_material({{*words}, name.where}, context, scene);
  if (!number) return nullptr;
  const Material& material = scene.materials[*number];
  const char* fault = nullptr;
  if (std::holds_alternative<MixtureMaterial>(material.model)) fault = "a mixture within a mixture";
  if (interior(material) != nullptr || medium(material) != nullptr)
    fault = "light enters it, which a mixture has no inside for";
  if (material.relief != nullptr) fault = "its relief would be lost, which the mixture may have instead";
  if (fault == nullptr) return std::make_shared<const Material>(material);
  context.diagnostics.error(name.where,
                            fmt::format("material \"{}\" cannot be mixed: {}", material.name, fault));
  return nullptr;
}

std::optional<MixtureMaterial::Component> read_component(const JsonValue& json, LoadContext& context,
                                                         const Scene& scene) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* name = reader.require("material");
  const JsonValue* weight_value = reader.require("weight");
  reader.finish();
  if (!name || !weight_value) return std::nullopt;
  auto weight = read_curve(*weight_value, {"reflectance", Range::unit()}, context);
  auto material = mixable_material(*name, context, scene);
  if (!weight || !material) return std::nullopt;
  return MixtureMaterial::Component{std::move(*weight), std::move(material)};
}

}  // namespace

std::optional<MixtureMaterial> read_mixture(const JsonValue& json, LoadContext& context, const Scene& scene) {
  const JsonValue::Array* entries = read_array(json, "parts", 1, context.diagnostics);
  if (!entries) return std::nullopt;
  MixtureMaterial mixture;
  Curve total(0.0);
  for (const JsonValue& entry : *entries) {
    auto component = read_component(entry, context, scene);
    if (!component) return std::nullopt;
    total = sum(total, component->weight);
    mixture.components.push_back(std::move(*component));
  }
  if (total.max() <= 1 + kSlack) return mixture;
  context.diagnostics.error(
      json.where, fmt::format("the weights of a mixture add up to at most 1 (got {:g})", total.max()));
  return std::nullopt;
}

}  // namespace abbe::description
