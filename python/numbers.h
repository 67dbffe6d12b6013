#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "io/error.h"

namespace abbe::python {

/// Numeric argument: a number, or anything that numpy converts to an array of real numbers, without masked
/// elements. Masked elements, complex numbers, dates and time spans throw Error{usage}; objects that numpy
/// cannot convert are a TypeError.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Throws Error{usage} for masked elements of an array, or of arrays in a list, because numpy would convert
/// them to numbers.
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

/// Argument for one real number, which may be infinite or NaN. Complex numbers, dates and time spans throw
/// Error{usage}; other objects without a number are a TypeError.
struct Real {
  double value = 0;

  operator double() const { return value; }
};

/// Argument for a whole number of type T: anything that Python accepts as an index, such as numpy's integers.
/// Other arguments, and numbers outside the range of T, are a TypeError. pybind11 alone would truncate
/// fractions of objects other than Python floats.
template <typename T>
struct Whole {
  T value = 0;

  operator T() const { return value; }
};

/// Code of numpy for the kind of data in an object, such as 'm' for time spans; 0 for objects that are not
/// numpy's.
[[nodiscard]] inline char numpy_kind(const pybind11::handle& object) {
  const pybind11::object type = pybind11::getattr(object, "dtype", pybind11::none());
  return pybind11::isinstance<pybind11::dtype>(type) ? type.cast<pybind11::dtype>().kind() : '\0';
}

/// True if an object holds numpy dates or time spans. With nanoseconds as the unit, numpy would convert them
/// to plain numbers.
[[nodiscard]] inline bool is_time(const pybind11::handle& object) {
  const char kind = numpy_kind(object);
  return kind == 'm' || kind == 'M';
}

/// Throws Error{usage} for numpy data of one of the `kinds`, a string of numpy's codes (`numpy_kind`).
inline void refuse_kinds(const pybind11::handle& object, std::string_view kinds) {
  const char kind = numpy_kind(object);
  if (kind != '\0' && kinds.find(kind) != std::string_view::npos)
    throw Error(ErrorCode::usage, "",
                fmt::format("expected real numbers (got {}, allowed whole and floating-point numbers)",
                            std::string(pybind11::str(object.attr("dtype")))));
}

/// Throws Error{usage} for complex numbers, dates and time spans, which numpy would convert to real numbers.
/// It also examines arrays of objects. Inside them, arrays of objects must have no axes.
inline void require_real(const pybind11::array& array) {
  refuse_kinds(array, "cmM");
  if (numpy_kind(array) != 'O') return;
  for (const pybind11::handle element : array.attr("flat")) {
    if (pybind11::isinstance<pybind11::array>(element) && element.attr("ndim").cast<int>() == 0)
      require_real(pybind11::reinterpret_borrow<pybind11::array>(element));
    else
      refuse_kinds(element, "cmMO");
  }
}

}  // namespace abbe::python

namespace pybind11::detail {

/// Converts an argument to Numbers. pybind11 raises a TypeError if numpy cannot make an array of it.
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

/// Converts an argument to a Whole by Python's index protocol.
template <typename T>
struct type_caster<abbe::python::Whole<T>> {
  bool load(const handle& object, bool convert) {
    const auto whole = reinterpret_steal<pybind11::object>(PyNumber_Index(object.ptr()));
    if (!whole) PyErr_Clear();
    make_caster<T> number;
    if (!whole || !number.load(whole, convert)) return false;
    value = {cast_op<T>(number)};
    return true;
  }

  PYBIND11_TYPE_CASTER(abbe::python::Whole<T>, make_caster<T>::name);
};

/// Converts an argument to a Real as pybind11 converts one to a double.
template <>
struct type_caster<abbe::python::Real> {
  bool load(const handle& object, bool convert) {
    if (isinstance<array>(object))
      abbe::python::require_real(reinterpret_borrow<array>(object));
    else
      abbe::python::refuse_kinds(object, "cmM");
    make_caster<double> number;
    if (!number.load(object, convert)) return false;
    value = {cast_op<double>(number)};
    return true;
  }

  PYBIND11_TYPE_CASTER(abbe::python::Real, make_caster<double>::name);
};

}  // namespace pybind11::detail
