// The extension module `abbe._abbe`, which implements the package `abbe`.

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "io/data_directory.h"
#include "python/module.h"

PYBIND11_MODULE(_abbe, module) {
  module.doc() = "Abbe, a spectral renderer validated against measured colour science.";
  module.attr("__version__") = ABBE_VERSION;
  module.def("_set_data_directory", abbe::set_data_directory);
  using namespace abbe::python;
  for (const auto add : {add_errors, add_scene, add_film, add_render, add_meter, add_develop, add_compare,
                         add_calibrate, add_materials, add_curves})
    add(module);
}
