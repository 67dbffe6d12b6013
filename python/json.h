#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "io/json.h"

namespace abbe::python {

/// Converts a Python object to JSON: None, booleans, numbers, strings, paths, lists, tuples, dicts with
/// string keys, and objects with `tolist`, such as numpy arrays and scalars. Throws InvalidInput with the
/// JSON pointer for
/// - any other object;
/// - numbers that are not finite, and ints that a double would round;
/// - nesting deeper than scene files allow.
/// `pointer` is that of the object itself.
[[nodiscard]] JsonValue to_json(const pybind11::handle& object, const std::string& pointer = "");

/// A key escaped for a JSON pointer [RFC6901].
[[nodiscard]] std::string escaped(const std::string& key);

/// Converts a JSON value to a Python object; whole numbers become int.
[[nodiscard]] pybind11::object to_python(const JsonValue& value);

}  // namespace abbe::python
