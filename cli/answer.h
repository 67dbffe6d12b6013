#pragma once

#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/diagnostics.h"

namespace abbe::cli {

using Json = nlohmann::ordered_json;

/// The value, or null without one.
template <typename T>
[[nodiscard]] Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

void print(const Json& answer, bool as_json);

/// An answer as one line of JSON with all digits, or as plain text with a line per key; both end in a
/// newline. Plain text shows numbers to ten digits, and "-" for null and for numbers that are not finite. Its
/// columns are the list under `wavelength_nm`, `surface`, `field_deg` or `object_height_mm`, and the later
/// lists of equal length.
[[nodiscard]] std::string text(const Json& answer, bool as_json);

/// The single element of a list of one, otherwise the list itself.
[[nodiscard]] Json one_or_all(Json list);

/// Replaces every list of one element by that element, also within lists.
[[nodiscard]] Json without_lists_of_one(Json answer);

[[nodiscard]] std::string csv_quoted(const std::string& text);
/// A cell of a CSV table, in quotes only if it contains commas, quotes or line breaks.
[[nodiscard]] std::string csv_cell(const std::string& text);

/// Writes a text to stderr. Errors of the stream are ignored.
void print_to_stderr(const std::string& text);

/// Writes one line to stderr after "abbe: ".
void print_message(const std::string& message);

/// Prints a warning to stderr, if there is one. Throws Error{scene} with it instead if `strict`.
void warn(const std::optional<std::string>& warning, bool strict = false);

/// Prints the warnings to stderr, if any. Throws InvalidInput if there are errors, which then contains all
/// diagnostics.
void check(const Diagnostics& diagnostics);

/// Value of a loader, after `check` of its diagnostics. Throws Error{internal} if there is neither a value
/// nor an error.
template <typename T>
[[nodiscard]] T accepted(std::optional<T> value, const Diagnostics& diagnostics) {
  check(diagnostics);
  if (!value) throw Error(ErrorCode::internal, "", "a loader returned neither a value nor an error");
  return *std::move(value);
}

// Parts of the HTML documents that commands write.

/// Start of an HTML document up to its first heading: its style, and `title` as title and heading. `title` is
/// plain text and is escaped.
[[nodiscard]] std::string page_head(const std::string& title);
/// End of an HTML document that `page_head` began.
inline constexpr const char* kPageEnd = "</body></html>\n";

/// HTML of a table cell's contents: a text, escaped; any other value as JSON writes it; a dash for null.
[[nodiscard]] std::string table_cell(const Json& value);

}  // namespace abbe::cli
