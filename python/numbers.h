#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "io/error.h"
#include "python/gil.h"

namespace abbe::python {

/// Numeric argument: a number, or anything that numpy converts to an array of real numbers. Masked elements,
/// complex numbers, dates and time spans throw Error{usage}; objects that numpy cannot convert are a
/// TypeError.
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

/// Numpy's code for the kind of data in an object, such as 'm' for time spans; 0 for other objects.
[[nodiscard]] inline char numpy_kind(const pybind11::handle& object) {
  const pybind11::object type = pybind11::getattr(object, "dtype", pybind11::none());
  return pybind11::isinstance<pybind11::dtype>(type) ? type.cast<pybind11::dtype>().kind() : '\0';
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

namespace abbe::python {

/// The elements of an array, the last axis fastest. The array must outlive the span.
[[nodiscard]] inline std::span<const double> span_of(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// The value in Python if it is known, else None.
template <typename T>
[[nodiscard]] pybind11::object value_if(bool known, const T& value) {
  return known ? pybind11::cast(value) : pybind11::none();
}
/// The number, or None if it is not finite, such as an error that is not measured yet.
[[nodiscard]] inline pybind11::object finite_or_none(double value) {
  return value_if(std::isfinite(value), value);
}

/// A new array of the same shape, uninitialised.
[[nodiscard]] inline Numbers empty_like(const Numbers& numbers) {
  return Numbers(std::vector<pybind11::ssize_t>(numbers.shape(), numbers.shape() + numbers.ndim()));
}

/// Array of `f` of each number; a number for a number. `f` is called without the GIL, so it must not use
/// Python objects. Requires the GIL.
template <typename F>
[[nodiscard]] pybind11::object map(const Numbers& numbers, F f) {
  Numbers results = empty_like(numbers);
  double* to = results.mutable_data();
  const std::span<const double> from = span_of(numbers);
  {
    const GilReleased released;
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = f(from[i]);
  }
  return results[pybind11::tuple()];  // an array without axes gives its number
}

/// Broadcasts the arguments called `a_name` and `b_name` to a common shape by numpy's rules. Throws
/// Error{usage}, which names `a_name`, if there is none.
[[nodiscard]] inline std::pair<Numbers, Numbers> broadcast(const Numbers& a, const Numbers& b,
                                                           const char* a_name, const char* b_name) {
  try {
    const auto both =
        pybind11::module_::import("numpy").attr("broadcast_arrays")(a, b).cast<pybind11::sequence>();
    return {both[0].cast<Numbers>(), both[1].cast<Numbers>()};
  } catch (const pybind11::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) throw;
    const auto shape = [](const Numbers& array) { return std::string(pybind11::str(array.attr("shape"))); };
    throw Error(ErrorCode::usage, a_name,
                fmt::format("has no shape in common with {} (got {} and {})", b_name, shape(a), shape(b)));
  }
}

}  // namespace abbe::python
