#include "report/line_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe {
namespace {

constexpr double kWidth = 620;
constexpr double kHeight = 380;
constexpr double kLeft = 66;
constexpr double kRight = 600;
constexpr double kTop = 46;
constexpr double kBottom = 326;
constexpr int kMaxIntervals = 6;

// Axis with round limits that contain all values.
struct Axis {
  double low, high, step;
  double pixel_low, pixel_high;
  [[nodiscard]] double at(double value) const {
    return pixel_low + (value - low) / (high - low) * (pixel_high - pixel_low);
  }
};

Axis axis_for(double low, double high, double pixel_low, double pixel_high) {
  if (!(high > low)) high = low + 1;
  const double rough = (high - low) / kMaxIntervals;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double round : {5.0, 2.0, 1.0})
    if (round * decade >= rough) step = round * decade;
  return {std::floor(low / step) * step, std::ceil(high / step - 1e-9) * step, step, pixel_low, pixel_high};
}

std::string frame(const Axis& x, const Axis& y, const std::string& x_label, const std::string& y_label) {
  std::string all;
  for (double value = x.low; value < x.high + x.step / 2; value += x.step) {
    all += svg_line(x.at(value), kTop, x.at(value), kBottom, "stroke=\"#dddddd\"");
    all += svg_text(x.at(value), kBottom + 18, fmt::format("{:.6g}", value), "text-anchor=\"middle\"");
  }
  for (double value = y.low; value < y.high + y.step / 2; value += y.step) {
    all += svg_line(kLeft, y.at(value), kRight, y.at(value), "stroke=\"#dddddd\"");
    all += svg_text(kLeft - 7, y.at(value) + 4, fmt::format("{:.6g}", value), "text-anchor=\"end\"");
  }
  const double center_y = (kTop + kBottom) / 2;
  all += svg_rect(kLeft, kTop, kRight - kLeft, kBottom - kTop, "fill=\"none\" stroke=\"#444444\"");
  all += svg_text((kLeft + kRight) / 2, kBottom + 42, x_label, "text-anchor=\"middle\"");
  return all + svg_text(18, center_y, y_label,
                        fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 18 {})\"", center_y));
}

}  // namespace

std::string svg(const LinePlot& plot) {
  std::vector<double> xs;
  std::vector<double> ys{0};
  for (const PlotSeries& series : plot.series)
    for (const auto& [x, y] : series.points) {
      xs.push_back(x);
      ys.push_back(y);
    }
  if (xs.empty()) xs.push_back(0);
  const auto [x_low, x_high] = std::minmax_element(xs.begin(), xs.end());
  const auto [y_low, y_high] = std::minmax_element(ys.begin(), ys.end());
  const Axis x = axis_for(*x_low, *x_high, kLeft, kRight);
  const Axis y = axis_for(*y_low, *y_high, kBottom, kTop);
  std::string elements = frame(x, y, plot.x_label, plot.y_label);
  double row = kTop + 18;
  for (const PlotSeries& series : plot.series) {
    SvgPoints points;
    for (const auto& [px, py] : series.points) points.emplace_back(x.at(px), y.at(py));
    const std::string stroke = fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", series.color,
                                           series.dashed ? " stroke-dasharray=\"6 4\"" : "");
    elements += svg_polyline(points, stroke);
    if (series.name.empty()) continue;
    elements += svg_line(kRight - 150, row - 4, kRight - 122, row - 4, stroke);
    elements += svg_text(kRight - 114, row, series.name, "");
    row += 18;
  }
  return svg_document(kWidth, kHeight, plot.title, elements);
}

std::string histogram_svg(const std::vector<double>& values, double width, const std::string& title,
                          const std::string& x_label) {
  std::vector<double> counts(1, 0);
  for (const double value : values) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, value / width));
    if (bin >= counts.size()) counts.resize(bin + 1, 0);
    counts[bin] += 1;
  }
  const Axis x = axis_for(0, width * static_cast<double>(counts.size()), kLeft, kRight);
  const Axis y = axis_for(0, *std::max_element(counts.begin(), counts.end()), kBottom, kTop);
  std::string elements = frame(x, y, x_label, "patches");
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double left = x.at(width * static_cast<double>(i));
    elements += svg_rect(left, y.at(counts[i]), x.at(width * static_cast<double>(i + 1)) - left,
                         kBottom - y.at(counts[i]), "fill=\"#4a7ab5\" stroke=\"white\"");
  }
  return svg_document(kWidth, kHeight, title, elements);
}

}  // namespace abbe
