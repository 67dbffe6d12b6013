#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// A logarithmic axis from `low` to `high` (both > 0), drawn between two pixel coordinates.
struct LogAxis {
  double low, high;
  double pixel_low, pixel_high;

  /// Pixel coordinate of a value > 0.
  [[nodiscard]] double at(double value) const;
};

/// Smallest range that contains all `values` (> 0) and whose limits are 1, 2 or 5 times a power of ten; [1,
/// 10] without values.
[[nodiscard]] std::pair<double, double> log_range(const std::vector<double>& values);

/// Named points with the style of their line and markers.
struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; both > 0 in a `LogPlot`.
  std::string color;                              ///< Colour in SVG syntax.
  bool dashed = false;
  bool hollow = false;  ///< Markers are drawn as unfilled circles.
};

/// Plot of y against x on logarithmic axes.
struct LogPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
};

/// The plot as an SVG document.
[[nodiscard]] std::string svg(const LogPlot& plot);

}  // namespace abbe
