#pragma once

#include <string>

#include "cli/answer.h"

// What pages of commands have in common.
namespace abbe::cli {

/// The beginning of an HTML document, with its style and the title as its first heading.
[[nodiscard]] std::string page_head(const std::string& title);
/// What ends it.
inline constexpr const char* kPageEnd = "</body></html>\n";

/// A value as a table shows it: a text, what JSON calls a number, or a dash for null.
[[nodiscard]] std::string table_cell(const Json& value);

/// A picture of its own within the page.
[[nodiscard]] std::string inline_svg(const std::string& document);

}  // namespace abbe::cli
