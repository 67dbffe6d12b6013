#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Adds what matter does, over arrays of wavelengths.
void add_matter(pybind11::module_& module);

/// Adds tables as arrays, and colours.
void add_curves(pybind11::module_& module);

}  // namespace abbe::python
