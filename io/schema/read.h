#pragma once

#include <optional>

#include "io/schema/fields.h"

namespace abbe::schema {

/// Reads the struct at `instance` from an object. Members that have no key keep their value. Reports missing,
/// unknown and misspelt keys, and values of a wrong type or range. Returns false if there is an error; valid
/// keys are read all the same.
bool read(const JsonValue& json, const Fields& fields, void* instance, Diagnostics& diagnostics);

/// Reads a value of that type from JSON. Errors and result are those of the overload for structs.
bool read(const JsonValue& json, const ValueType& type, void* value, Diagnostics& diagnostics);

/// Reads a new T. Returns nothing after an error.
template <typename T>
[[nodiscard]] std::optional<T> read(const JsonValue& json, Diagnostics& diagnostics) {
  std::optional<T> instance(std::in_place);
  if (!read(json, fields_of<T>(), &*instance, diagnostics)) instance.reset();
  return instance;
}

/// Reads a value of that type into a new member M. Returns nothing after an error.
template <typename M>
[[nodiscard]] std::optional<M> read(const JsonValue& json, const ValueType& type, Diagnostics& diagnostics) {
  std::optional<M> value(std::in_place);
  if (!read(json, type, detail::open_at(*value, json.where), diagnostics)) value.reset();
  return value;
}

}  // namespace abbe::schema
