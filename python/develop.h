#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Adds `develop` and its result class.
void add_develop(pybind11::module_& module);

/// Adds `compare` for films and `measure` for charts in them.
void add_compare(pybind11::module_& module);

/// Adds `calibrate` and `recover_response`.
void add_calibrate(pybind11::module_& module);

}  // namespace abbe::python
