#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>

namespace abbe::python {

/// Converts an argument to a T, with pybind11's implicit conversions. Throws Python's TypeError for other
/// objects: "`name`: expected `what` (got a set)". Requires the GIL.
template <typename T>
[[nodiscard]] T argument(const pybind11::handle& object, const char* name, const char* what) {
  pybind11::detail::make_caster<T> caster;
  if (!caster.load(object, true))
    throw pybind11::type_error(
        fmt::format("{}: expected {} (got a {})", name, what, Py_TYPE(object.ptr())->tp_name));
  return pybind11::detail::cast_op<T>(std::move(caster));
}

/// Makes the constructor the only way to create objects of a class. Otherwise `__new__` of pybind11 would
/// return uninitialised memory. An own `__new__` suffices, because Python refuses to call that of the base in
/// its place.
inline void forbid_bare_new(const pybind11::handle& of_class) {
  auto* const type = reinterpret_cast<PyTypeObject*>(of_class.ptr());
  type->tp_new = [](PyTypeObject* subtype, PyObject* /*arguments*/, PyObject* /*keywords*/) {
    return pybind11::detail::make_new_instance(subtype);
  };
  PyType_Modified(type);
}

}  // namespace abbe::python
