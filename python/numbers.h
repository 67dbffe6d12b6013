#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "io/error.h"

namespace abbe::python {

/// What functions take for numbers: a number, or anything that numpy makes an array of real numbers of, none
/// of them masked. Throws Error{usage} as an argument for others.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Throws Error{usage} for elements of a masked array, or of one in a list, that have no value, as numpy
/// makes numbers of them.
inline void require_unmasked(const pybind11::handle& object) {
  if (PyFloat_CheckExact(object.ptr()) || PyLong_CheckExact(object.ptr())) return;
  if (PyList_Check(object.ptr()) || PyTuple_Check(object.ptr())) {
    for (const pybind11::object element : pybind11::reinterpret_borrow<pybind11::sequence>(object))
      require_unmasked(element);
    return;
  }
  const pybind11::object numpy_ma = pybind11::module_::import("numpy.ma");
  if (!pybind11::isinstance(object, numpy_ma.attr("MaskedArray"))) return;
  const auto masked = numpy_ma.attr("count_masked")(object).cast<std::int64_t>();
  if (masked > 0)
    throw Error(ErrorCode::usage, "",
                fmt::format("masked elements have no value (got {} of {} masked, allowed none)", masked,
                            object.attr("size").cast<std::int64_t>()));
}

/// Throws Error{usage} for complex numbers, dates and spans of time, as numpy makes real numbers of them.
inline void require_real(const pybind11::array& array) {
  if (std::string_view("cmM").find(array.dtype().kind()) != std::string_view::npos)
    throw Error(ErrorCode::usage, "",
                fmt::format("expected real numbers (got {}, allowed whole and floating-point numbers)",
                            std::string(pybind11::str(array.dtype()))));
}

}  // namespace abbe::python

namespace pybind11::detail {

/// Takes an argument for Numbers; what numpy makes no array of is a TypeError of pybind11.
template <>
struct pyobject_caster<abbe::python::Numbers> {
  bool load(const handle& object, bool convert) {
    if (!convert && !abbe::python::Numbers::check_(object)) return false;
    const auto array = array::ensure(object);
    if (!array) return false;
    abbe::python::require_unmasked(object);
    abbe::python::require_real(array);
    value = abbe::python::Numbers::ensure(array);
    return static_cast<bool>(value);
  }

  static handle cast(const handle& numbers, return_value_policy /*policy*/, handle /*parent*/) {
    return numbers.inc_ref();
  }

  PYBIND11_TYPE_CASTER(abbe::python::Numbers, handle_type_name<abbe::python::Numbers>::name);
};

}  // namespace pybind11::detail
