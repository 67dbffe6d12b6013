#include "report/svg.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {
namespace {

std::string point_list_element(std::string_view tag, const SvgPoints& points, const std::string& attributes) {
  std::string list;
  for (const auto& [x, y] : points) list += fmt::format("{}{:.2f},{:.2f}", list.empty() ? "" : " ", x, y);
  return fmt::format("<{} points=\"{}\" fill=\"none\" {}/>\n", tag, list, attributes);
}

std::string size_attributes(double width, double height) {
  return fmt::format("width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\"", width, height);
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : valid_utf8(text))
    safe += c == '&'   ? "&amp;"
            : c == '<' ? "&lt;"
            : c == '>' ? "&gt;"
            : c == '"' ? "&quot;"
                       : std::string(1, c);
  return safe;
}

std::string svg_text(double x, double y, const std::string& text, const std::string& attributes) {
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", x, y, attributes, escaped(text));
}

std::string svg_line(double x0, double y0, double x1, double y1, const std::string& attributes) {
  return fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", x0, y0, x1, y1,
                     attributes);
}

std::string svg_rect(double x, double y, double width, double height, const std::string& attributes) {
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", x, y, width,
                     height, attributes);
}

std::string svg_circle(double x, double y, double radius, const std::string& attributes) {
  return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" {}/>\n", x, y, radius, attributes);
}

std::string svg_polyline(const SvgPoints& points, const std::string& attributes) {
  return point_list_element("polyline", points, attributes);
}

std::string svg_polygon(const SvgPoints& points, const std::string& attributes) {
  return point_list_element("polygon", points, attributes);
}

std::string svg_scale_bar(double x, double y, double pixels_per_unit, double max_pixels,
                          const std::string& unit) {
  const double max_length = max_pixels / pixels_per_unit;
  const double decade = std::pow(10, std::floor(std::log10(max_length)));
  const double length = decade * (max_length >= 5 * decade ? 5 : max_length >= 2 * decade ? 2 : 1);
  const double end = x + length * pixels_per_unit;
  return svg_line(x, y, end, y, "class=\"scale\" stroke=\"black\" stroke-width=\"2\"") +
         svg_text(end + 8, y + 4, fmt::format("{:g} {}", length, unit), "");
}

std::string svg_picture(double width, double height, const std::string& elements) {
  return fmt::format("<svg {} role=\"img\">\n{}</svg>", size_attributes(width, height), elements);
}

std::string svg_document(double width, double height, const std::string& title, const std::string& elements) {
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" {} "
             "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{}\" height=\"{}\" "
             "fill=\"white\"/>\n",
             size_attributes(width, height), width, height) +
         svg_text(10, 20, title, "font-size=\"15\" font-weight=\"bold\"") + elements + "</svg>\n";
}

std::string inline_svg(const std::string& document) {
  return document.substr(document.find("<svg"));
}

}  // namespace abbe
