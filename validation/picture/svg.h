#pragma once

#include <string>

namespace abbe {

/// Text as XML and HTML hold it.
[[nodiscard]] std::string escaped(const std::string& text);

/// Elements of an SVG document, each on a line of its own; `attributes` as XML writes them.
[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_line(double x0, double y0, double x1, double y1, const std::string& attributes);

}  // namespace abbe
