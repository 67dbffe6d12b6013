#pragma once

#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include "sensor/response/channel.h"

namespace abbe::python {

/// What a camera's curves multiply, by the text of an argument of that name, "energy" or "quantum"; nothing
/// for none. Throws Error{usage} for another.
[[nodiscard]] std::optional<ResponseKind> response_of(const char* argument, const std::string& text);

/// Adds what matter does, over arrays of wavelengths.
void add_matter(pybind11::module_& module);

/// Adds tables as arrays, and colours.
void add_curves(pybind11::module_& module);

}  // namespace abbe::python
