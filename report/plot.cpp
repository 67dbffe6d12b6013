#include "report/plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "calibration/metrics/color_rendering.h"
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
constexpr double kLogStroke = 1.8;

// An axis from `low` to `high`, drawn between two pixel coordinates in either order. 0 < low if logarithmic.
struct Axis {
  double low, high;
  double pixel_low, pixel_high;
  bool logarithmic;
  std::vector<double> ticks;

  // Pixel coordinate of a value; outside the axis it is extrapolated.
  [[nodiscard]] double at(double value) const {
    if (logarithmic)
      return pixel_low + (pixel_high - pixel_low) * std::log(value / low) / std::log(high / low);
    return pixel_low + (value - low) / (high - low) * (pixel_high - pixel_low);
  }
};

// Multiples of 1, 2 and 5 of the powers of ten from `low` to `high`.
std::vector<double> log_ticks(double low, double high) {
  std::vector<double> all;
  for (int decade = -20; decade <= 20; ++decade)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * std::pow(10.0, decade);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) all.push_back(value);
    }
  return all;
}

Axis log_axis(const std::vector<double>& values, double pixel_low, double pixel_high) {
  const auto [low, high] = log_range(values);
  return {low, high, pixel_low, pixel_high, true, log_ticks(low, high)};
}

// Linear axis with round limits that contain all values.
Axis linear_axis(double low, double high, double pixel_low, double pixel_high) {
  constexpr int kMaxIntervals = 6;
  if (!(high > low)) high = low + 1;
  const double rough = (high - low) / kMaxIntervals;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double round : {5.0, 2.0, 1.0})
    if (round * decade >= rough) step = round * decade;
  Axis axis{
      std::floor(low / step) * step, std::ceil(high / step - 1e-9) * step, pixel_low, pixel_high, false, {}};
  for (double value = axis.low; value < axis.high + step / 2; value += step) axis.ticks.push_back(value);
  return axis;
}

// Grid, frame and labels of a plot.
std::string frame(const Axis& x, const Axis& y, const std::string& x_label, const std::string& y_label) {
  const std::string grid_line = "stroke=\"#dddddd\"";
  const double left = x.pixel_low;
  const double right = x.pixel_high;
  const double top = y.pixel_high;
  const double bottom = y.pixel_low;
  std::string all;
  for (const double value : x.ticks) {
    all += svg_line(x.at(value), top, x.at(value), bottom, grid_line);
    all +=
        svg_text(x.at(value), bottom + 18, fmt::format("{:g}", value), "class=\"x\" text-anchor=\"middle\"");
  }
  for (const double value : y.ticks) {
    all += svg_line(left, y.at(value), right, y.at(value), grid_line);
    all += svg_text(left - 7, y.at(value) + 4, fmt::format("{:g}", value), "class=\"y\" text-anchor=\"end\"");
  }
  const double center_y = (top + bottom) / 2;
  all += svg_rect(left, top, right - left, bottom - top, "fill=\"none\" stroke=\"#444444\"");
  all += svg_text((left + right) / 2, bottom + 42, x_label, "text-anchor=\"middle\"");
  return all + svg_text(18, center_y, y_label,
                        fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 18 {})\"", center_y));
}

/// Coordinates of all points of some series.
struct Coordinates {
  std::vector<double> x{};
  std::vector<double> y{};
};
Coordinates coordinates_of(const std::vector<PlotSeries>& all) {
  Coordinates coordinates;
  for (const PlotSeries& series : all)
    for (const auto& [x, y] : series.points) {
      coordinates.x.push_back(x);
      coordinates.y.push_back(y);
    }
  return coordinates;
}

SvgPoints drawn_points(const PlotSeries& series, const Axis& x, const Axis& y) {
  SvgPoints points;
  for (const auto& [px, py] : series.points) points.emplace_back(x.at(px), y.at(py));
  return points;
}

std::string marker(double x, double y, const PlotSeries& series, const std::string& kind) {
  return svg_circle(x, y, 4,
                    fmt::format("class=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"", kind,
                                series.hollow ? "white" : series.color, series.color));
}

