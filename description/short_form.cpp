#include "description/short_form.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace abbe::description {
namespace {

constexpr std::array<const char*, 4> kKeys{"radius", "thickness", "glass", "aperture"};

void expand(JsonValue& surface, Diagnostics& diagnostics) {
  auto* const values = std::get_if<JsonValue::Array>(&surface.value);
  if (values == nullptr) return;
  if (values->size() < 2 || values->size() > kKeys.size())
    diagnostics.error(
        surface.where,
        fmt::format("a surface in brackets has radius, thickness, and perhaps glass and aperture (got {} "
                    "values, allowed 2 to 4)",
                    values->size()));
  JsonValue::Object object;
  for (std::size_t i = 0; i < std::min(values->size(), kKeys.size()); ++i) {
    JsonValue& value = (*values)[i];
    if (std::holds_alternative<std::nullptr_t>(value.value)) continue;
    value.key_offset = value.where.offset;
    object.push_back({kKeys[i], std::move(value)});
  }
  surface.value = std::move(object);
}

}  // namespace

void expand_short_surfaces(JsonValue& lens, Diagnostics& diagnostics) {
  JsonValue* const surfaces = lens.find("surfaces");
  auto* const list = surfaces != nullptr ? std::get_if<JsonValue::Array>(&surfaces->value) : nullptr;
  if (list == nullptr) return;
  for (JsonValue& surface : *list) expand(surface, diagnostics);
}

}  // namespace abbe::description
