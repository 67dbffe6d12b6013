#pragma once

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Adds `develop` and what it gives.
void add_develop(pybind11::module_& module);

/// Adds `compare`, of films and of charts in them.
void add_compare(pybind11::module_& module);

/// Adds `calibrate`.
void add_calibrate(pybind11::module_& module);

}  // namespace abbe::python
