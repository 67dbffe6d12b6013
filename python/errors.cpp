#include "python/errors.h"

#include <pybind11/stl.h>

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr const char* kErrors = "abbe.errors";  // the module of Python that has the classes

const char* class_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return "UsageError";
    case ErrorCode::scene:
      return "SceneError";
    case ErrorCode::input:
      return "InputError";
    case ErrorCode::output:
      return "OutputError";
    case ErrorCode::resource:
      return "ResourceError";
    case ErrorCode::internal:
      break;
  }
  return "InternalError";
}

void raise(const Error& error, const std::vector<Diagnostic>& diagnostics) {
  const py::object type = py::module_::import(kErrors).attr(class_of(error.code));
  PyErr_SetObject(type.ptr(), type(error.what(), diagnostics).ptr());
}

// With the parameter that pybind11 calls it with. NOLINTNEXTLINE(performance-unnecessary-value-param)
void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const InvalidInput& error) {
    raise(error, error.diagnostics);
  } catch (const Error& error) {
    raise(error, {});
  }
}

std::optional<std::string> file_of(const Diagnostic& diagnostic) {
  if (!diagnostic.where.source) return std::nullopt;
  return diagnostic.where.source->file;
}

}  // namespace

void warn(const std::string& text) {
  const py::gil_scoped_acquire held;
  const py::object category = py::module_::import(kErrors).attr("SceneWarning");
  if (PyErr_WarnEx(category.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

void check(const Diagnostics& diagnostics) {
  require_sound(diagnostics);
  for (const Diagnostic& warning : diagnostics.all()) warn(format(warning));
}

void add_errors(py::module_& module) {
  py::class_<Diagnostic>(module, "Diagnostic",
                         "One complaint about an input: what is wrong, and where it stands.")
      .def_property_readonly("file", file_of,
                             "The name of the text complained about, None where there is none.")
      .def_property_readonly(
          "pointer", [](const Diagnostic& d) { return d.where.pointer; },
          "The JSON pointer of the value complained about, such as \"/camera/from\".")
      .def_readonly("message", &Diagnostic::message, "What is wrong, as a sentence without its place.")
      .def_property_readonly(
          "severity",
          [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error ? "error" : "warning"; },
          "\"error\" or \"warning\".")
      .def("__str__", format,
           "Place, pointer and message as the command line prints them, with the line concerned.")
      .def("__repr__", [](const Diagnostic& d) {
        return "<abbe.Diagnostic " + d.where.pointer + ": " + d.message + ">";
      });
  py::register_exception_translator(translate);
}

}  // namespace abbe::python
