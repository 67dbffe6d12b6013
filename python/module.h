#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

// Parts of the extension module, each in the source file of its name.

/// Adds the class of diagnostics. Registers a translator of exceptions: Error{usage} becomes abbe.UsageError,
/// and so on for each code, with the diagnostics of an InvalidInput.
void add_errors(pybind11::module_& module);

/// Adds the class `Scene`, and `help`.
void add_scene(pybind11::module_& module);

/// Adds the class of films and `merge`.
void add_film(pybind11::module_& module);

/// Adds `render` and the class Progress.
void add_render(pybind11::module_& module);

/// Adds `meter`.
void add_meter(pybind11::module_& module);

/// Adds `develop` and its result class.
void add_develop(pybind11::module_& module);

/// Adds `compare` for films and `measure` for charts in them.
void add_compare(pybind11::module_& module);

/// Adds `calibrate` and `recover_response`.
void add_calibrate(pybind11::module_& module);

/// Adds the functions for materials over arrays of wavelengths.
void add_materials(pybind11::module_& module);

/// Adds the functions for tables and colours.
void add_curves(pybind11::module_& module);

}  // namespace abbe::python
