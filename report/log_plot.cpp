#include "report/log_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe {
namespace {

constexpr double kLogWidth = 860;
constexpr double kLogHeight = 470;
constexpr double kLogLeft = 70;
constexpr double kLogRight = 570;  // the legend is to the right
constexpr double kLogTop = 46;
constexpr double kLogBottom = 410;
constexpr double kLegendRow = 21;

// Multiples of 1, 2 and 5 of the powers of ten on the axis.
std::vector<double> ticks(const LogAxis& axis) {
  std::vector<double> all;
  for (int decade = -20; decade <= 20; ++decade)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * std::pow(10.0, decade);
      if (value >= axis.low * (1 - 1e-9) && value <= axis.high * (1 + 1e-9)) all.push_back(value);
    }
  return all;
}

std::string axes(const LogAxis& x, const LogAxis& y, const LogPlot& plot) {
  const std::string grid = "stroke=\"#dddddd\"";
  std::string all;
  for (const double value : ticks(x)) {
    all += svg_line(x.at(value), kLogTop, x.at(value), kLogBottom, grid);
    all += svg_text(x.at(value), kLogBottom + 18, fmt::format("{:g}", value),
                    "class=\"x\" text-anchor=\"middle\"");
  }
  for (const double value : ticks(y)) {
    all += svg_line(kLogLeft, y.at(value), kLogRight, y.at(value), grid);
    all += svg_text(kLogLeft - 7, y.at(value) + 4, fmt::format("{:g}", value),
                    "class=\"y\" text-anchor=\"end\"");
  }
  all += svg_rect(kLogLeft, kLogTop, kLogRight - kLogLeft, kLogBottom - kLogTop,
                  "fill=\"none\" stroke=\"#444444\"");
  const double center_y = (kLogTop + kLogBottom) / 2;
  all += svg_text((kLogLeft + kLogRight) / 2, kLogBottom + 42, plot.x_label, "text-anchor=\"middle\"");
  return all + svg_text(18, center_y, plot.y_label,
                        fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 18 {})\"", center_y));
}

std::string marker(double x, double y, const PlotSeries& series, const std::string& kind) {
  return svg_circle(x, y, 4,
                    fmt::format("class=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"", kind,
                                series.hollow ? "white" : series.color, series.color));
}

std::string stroke(const PlotSeries& series) {
  return fmt::format("stroke=\"{}\" stroke-width=\"1.8\"{}", series.color,
                     series.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string drawn(const PlotSeries& series, const LogAxis& x, const LogAxis& y) {
  SvgPoints points;
  std::string markers;
  for (const auto& [px, py] : series.points) {
    points.emplace_back(x.at(px), y.at(py));
    markers += marker(x.at(px), y.at(py), series, "point");
  }
  return svg_polyline(points, stroke(series)) + markers;
}

std::string legend(const std::vector<PlotSeries>& series) {
  std::string all;
  double y = kLogTop + 8;
  for (const PlotSeries& one : series) {
    all += svg_line(kLogRight + 16, y, kLogRight + 46, y, stroke(one));
    all += marker(kLogRight + 31, y, one, "key");
    all += svg_text(kLogRight + 54, y + 4, one.name, "");
    y += kLegendRow;
  }
  return all;
}

}  // namespace

double LogAxis::at(double value) const {
  return pixel_low + (pixel_high - pixel_low) * std::log(value / low) / std::log(high / low);
}

std::pair<double, double> log_range(const std::vector<double>& values) {
  if (values.empty()) return {1, 10};
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const LogAxis all{std::pow(10, std::floor(std::log10(*smallest)) - 1),
                    std::pow(10, std::ceil(std::log10(*largest)) + 1), 0, 1};
  const std::vector<double> steps = ticks(all);
  const double low = *std::prev(std::upper_bound(steps.begin(), steps.end(), *smallest * (1 + 1e-9)));
  const double high = *std::upper_bound(steps.begin(), steps.end(), *largest * (1 + 1e-9));
  return {low, high};
}

std::string svg(const LogPlot& plot) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const PlotSeries& series : plot.series)
    for (const auto& [px, py] : series.points) {
      xs.push_back(px);
      ys.push_back(py);
    }
  const auto [x_low, x_high] = log_range(xs);
  const auto [y_low, y_high] = log_range(ys);
  const LogAxis x{x_low, x_high, kLogLeft, kLogRight};
  const LogAxis y{y_low, y_high, kLogBottom, kLogTop};
  std::string all = axes(x, y, plot);
  for (const PlotSeries& series : plot.series) all += drawn(series, x, y);
  return svg_document(kLogWidth, kLogHeight, plot.title, all + legend(plot.series));
}

}  // namespace abbe
