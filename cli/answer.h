#pragma once

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/diagnostics.h"

namespace abbe::cli {

/// A JSON answer whose keys retain their order.
using Json = nlohmann::ordered_json;

/// Prints an answer on stdout, as one JSON object with all digits or as plain text. In plain text, lists of
/// equal length become the columns of a table.
void print(const Json& answer, bool as_json);

/// Text that `print` writes, ending in a newline.
[[nodiscard]] std::string text(const Json& answer, bool as_json);

/// The single element of a list of one, otherwise the list itself.
[[nodiscard]] Json one_or_all(Json list);

/// Replaces every list of one element by that element, also within lists.
[[nodiscard]] Json without_lists_of_one(Json answer);

/// A text as a cell of a CSV table. `csv_quoted` always adds quotes. `csv_cell` adds them only if needed, for
/// example around commas and line breaks.
[[nodiscard]] std::string csv_quoted(const std::string& text);
[[nodiscard]] std::string csv_cell(const std::string& text);

/// Writes a text to stderr. Errors of the stream are ignored.
void print_to_stderr(const std::string& text);

/// Writes one line to stderr, preceded by "abbe: ".
void print_message(const std::string& message);

/// Prints the warnings, if any. Throws the errors of `require_sound`.
void check(const Diagnostics& diagnostics);

/// Value of a loader, after `check` of its diagnostics.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader returned neither a value nor an error");
  return *std::move(value);
}

}  // namespace abbe::cli
