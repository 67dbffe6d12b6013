#pragma once

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "io/error.h"
#include "python/gil.h"
#include "python/numbers.h"

namespace abbe::python {

/// The elements of an array, the last axis fastest. The array must outlive the span.
[[nodiscard]] inline std::span<const double> span_of(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// The number, or None if it is not finite, such as an error that is not measured yet.
[[nodiscard]] inline pybind11::object finite_or_none(double value) {
  return std::isfinite(value) ? pybind11::object(pybind11::float_(value))
                              : pybind11::object(pybind11::none());
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
