#include <memory>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"

namespace abbe::description {
namespace {

constexpr double kSlack = 1e-9;  // thirds written to ten digits may add up to 1

// The material of that name, if a mixture may be made of it.
std::shared_ptr<const Material> mixable_material(const schema::Located<std::string>& name,
                                                 LoadContext& context, const Scene& scene) {
  const auto number = find_material(name, context, scene);
  if (!number) return nullptr;
  const Material& material = scene.materials[*number];
  const char* fault = nullptr;
  if (std::holds_alternative<MixtureMaterial>(material.model)) fault = "a mixture within a mixture";
  if (interior(material) != nullptr || medium(material) != nullptr)
    fault = "light enters it, which a mixture has no inside for";
  if (std::holds_alternative<PolariserMaterial>(material.model) ||
      std::holds_alternative<WavePlateMaterial>(material.model))
    fault = "its axis would be lost, as a mixture has one of its own for all parts";
  if (material.relief != nullptr) fault = "its relief would be lost, which the mixture may have instead";
  if (fault == nullptr) return std::make_shared<const Material>(material);
  context.diagnostics.error(name.where,
                            fmt::format("material \"{}\" cannot be mixed: {}", material.name, fault));
  return nullptr;
}

}  // namespace

std::optional<MixtureMaterial> build(const spec::Mixture& said, LoadContext& context, const Scene& scene) {
  MixtureMaterial mixture;
  Curve total(0.0);
  for (const spec::MixturePart& part : said.value) {
    auto weight = build(part.weight, kReflectanceUse, context);
    auto material = mixable_material(part.material, context, scene);
    if (!weight || !material) return std::nullopt;
    total = sum(total, *weight);
    mixture.components.push_back({std::move(*weight), std::move(material)});
  }
  if (total.max() <= 1 + kSlack) return mixture;
  context.diagnostics.error(
      said.where, fmt::format("the weights of a mixture add up to at most 1 (got {:g})", total.max()));
  return std::nullopt;
}

}  // namespace abbe::description
