#pragma once

#include <utility>

#include "io/schema/fields.h"

namespace abbe::schema {

/// A JSON value without a source position.
[[nodiscard]] inline JsonValue json(decltype(JsonValue::value) value) {
  return {std::move(value), {}};
}
/// The object that `read` reads as this struct. Members with their default are omitted. It has no source
/// positions.
[[nodiscard]] JsonValue write(const Fields& fields, const void* instance);
template <typename T>
[[nodiscard]] JsonValue write(const T& instance) {
  return write(fields_of<T>(), &instance);
}
/// The value of that type at address `value`.
[[nodiscard]] JsonValue write(const ValueType& type, const void* value);

/// The default of an optional field, for documentation. Nothing if the default is infinite or an empty list
/// or object. `defaults` comes from the field table.
[[nodiscard]] std::optional<JsonValue> default_of(const Field& field, const void* defaults);

}  // namespace abbe::schema
