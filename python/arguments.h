#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>

namespace abbe::python {

/// An argument as a T; another object is a TypeError of Python: "`name`: expected `what` (got a set)".
template <typename T>
[[nodiscard]] T argument(const pybind11::handle& object, const char* name, const char* what) {
  pybind11::detail::make_caster<T> caster;
  if (!caster.load(object, true))
    throw pybind11::type_error(
        fmt::format("{}: expected {} (got a {})", name, what, Py_TYPE(object.ptr())->tp_name));
  return pybind11::detail::cast_op<T>(std::move(caster));
}

/// Lets a class make objects by its constructor alone: without, pybind11 gives out memory that nobody set. A
/// `__new__` of its own suffices, since Python finds that of pybind11's base and refuses one that skips it.
inline void forbid_bare_new(const pybind11::handle& of_class) {
  auto* const type = reinterpret_cast<PyTypeObject*>(of_class.ptr());
  type->tp_new = [](PyTypeObject* subtype, PyObject* /*arguments*/, PyObject* /*keywords*/) {
    return pybind11::detail::make_new_instance(subtype);
  };
  PyType_Modified(type);
}

}  // namespace abbe::python
