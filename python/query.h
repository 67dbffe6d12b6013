#pragma once

#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include "sensor/response/channel.h"

namespace abbe::python {

/// The quantity that a camera's curves multiply, from the text of an argument: "energy" or "quantum". Nothing
/// for the empty text. Throws Error{usage}, which names the argument `argument`, for other texts.
[[nodiscard]] std::optional<ResponseKind> response_of(const char* argument, const std::string& text);

/// Adds the functions for materials over arrays of wavelengths.
void add_materials(pybind11::module_& module);

/// Adds the functions for tables and colours.
void add_curves(pybind11::module_& module);

}  // namespace abbe::python
