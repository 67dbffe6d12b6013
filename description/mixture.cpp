#include <memory>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"

namespace abbe::description {
namespace {

constexpr double kSlack = 1e-9;  // Thirds written with ten digits may add up to slightly more than 1.

// Material of that name, if it can be a component of a mixture; else reports why not and returns nullptr.
std::shared_ptr<const Material> mixable_material(const schema::Located<std::string>& name,
                                                 LoadContext& context, const Scene& scene) {
  const auto number = find_material(name, context, scene);
  if (!number) return nullptr;
  const Material& material = scene.materials[*number];
  const char* fault = nullptr;
  if (std::holds_alternative<MixtureMaterial>(material.model)) fault = "a mixture within a mixture";
  if (interior_index(material) != nullptr || medium(material) != nullptr)
    fault = "it has a medium inside, which a mixture cannot have";
  const auto delta_lobe = smooth_mueller(material, {550, 1, false});
  if (delta_lobe && delta_lobe->axis)
    fault = "its axis would be lost, because a mixture has one axis for all components";
  if (material.relief != nullptr) fault = "its relief would be lost; give the relief to the mixture";
  if (fault == nullptr) return std::make_shared<const Material>(material);
  context.diagnostics.error(name.where,
                            fmt::format("material \"{}\" cannot be mixed: {}", material.name, fault));
  return nullptr;
}

}  // namespace

std::optional<MixtureMaterial> build(const spec::Mixture& spec, LoadContext& context, const Scene& scene) {
  MixtureMaterial mixture;
  Curve total(0.0);
  for (const spec::MixturePart& part : spec.value) {
    auto weight = build(part.weight, kReflectanceUse, context);
    auto material = mixable_material(part.material, context, scene);
    if (!weight || !material) return std::nullopt;
    total = sum(total, *weight);
    mixture.components.push_back({std::move(*weight), std::move(material)});
  }
  if (total.max() <= 1 + kSlack) return mixture;
  context.diagnostics.error(
      spec.where, fmt::format("the weights of a mixture must add up to at most 1 (got {:g})", total.max()));
  return std::nullopt;
}

}  // namespace abbe::description
