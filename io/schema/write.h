#pragma once

#include "io/schema/fields.h"

namespace abbe::schema {

/// The object that reads as this thing; what is as its initialiser makes it is left out. It has no places.
[[nodiscard]] JsonValue write(const Fields& fields, const void* thing);
template <typename T>
[[nodiscard]] JsonValue write(const T& thing) {
  return write(fields_of<T>(), &thing);
}
/// The value of that kind at an address.
[[nodiscard]] JsonValue write(const Kind& kind, const void* value);

}  // namespace abbe::schema
