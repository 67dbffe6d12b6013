#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// Text as XML and HTML in UTF-8 hold it; what of it is no UTF-8 is U+FFFD.
[[nodiscard]] std::string escaped(const std::string& text);

// Elements of an SVG picture, each on a line of its own, in pixels from its upper left corner; `attributes`
// as XML writes them.

[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_line(double x0, double y0, double x1, double y1, const std::string& attributes);
[[nodiscard]] std::string svg_rect(double x, double y, double width, double height,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_circle(double x, double y, double radius, const std::string& attributes);
/// A line through points, or an area within a closed one; neither is filled unless `attributes` say so.
using SvgPoints = std::vector<std::pair<double, double>>;
[[nodiscard]] std::string svg_polyline(const SvgPoints& points, const std::string& attributes);
[[nodiscard]] std::string svg_polygon(const SvgPoints& points, const std::string& attributes);

/// A picture of these elements to stand within HTML.
[[nodiscard]] std::string svg_picture(double width, double height, const std::string& elements);
/// A picture of these elements on white, with `title` above them, as a document of its own.
[[nodiscard]] std::string svg_document(double width, double height, const std::string& title,
                                       const std::string& elements);

}  // namespace abbe
