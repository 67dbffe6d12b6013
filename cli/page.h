#pragma once

#include <string>

#include "cli/answer.h"

// Beginning of an HTML document, with its style and the title as its first heading.
namespace abbe::cli {

/// Start of an HTML document up to its heading, which is `title`.
[[nodiscard]] std::string page_head(const std::string& title);
/// End of an HTML document.
inline constexpr const char* kPageEnd = "</body></html>\n";

/// Text of a table cell: a text, a number as JSON writes it, or a dash for null.
[[nodiscard]] std::string table_cell(const Json& value);

/// SVG document for embedding in a page, without its XML declaration.
[[nodiscard]] std::string inline_svg(const std::string& document);

}  // namespace abbe::cli
