#pragma once

#include <utility>

#include "io/schema/fields.h"

namespace abbe::schema {

/// A value that stands nowhere in a file.
[[nodiscard]] inline JsonValue json(decltype(JsonValue::value) value) {
  return {std::move(value), {}};
}
/// The object that reads as this thing; what is as its initialiser makes it is left out. It has no places.
[[nodiscard]] JsonValue write(const Fields& fields, const void* thing);
template <typename T>
[[nodiscard]] JsonValue write(const T& thing) {
  return write(fields_of<T>(), &thing);
}
/// The value of that kind at an address.
[[nodiscard]] JsonValue write(const Kind& kind, const void* value);

/// What holds without the field's key, if it may be absent and that is worth telling: no infinity, and no
/// list of nothing. `defaults` is that of its table.
[[nodiscard]] std::optional<JsonValue> default_of(const Field& field, const void* defaults);

}  // namespace abbe::schema
