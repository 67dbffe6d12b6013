#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "io/json.h"

namespace abbe::python {

/// Converts a Python object to JSON: None, booleans, numbers, strings, paths, lists, tuples, dicts with
/// string keys, and objects with `tolist`, such as numpy arrays and scalars. Throws InvalidInput of the code
/// `scene` with the JSON pointer for
/// - any other object;
/// - numbers that are not finite, and ints that a double would round;
/// - texts that UTF-8 cannot represent;
/// - nesting deeper than scene files allow, without the pointer.
/// `pointer` is that of the object itself. Requires the GIL.
[[nodiscard]] JsonValue to_json(const pybind11::handle& object, const std::string& pointer = "");

/// Converts a JSON value to a Python object. Whole numbers up to 2^53 - 1 in magnitude become int, except -0.
[[nodiscard]] pybind11::object to_python(const JsonValue& value);

}  // namespace abbe::python
