#pragma once

#include <optional>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "io/diagnostics.h"
#include "io/invalid_input.h"

namespace abbe::python {

/// Throws the errors; issues each warning as a `warnings.warn` of Python.
void check(const Diagnostics& diagnostics);

/// Issues a `warnings.warn` of Python of the class SceneWarning; throws where the user made it an exception.
void warn(const std::string& text);

/// What a loader gave, its complaints treated as by `check`.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader gave nothing and said nothing");
  return *std::move(value);
}

/// Adds the class of diagnostics, and makes exceptions of Python of ours.
void add_errors(pybind11::module_& module);

}  // namespace abbe::python
