#pragma once

#include <optional>

#include "io/schema/fields.h"

namespace abbe::schema {

/// Reads the struct at `instance`, which is default-constructed, from an object, or from an array if the
/// table has an array form. Members whose keys are absent are unchanged. Reports missing, unknown and
/// misspelt keys, and values of a wrong type or range. Returns false if there is an error. Valid keys are
/// read all the same; members with errors are emptied if they may be empty.
bool read(const JsonValue& json, const Fields& fields, void* instance, Diagnostics& diagnostics);

/// Reads a value of that type from JSON. `value` is the address of an object of the C++ type `type.cpp_type`.
/// Errors and result are those of the overload for structs.
bool read(const JsonValue& json, const ValueType& type, void* value, Diagnostics& diagnostics);

/// Reads a new T. Returns nothing after an error.
template <typename T>
[[nodiscard]] std::optional<T> read(const JsonValue& json, Diagnostics& diagnostics) {
  std::optional<T> instance(std::in_place);
  if (!read(json, fields_of<T>(), &*instance, diagnostics)) instance.reset();
  return instance;
}

/// Reads a value of that type into a new member M: the C++ type, or an optional or wrapper of it. Returns
/// nothing after an error.
template <typename M>
[[nodiscard]] std::optional<M> read(const JsonValue& json, const ValueType& type, Diagnostics& diagnostics) {
  std::optional<M> value(std::in_place);
  if (!read(json, type, detail::open_at(*value, json.where), diagnostics)) value.reset();
  return value;
}

}  // namespace abbe::schema
