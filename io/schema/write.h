#pragma once

#include <utility>

#include "io/schema/fields.h"

namespace abbe::schema {

/// A JSON value without a source position. Numbers must be finite.
[[nodiscard]] inline JsonValue json(decltype(JsonValue::value) value) {
  return {std::move(value), {}};
}
/// The JSON object from which `read` makes the struct at `instance`, in the order of its table, without
/// source positions. Empty members and optional members with their default are omitted.
[[nodiscard]] JsonValue write(const Fields& fields, const void* instance);
template <typename T>
[[nodiscard]] JsonValue write(const T& instance) {
  return write(fields_of<T>(), &instance);
}
/// JSON of the value at address `value`, an object of the C++ type `type.cpp_type`.
[[nodiscard]] JsonValue write(const ValueType& type, const void* value);

/// The default of an optional field, for documentation. `defaults` is `Fields::defaults`. Nothing for a
/// member that is absent by default, and for a default that is infinite or an empty list or object.
[[nodiscard]] std::optional<JsonValue> default_of(const Field& field, const void* defaults);

/// The JSON Schema (draft 2020-12) of a file that contains one such struct, without source positions. It
/// accepts exactly the files that `read` accepts without an error.
[[nodiscard]] JsonValue json_schema(const Fields& fields);

}  // namespace abbe::schema
