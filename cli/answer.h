#pragma once

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/diagnostics.h"

namespace abbe::cli {

/// An answer to a script: its keys keep their order.
using Json = nlohmann::ordered_json;

/// Prints an answer on stdout: as one JSON object that keeps every digit, or for reading, lists as long as
/// the first becoming the columns of a table.
void print(const Json& answer, bool as_json);

/// The text of `print`, ending in a newline.
[[nodiscard]] std::string text(const Json& answer, bool as_json);

/// The value itself when there is one, the list otherwise: what a script gets for one question or for
/// several.
[[nodiscard]] Json one_or_all(Json list);

/// The answer with every list of one element, within lists too, replaced by that element.
[[nodiscard]] Json without_lists_of_one(Json answer);

/// A text as a cell of a table of commas: within quotes; and within these only where it needs them, as bands
/// do that have a comma in their names, and names of several lines.
[[nodiscard]] std::string csv_quoted(const std::string& text);
[[nodiscard]] std::string csv_cell(const std::string& text);

/// Writes to stderr. Nothing fails because nobody reads it.
void tell(const std::string& text);

/// Tells one line, after "abbe: ".
void say(const std::string& message);

/// Prints the warnings, if any; throws as `require_sound` does.
void check(const Diagnostics& diagnostics);

/// What a loader gave, its complaints treated as by `check`.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader gave nothing and said nothing");
  return *std::move(value);
}

}  // namespace abbe::cli