std::string stroke(const PlotSeries& series, double width) {
  return fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}", series.color, width,
                     series.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string legend(const std::vector<PlotSeries>& series) {
  std::string all;
  double y = kLogTop + 8;
  for (const PlotSeries& one : series) {
    all += svg_line(kLogRight + 16, y, kLogRight + 46, y, stroke(one, kLogStroke));
    all += marker(kLogRight + 31, y, one, "key");
    all += svg_text(kLogRight + 54, y + 4, one.name, "");
    y += kLegendRow;
  }
  return all;
}

constexpr double kWidth = 620;
constexpr double kHeight = 380;
constexpr double kLeft = 66;
constexpr double kRight = 600;
constexpr double kTop = 46;
constexpr double kBottom = 326;
constexpr double kSize = 460;
constexpr double kGraphicTop = 40;  // below the title
constexpr double kCenterX = kSize / 2;
constexpr double kCenterY = kGraphicTop + kSize / 2;
constexpr double kCircleRadius = 150;  // radius of the reference's circle
constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr std::size_t kBins = ColorFidelity::kBins;

using Point = std::pair<double, double>;

// Position of a colour whose chroma is relative to the reference's.
Point placed(double relative_chroma, double hue) {
  return {kCenterX + kCircleRadius * relative_chroma * std::cos(hue),
          kCenterY - kCircleRadius * relative_chroma * std::sin(hue)};
}

double bin_center(std::size_t bin) {
  return (static_cast<double>(bin) + 0.5) * kFullTurn / kBins;
}

// The reference's mean is drawn on the circle at the center of its bin. The light's mean is shifted from
// there.
Point shifted(const HueBin& bin, std::size_t k) {
  const double hue = bin_center(k);
  const double a =
      std::cos(hue) + (bin.test[0] - bin.reference[0]) / std::hypot(bin.reference[0], bin.reference[1]);
  const double b =
      std::sin(hue) + (bin.test[1] - bin.reference[1]) / std::hypot(bin.reference[0], bin.reference[1]);
  return {kCenterX + kCircleRadius * a, kCenterY - kCircleRadius * b};
}

std::string hue_color(std::size_t bin) {
  return fmt::format("hsl({:.1f}, 65%, 45%)", bin_center(bin) * 360 / kFullTurn);
}

std::string arrow(const Point& from, const Point& to, const std::string& color) {
  constexpr double kHead = 9;
  const double dx = to.first - from.first;
  const double dy = to.second - from.second;
  const double length = std::hypot(dx, dy);
  std::string text = svg_line(from.first, from.second, to.first, to.second,
                              fmt::format("stroke=\"{}\" stroke-width=\"3\"", color));
  if (length < kHead) return text;
  const double x = kHead * dx / length;
  const double y = kHead * dy / length;
  return text + svg_polygon({{to.first + x / 3, to.second + y / 3},
                             {to.first - x - y / 2, to.second - y + x / 2},
                             {to.first - x + y / 2, to.second - y - x / 2}},
                            fmt::format("style=\"fill: {}\"", color));
}

// Circles of 80 to 120 % of the chroma, and the borders of the bins.
std::string grid() {
  std::string text;
  for (const int percent : {80, 90, 100, 110, 120})
    text += svg_circle(kCenterX, kCenterY, kCircleRadius * percent / 100,
                       percent == 100 ? "fill=\"none\" stroke=\"#333\" stroke-width=\"2\""
                                      : "fill=\"none\" stroke=\"#ccc\"");
  for (std::size_t k = 0; k < kBins; ++k) {
    const double border = static_cast<double>(k) * kFullTurn / kBins;
    const auto [x0, y0] = placed(0.05, border);
    const auto [x1, y1] = placed(1.3, border);
    text += svg_line(x0, y0, x1, y1, "stroke=\"#ddd\" stroke-dasharray=\"4 3\"");
    const auto [x, y] = placed(1.38, bin_center(k));
    text +=
        svg_text(x, y + 4, std::to_string(k + 1), "font-size=\"12\" fill=\"#666\" text-anchor=\"middle\"");
  }
  return text;
}

}  // namespace

