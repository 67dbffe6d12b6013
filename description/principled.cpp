#include <utility>

#include "description/material_readers.h"

namespace abbe::description {

std::optional<MaterialModel> read_principled(const JsonValue& json, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const JsonValue* color = reader.require("base_color");
  PrincipledLook look;
  const auto to = [](float& amount, double read) { amount = static_cast<float>(read); };
  to(look.metallic, reader.number_or("metallic", 0, Range::unit()));
  to(look.roughness, reader.number_or("roughness", 0.5, Range::unit()));
  to(look.specular, reader.number_or("specular", 0.5, Range::unit()));
  to(look.sheen, reader.number_or("sheen", 0, Range::unit()));
  to(look.clearcoat, reader.number_or("clearcoat", 0, Range::unit()));
  to(look.clearcoat_gloss, reader.number_or("clearcoat_gloss", 1, Range::unit()));
  reader.finish();
  if (!color) return std::nullopt;
  auto base = read_reflectance(*color, context);
  if (!base) return std::nullopt;
  return PrincipledMaterial{std::move(*base), Principled(look)};
}

}  // namespace abbe::description
