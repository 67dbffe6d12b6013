// The extension module `abbe._abbe`, which implements the package `abbe`.
#include <filesystem>

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "io/data_directory.h"
#include "python/module.h"

PYBIND11_MODULE(_abbe, module) {
  module.doc() = "Abbe, a spectral renderer validated against measured colour science.";
  module.attr("__version__") = ABBE_VERSION;
  module.def("_set_data_directory", abbe::set_data_directory);
  abbe::python::add_errors(module);
  abbe::python::add_scene(module);
  abbe::python::add_film(module);
  abbe::python::add_render(module);
  abbe::python::add_meter(module);
  abbe::python::add_develop(module);
  abbe::python::add_compare(module);
  abbe::python::add_calibrate(module);
  abbe::python::add_materials(module);
  abbe::python::add_curves(module);
}
