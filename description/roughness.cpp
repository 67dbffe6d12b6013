#include <algorithm>

#include <fmt/format.h>

#include "description/material_readers.h"

namespace abbe::description {
namespace {

// One width, or those along the x and y axes.
std::optional<Imath::V2f> read_alpha(const JsonValue& json, LoadContext& context) {
  if (std::holds_alternative<JsonValue::Array>(json.value)) {
    const auto xy = read_numbers(json, 2, Range::unit(), context.diagnostics);
    if (!xy) return std::nullopt;
    return Imath::V2f(static_cast<float>((*xy)[0]), static_cast<float>((*xy)[1]));
  }
  const auto alpha = read_number(json, Range::unit(), context.diagnostics);
  return alpha ? std::optional(Imath::V2f(static_cast<float>(*alpha))) : std::nullopt;
}

}  // namespace

std::optional<Microfacets<float>> read_roughness(const JsonValue* json, const Coating& coating,
                                                 LoadContext& context) {
  if (!json) return std::nullopt;
  std::optional<Imath::V2f> alpha;
  std::size_t shape = 0;
  if (std::holds_alternative<JsonValue::Object>(json->value)) {
    ObjectReader reader(*json, context.diagnostics);
    if (const JsonValue* widths = reader.require("alpha")) alpha = read_alpha(*widths, context);
    if (const JsonValue* name = reader.find("distribution"))
      shape = read_choice(*name, "distribution", {"ggx", "beckmann"}, context.diagnostics).value_or(0);
    reader.finish();
  } else {
    alpha = read_alpha(*json, context);
  }
  constexpr auto kLeast = static_cast<float>(kLeastAlpha);
  if (!alpha || std::max(alpha->x, alpha->y) < kLeast) return std::nullopt;
  if (!coating.layers.empty())
    context.diagnostics.error(json->where, "a coating lies on smooth surfaces only");
  const float wide = std::max(alpha->x, alpha->y);
  const float narrow = std::max(std::min(alpha->x, alpha->y), kLeast);
  if (wide > narrow * static_cast<float>(kMostStretch))
    context.diagnostics.error(json->where, fmt::format("alphas more than {} times apart (got {} and {})",
                                                       kMostStretch, alpha->x, alpha->y));
  return Microfacets<float>{shape == 0 ? FacetShape::ggx : FacetShape::beckmann, std::max(alpha->x, kLeast),
                            std::max(alpha->y, kLeast)};
}

}  // namespace abbe::description
