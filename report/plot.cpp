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

// A logarithmic axis from `low` to `high` (0 < low < high), drawn between two pixel coordinates.
struct LogAxis {
  double low, high;
  double pixel_low, pixel_high;  ///< Coordinates of `low` and `high`, in either order.

  // Pixel coordinate of a value > 0; outside the axis it is extrapolated.
  [[nodiscard]] double at(double value) const {
    return pixel_low + (pixel_high - pixel_low) * std::log(value / low) / std::log(high / low);
  }
};

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
