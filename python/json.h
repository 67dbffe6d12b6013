#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "io/json.h"

namespace abbe::python {

/// The JSON value of an object of Python: of None, booleans, numbers, strings, paths, lists, tuples, dicts
/// with strings as keys, and of what has `tolist`, as arrays and scalars of numpy do. Throws InvalidInput,
/// which tells the JSON pointer, for any other object, for numbers that are not finite, for ints that a
/// double would round, and for nesting that no scene file may have. `pointer` is that of the object itself.
[[nodiscard]] JsonValue to_json(const pybind11::handle& object, const std::string& pointer = "");

/// A key as a JSON pointer has it [RFC6901].
[[nodiscard]] std::string escaped(const std::string& key);

/// The object of Python for a JSON value: whole numbers become int.
[[nodiscard]] pybind11::object to_python(const JsonValue& value);

}  // namespace abbe::python
