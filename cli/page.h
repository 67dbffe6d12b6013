#pragma once

#include <string>

#include "cli/answer.h"

// Parts of the HTML documents that commands write.
namespace abbe::cli {

/// Start of an HTML document up to its first heading: its style, and `title` as title and heading. `title` is
/// plain text and is escaped.
[[nodiscard]] std::string page_head(const std::string& title);
/// End of an HTML document that `page_head` began.
inline constexpr const char* kPageEnd = "</body></html>\n";

/// HTML of a table cell's contents: a text, escaped; any other value as JSON writes it; a dash for null.
[[nodiscard]] std::string table_cell(const Json& value);

/// The SVG document from its element `svg` on, without its XML declaration, for embedding in a page. It must
/// contain that element.
[[nodiscard]] std::string inline_svg(const std::string& document);

}  // namespace abbe::cli
