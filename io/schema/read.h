#pragma once

#include <optional>

#include "io/schema/fields.h"

namespace abbe::schema {

/// Reads a thing from an object as its table says, over what `thing` is already. Reports what is wrong: a
/// missing, unknown or misspelt key, a value of another kind or out of range. False if there is an error;
/// what is sound has been read all the same.
bool read(const JsonValue& json, const Fields& fields, void* thing, Diagnostics& diagnostics);

/// Reads a value of that kind, as `read` does a thing.
bool read(const JsonValue& json, const Kind& kind, void* value, Diagnostics& diagnostics);

/// The same for a new thing, nothing after an error.
template <typename T>
[[nodiscard]] std::optional<T> read(const JsonValue& json, Diagnostics& diagnostics) {
  std::optional<T> thing(std::in_place);
  if (!read(json, fields_of<T>(), &*thing, diagnostics)) thing.reset();
  return thing;
}

/// The same for a value of that kind, which `M` holds.
template <typename M>
[[nodiscard]] std::optional<M> read(const JsonValue& json, const Kind& kind, Diagnostics& diagnostics) {
  std::optional<M> value(std::in_place);
  if (!read(json, kind, detail::open_at(*value, json.where), diagnostics)) value.reset();
  return value;
}

}  // namespace abbe::schema
