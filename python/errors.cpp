#include "python/errors.h"

#include <algorithm>
#include <cstddef>

#include <pybind11/stl.h>

#include "python/arguments.h"
#include "python/gil.h"
#include "python/module.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr const char* kErrors = "abbe.errors";  // Python module of the exception classes

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

// Replaces the option that a message names by the keyword of Python: "camera_response" instead of
// "--camera-response".
std::string with_keyword(const std::string& text) {
  if (!text.starts_with("--")) return text;
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(text.find(':'), text.size()));
  std::string named(text.begin() + 2, end);
  std::replace(named.begin(), named.end(), '-', '_');
  return named.append(end, text.end());
}

void raise(const Error& error, const std::vector<Diagnostic>& diagnostics) {
  const py::object type = py::module_::import(kErrors).attr(class_of(error.code));
  PyErr_SetObject(type.ptr(), type(decoded(with_keyword(error.what())), diagnostics).ptr());
}

// The parameter's type is that of pybind11's callback. NOLINTNEXTLINE(performance-unnecessary-value-param)
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

std::optional<py::str> file_of(const Diagnostic& diagnostic) {
  if (!diagnostic.where.source) return std::nullopt;
  return decoded(diagnostic.where.source->file);
}

// State for pickling, which `diagnostic_from` restores.
py::tuple state_of(const Diagnostic& diagnostic) {
  const auto& [source, offset, pointer] = diagnostic.where;
  const py::object text = source ? py::object(py::bytes(source->text)) : py::object(py::none());
  return py::make_tuple(static_cast<int>(diagnostic.severity), static_cast<int>(diagnostic.code),
                        file_of(diagnostic), text, offset, decoded(pointer), decoded(diagnostic.message));
}

Diagnostic diagnostic_from(const py::tuple& state) {
  Diagnostic diagnostic{static_cast<Diagnostic::Severity>(state[0].cast<int>()),
                        static_cast<ErrorCode>(state[1].cast<int>()),
                        {nullptr, state[4].cast<std::size_t>(), encoded(state[5])},
                        encoded(state[6])};
  if (!state[2].is_none())
    diagnostic.where.source =
        std::make_shared<const SourceText>(SourceText{encoded(state[2]), state[3].cast<std::string>()});
  return diagnostic;
}

}  // namespace

void warn(const std::string& text) {
  const GilAcquired gil;
  const py::object category = py::module_::import(kErrors).attr("SceneWarning");
  const py::str words = decoded(text);
  int failed = 0;
  unless_python_ends([&] { failed = PyErr_WarnFormat(category.ptr(), 1, "%U", words.ptr()); });
  if (failed != 0) throw py::error_already_set();
}

void check(const Diagnostics& diagnostics) {
  require_no_errors(diagnostics);
  for (const Diagnostic& warning : diagnostics.all()) warn(format(warning));
}

void add_errors(py::module_& module) {
  py::class_<Diagnostic> diagnostic(
      module, "Diagnostic",
      "An error or warning about an input: the message, and the location in the input.");
  diagnostic.def_property_readonly("file", file_of, "The name of the input, or None if there is none.")
      .def_property_readonly(
          "pointer", [](const Diagnostic& d) { return decoded(d.where.pointer); },
          "The JSON pointer of the value concerned, such as \"/camera/from\".")
      .def_property_readonly(
          "message", [](const Diagnostic& d) { return decoded(d.message); },
          "The message, without its location.")
      .def_property_readonly(
          "severity",
          [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error ? "error" : "warning"; },
          "\"error\" or \"warning\".")
      .def(
          "__str__", [](const Diagnostic& d) { return decoded(format(d)); },
          "The location, pointer and message as the command line prints them, with the line concerned.")
      .def("__repr__",
           [](const Diagnostic& d) {
             return decoded("<abbe.Diagnostic " + d.where.pointer + ": " + d.message + ">");
           })
      .def("__reduce__",
           [](const Diagnostic& d) {
             return py::make_tuple(py::module_::import(kErrors).attr("_diagnostic"), state_of(d));
           })
      .def_static("_of", diagnostic_from);
  forbid_bare_new(diagnostic);
  py::register_exception_translator(translate);
}

}  // namespace abbe::python
