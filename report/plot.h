#pragma once

#include <string>
#include <utility>
#include <vector>

namespace abbe {

struct ColorFidelity;

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

/// Plot of y against x on linear axes with round limits that contain all points. The y axis includes 0.
/// Coordinates must be finite.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  /// Drawn as lines without markers; values may have any sign. A series without a name is not in the legend.
  std::vector<PlotSeries> series;
};

/// The plot as an SVG document; texts are escaped. Without points the axes are empty.
[[nodiscard]] std::string svg(const LinePlot& plot);

/// SVG document with a histogram of one finite value per patch, in bins of the given `width` > 0, in the unit
/// of the values, that start at 0. Negative values count in the first bin. The y axis is labelled "patches".
/// Without values the axes are empty.
[[nodiscard]] std::string histogram_svg(const std::vector<double>& values, double width,
                                        const std::string& title, const std::string& x_label);

/// Colour vector graphic of [TM30, sec. 4.7] as an SVG document. An arrow for each of the 16 hue bins points
/// from the mean colour under the reference, on a circle, to that under the light. R_f and R_g are printed in
/// the corners. Bins without samples are omitted; R_g is "-" if it is NaN. `title` is escaped.
[[nodiscard]] std::string color_vector_graphic(const ColorFidelity& fidelity, const std::string& title);

}  // namespace abbe
