#pragma once

#include <optional>
#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "io/diagnostics.h"

namespace abbe::python {

/// Throws InvalidInput (`require_no_errors`) if there are errors. Otherwise issues each warning by `warn`.
void check(const Diagnostics& diagnostics);

/// Issues a Python warning of the class SceneWarning. Throws pybind11::error_already_set if the user made it
/// an exception. Callers may hold the GIL or have released it by `GilReleased`.
void warn(const std::string& text);

/// The value of a loader, after `check` of its diagnostics. Throws Error{internal} for no value without an
/// error.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader returned nothing and reported no error");
  return *std::move(value);
}

}  // namespace abbe::python
