#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Adds `render` and the class Progress.
void add_render(pybind11::module_& module);

/// Adds `meter`.
void add_meter(pybind11::module_& module);

}  // namespace abbe::python
