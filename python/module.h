#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

// Each function adds the classes and functions of the source file of its name to the extension module.
// `add_errors` also translates exceptions: Error{usage} becomes abbe.UsageError, and so on for each code,
// with the diagnostics of an InvalidInput.
void add_errors(pybind11::module_& module);
void add_scene(pybind11::module_& module);
void add_film(pybind11::module_& module);
void add_render(pybind11::module_& module);
void add_meter(pybind11::module_& module);
void add_develop(pybind11::module_& module);
void add_compare(pybind11::module_& module);
void add_calibrate(pybind11::module_& module);
void add_materials(pybind11::module_& module);
void add_curves(pybind11::module_& module);

}  // namespace abbe::python
