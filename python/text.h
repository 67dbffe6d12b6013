#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "io/error.h"

namespace abbe::python {

/// Text that may hold names of files, which need not be UTF-8: as Python itself reads those.
[[nodiscard]] inline pybind11::str decoded(std::string_view text) {
  PyObject* const object =
      PyUnicode_DecodeUTF8(text.data(), static_cast<pybind11::ssize_t>(text.size()), "surrogateescape");
  if (object == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(object);
}

/// What messages say of a text that has halves of surrogate pairs.
[[nodiscard]] inline std::string no_utf8(const pybind11::handle& text) {
  return fmt::format("expected text that UTF-8 can hold (got {})", std::string(pybind11::repr(text)));
}

/// The bytes of a text that `decoded` may have made. Throws Error{usage} for other halves of surrogate pairs.
[[nodiscard]] inline std::string encoded(const pybind11::handle& text) {
  const auto bytes = pybind11::reinterpret_steal<pybind11::bytes>(
      PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape"));
  if (bytes) return bytes;
  PyErr_Clear();
  throw Error(ErrorCode::usage, "", no_utf8(text));
}

}  // namespace abbe::python
