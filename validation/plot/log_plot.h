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

/// The smallest range of steps 1, 2, 5 of decades that holds all of `values` (> 0); [1, 10] for none.
[[nodiscard]] std::pair<double, double> log_range(const std::vector<double>& values);

/// Points of one name, with its line and marker.
struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y, both > 0.
  std::string color;                              ///< As SVG names it.
  bool dashed = false;
  bool hollow = false;  ///< Markers: circles that are not filled.
};

/// A plot of y against x, both logarithmic.
struct LogPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
};

/// The plot as an SVG document.
[[nodiscard]] std::string svg(const LogPlot& plot);

}  // namespace abbe
