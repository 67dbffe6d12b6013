#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

/// A logarithmic axis from `low` to `high` (0 < low < high), drawn between two pixel coordinates.
struct LogAxis {
  double low, high;
  double pixel_low, pixel_high;  ///< Coordinates of `low` and `high`, in either order.

  /// Pixel coordinate of a value > 0; outside the axis it is extrapolated.
  [[nodiscard]] double at(double value) const;
};

/// Range around all `values`, whose limits are 1, 2 or 5 times a power of ten. The lower limit is the largest
/// one that does not exceed any value, the upper one the smallest that exceeds all. The values must lie in
/// [1e-20, 1e20], which is not checked; [1, 10] without values.
[[nodiscard]] std::pair<double, double> log_range(const std::vector<double>& values);

/// Named points with the style of their line and markers.
struct PlotSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< x, y; both > 0 in a `LogPlot`.
  std::string color;                              ///< Colour in SVG syntax, not escaped.
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

/// The plot as an SVG document with a legend of all series; texts are escaped. Coordinates must lie in
/// [1e-20, 1e20].
[[nodiscard]] std::string svg(const LogPlot& plot);

}  // namespace abbe
