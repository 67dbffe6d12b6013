#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "python/numbers.h"
#include "transport/render/sample_ranges.h"

namespace pybind11::detail {

/// Converts (first, last), or a Python range of step 1, to the samples first <= s < last. The ends may be any
/// whole numbers from 0 on. Throws Python's TypeError for other objects.
template <>
struct type_caster<abbe::SampleRange> {
  bool load(const handle& object, bool convert) {
    using End = abbe::python::Whole<std::uint64_t>;
    make_caster<std::pair<End, End>> pair;
    const bool is_bytes =
        isinstance<bytes>(object) || isinstance<bytearray>(object) || isinstance<memoryview>(object);
    if (is_bytes || !pair.load(ends_of(object), convert))
      throw type_error(fmt::format(
          "sample_range: expected (first, last), whole numbers from 0 on, or a range of step 1 (got {})",
          std::string(repr(object))));
    const auto [first, last] = cast_op<std::pair<End, End>>(pair);
    value = {first, last};
    return true;
  }

  PYBIND11_TYPE_CASTER(abbe::SampleRange, const_name("Union[Tuple[int, int], range]"));

 private:
  static object ends_of(const handle& samples) {
    if (!PyRange_Check(samples.ptr())) return reinterpret_borrow<object>(samples);
    const object step = samples.attr("step");
    if (!step.equal(int_(1))) return none();
    return make_tuple(samples.attr("start"), samples.attr("stop"));
  }
};

}  // namespace pybind11::detail
