#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "io/error.h"

namespace abbe::python {

/// Decodes text that may contain file names, which need not be UTF-8, as Python itself does: other bytes
/// become unpaired surrogates (`surrogateescape`). Requires the GIL, as all functions here.
[[nodiscard]] inline pybind11::str decoded(std::string_view text) {
  PyObject* const object =
      PyUnicode_DecodeUTF8(text.data(), static_cast<pybind11::ssize_t>(text.size()), "surrogateescape");
  if (object == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::str>(object);
}

/// Message for a text with unpaired surrogates, with its repr.
[[nodiscard]] inline std::string no_utf8(const pybind11::handle& text) {
  return fmt::format("expected text that UTF-8 can represent (got {})", std::string(pybind11::repr(text)));
}

/// Encodes a text that `decoded` may have made, to its bytes. Throws Error{usage} for other unpaired
/// surrogates.
[[nodiscard]] inline std::string encoded(const pybind11::handle& text) {
  const auto bytes = pybind11::reinterpret_steal<pybind11::bytes>(
      PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape"));
  if (bytes) return bytes;
  PyErr_Clear();
  throw Error(ErrorCode::usage, "", no_utf8(text));
}

}  // namespace abbe::python
