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

/// What functions take for one real number. Throws Error{usage} as an argument for what is none, as for
/// Numbers.
struct Real {
  double value = 0;

  operator double() const { return value; }
};

/// What functions take for a whole number, a T: what Python takes for an index, such as numpy's whole
/// numbers. Others, of which pybind11 would cut off the fraction unless they are floats of Python, are a
/// TypeError.
template <typename T>
struct Whole {
  T value = 0;

  operator T() const { return value; }
};

/// The letter by which numpy tells the kind of what an object holds, such as 'm' of spans of time; 0 of
/// objects that are not numpy's.
[[nodiscard]] inline char numpy_kind(const pybind11::handle& object) {
  const pybind11::object type = pybind11::getattr(object, "dtype", pybind11::none());
  return pybind11::isinstance<pybind11::dtype>(type) ? type.cast<pybind11::dtype>().kind() : '\0';
}

/// Whether numpy knows an object as dates or spans of time, which become bare numbers where they are in
/// nanoseconds.
[[nodiscard]] inline bool is_time(const pybind11::handle& object) {
  const char kind = numpy_kind(object);
  return kind == 'm' || kind == 'M';
}

/// Throws Error{usage} for what numpy knows as one of `kinds`.
inline void refuse_kinds(const pybind11::handle& object, std::string_view kinds) {
  const char kind = numpy_kind(object);
  if (kind != '\0' && kinds.find(kind) != std::string_view::npos)
    throw Error(ErrorCode::usage, "",
                fmt::format("expected real numbers (got {}, allowed whole and floating-point numbers)",
                            std::string(pybind11::str(object.attr("dtype")))));
}

/// Throws Error{usage} for complex numbers, dates and spans of time, as numpy makes real numbers of them, in
/// arrays of objects too, where further arrays of objects are none unless they hold one.
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

/// Takes an argument for a Whole, by what Python makes an index of it.
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

/// Takes an argument for a Real, as pybind11 does for a double.
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
