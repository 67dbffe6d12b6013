#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// Text escaped for XML and HTML in UTF-8. Bytes that are not valid UTF-8 become U+FFFD.
[[nodiscard]] std::string escaped(const std::string& text);

// Elements of an SVG picture, one per line, in pixels from the upper left corner. `attributes` are XML
// attributes.

[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_line(double x0, double y0, double x1, double y1, const std::string& attributes);
[[nodiscard]] std::string svg_rect(double x, double y, double width, double height,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_circle(double x, double y, double radius, const std::string& attributes);
/// Polyline through points, and closed polygon. Neither is filled unless `attributes` contain a style that
/// fills it.
using SvgPoints = std::vector<std::pair<double, double>>;
[[nodiscard]] std::string svg_polyline(const SvgPoints& points, const std::string& attributes);
[[nodiscard]] std::string svg_polygon(const SvgPoints& points, const std::string& attributes);

/// SVG element with the given elements, for embedding in HTML.
[[nodiscard]] std::string svg_picture(double width, double height, const std::string& elements);
/// Complete SVG document with the given elements on white and `title` above them.
[[nodiscard]] std::string svg_document(double width, double height, const std::string& title,
                                       const std::string& elements);

}  // namespace abbe