std::pair<double, double> log_range(const std::vector<double>& values) {
  if (values.empty()) return {1, 10};
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const std::vector<double> steps = log_ticks(std::pow(10, std::floor(std::log10(*smallest)) - 1),
                                              std::pow(10, std::ceil(std::log10(*largest)) + 1));
  const double low = *std::prev(std::upper_bound(steps.begin(), steps.end(), *smallest * (1 + 1e-9)));
  const double high = *std::upper_bound(steps.begin(), steps.end(), *largest * (1 + 1e-9));
  return {low, high};
}

std::string svg(const LogPlot& plot) {
  const auto [xs, ys] = coordinates_of(plot.series);
  const Axis x = log_axis(xs, kLogLeft, kLogRight);
  const Axis y = log_axis(ys, kLogBottom, kLogTop);
  std::string all = frame(x, y, plot.x_label, plot.y_label);
  for (const PlotSeries& series : plot.series) {
    const SvgPoints points = drawn_points(series, x, y);
    all += svg_polyline(points, stroke(series, kLogStroke));
    for (const auto& [px, py] : points) all += marker(px, py, series, "point");
  }
  return svg_document(kLogWidth, kLogHeight, plot.title, all + legend(plot.series));
}

std::string svg(const LinePlot& plot) {
  auto [xs, ys] = coordinates_of(plot.series);
  ys.push_back(0);
  if (xs.empty()) xs.push_back(0);
  const auto [x_low, x_high] = std::ranges::minmax(xs);
  const auto [y_low, y_high] = std::ranges::minmax(ys);
  const Axis x = linear_axis(x_low, x_high, kLeft, kRight);
  const Axis y = linear_axis(y_low, y_high, kBottom, kTop);
  std::string elements = frame(x, y, plot.x_label, plot.y_label);
  double row = kTop + 18;
  for (const PlotSeries& series : plot.series) {
    elements += svg_polyline(drawn_points(series, x, y), stroke(series, 2));
    if (series.name.empty()) continue;
    elements += svg_line(kRight - 150, row - 4, kRight - 122, row - 4, stroke(series, 2));
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
  const Axis x = linear_axis(0, width * static_cast<double>(counts.size()), kLeft, kRight);
  const Axis y = linear_axis(0, *std::max_element(counts.begin(), counts.end()), kBottom, kTop);
  std::string elements = frame(x, y, x_label, "patches");
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double left = x.at(width * static_cast<double>(i));
    elements += svg_rect(left, y.at(counts[i]), x.at(width * static_cast<double>(i + 1)) - left,
                         kBottom - y.at(counts[i]), "fill=\"#4a7ab5\" stroke=\"white\"");
  }
  return svg_document(kWidth, kHeight, title, elements);
}

std::string color_vector_graphic(const ColorFidelity& fidelity, const std::string& title) {
  SvgPoints outline;
  std::string arrows;
  for (std::size_t k = 0; k < kBins; ++k) {
    if (!fidelity.bins[k].has_samples()) continue;
    outline.push_back(shifted(fidelity.bins[k], k));
    arrows += arrow(placed(1, bin_center(k)), outline.back(), hue_color(k));
  }
  std::string elements = grid() + svg_polygon(outline, "stroke=\"#c22\" stroke-width=\"2\"") + arrows;
  const auto corner = [](double x, const char* anchor, const std::string& text) {
    return svg_text(x, kGraphicTop + 24, text, fmt::format("font-size=\"18\" text-anchor=\"{}\"", anchor));
  };
  elements += corner(12, "start", fmt::format("Rf {:.0f}", fidelity.fidelity));
  elements += corner(kSize - 12, "end",
                     std::isnan(fidelity.gamut) ? "Rg -" : fmt::format("Rg {:.0f}", fidelity.gamut));
  return svg_document(kSize, kGraphicTop + kSize, title, elements);
}

}  // namespace abbe
