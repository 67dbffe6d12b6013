#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>

#include "io/error.h"
#include "sensor/response/channel.h"

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

/// Throws Error{usage} about an argument, with a message in the format of fmt.
template <typename... Values>
[[noreturn]] void refuse_argument(const std::string& argument, fmt::format_string<Values...> message,
                                  Values&&... values) {
  throw Error(ErrorCode::usage, argument, fmt::format(message, std::forward<Values>(values)...));
}

/// Index of `text` in `allowed`. Throws Error{usage}, which lists them, for other texts.
[[nodiscard]] inline std::size_t choice(const char* argument, const std::string& text,
                                        std::initializer_list<const char*> allowed) {
  const auto found = std::ranges::find(allowed, text);
  if (found == allowed.end())
    refuse_argument(argument, "got \"{}\", allowed {}", text, fmt::join(allowed, ", "));
  return static_cast<std::size_t>(found - allowed.begin());
}

/// The quantity that a camera's curves multiply, from the text of an argument: "energy" or "quantum". Nothing
/// for the empty text. Throws Error{usage} for other texts.
[[nodiscard]] inline std::optional<ResponseKind> response_of(const char* argument, const std::string& text) {
  if (text.empty()) return std::nullopt;
  constexpr std::array kKinds{ResponseKind::energy, ResponseKind::quantum};
  return kKinds.at(choice(argument, text, {"energy", "quantum"}));
}

}  // namespace abbe::python
