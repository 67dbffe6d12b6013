#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// Text escaped for XML and HTML in UTF-8, also for attributes in double quotes. Bytes that are not valid
/// UTF-8 become U+FFFD.
[[nodiscard]] std::string escaped(const std::string& text);

// Elements of an SVG picture, one per line with its line break, in pixels from the upper left corner, y
// downwards. `attributes` are XML attributes, such as `stroke="black"`, and are not escaped.

/// Text whose baseline starts at (x, y), unless `attributes` anchor it elsewhere; `text` is escaped.
[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_line(double x0, double y0, double x1, double y1, const std::string& attributes);
/// Rectangle with the upper left corner (x, y).
[[nodiscard]] std::string svg_rect(double x, double y, double width, double height,
                                   const std::string& attributes);
[[nodiscard]] std::string svg_circle(double x, double y, double radius, const std::string& attributes);
/// Points (x, y).
using SvgPoints = std::vector<std::pair<double, double>>;
/// Open polyline through points, and closed polygon. Neither is filled unless `attributes` contain a `style`
/// that fills it; a `fill` attribute would be a duplicate.
[[nodiscard]] std::string svg_polyline(const SvgPoints& points, const std::string& attributes);
[[nodiscard]] std::string svg_polygon(const SvgPoints& points, const std::string& attributes);

/// Scale bar from (x, y) to the right, of 1, 2 or 5 times a power of ten units, at most `max_pixels` long.
[[nodiscard]] std::string svg_scale_bar(double x, double y, double pixels_per_unit, double max_pixels,
                                        const std::string& unit);

/// SVG element of that size [pixels] with the given elements, for embedding in HTML.
[[nodiscard]] std::string svg_picture(double width, double height, const std::string& elements);
/// Complete SVG document of that size [pixels] with the given elements on white. `title`, which is escaped,
/// is on the uppermost 20 pixels; the elements should start below.
[[nodiscard]] std::string svg_document(double width, double height, const std::string& title,
                                       const std::string& elements);

/// The SVG document from its element `svg` on, without its XML declaration, for embedding in a page. It must
/// contain that element.
[[nodiscard]] std::string inline_svg(const std::string& document);

}  // namespace abbe
