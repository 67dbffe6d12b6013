#pragma once

#include <optional>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "io/diagnostics.h"
#include "io/invalid_input.h"

namespace abbe::python {

/// Throws if there are errors; issues each warning by Python's `warnings.warn`.
void check(const Diagnostics& diagnostics);

/// Issues a Python warning of the class SceneWarning. Throws if the user made it an exception.
void warn(const std::string& text);

/// The value of a loader, after `check` of its diagnostics.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader returned nothing and reported no error");
  return *std::move(value);
}

/// Adds the class of diagnostics, and translates this program's exceptions to Python's.
void add_errors(pybind11::module_& module);

}  // namespace abbe::python
