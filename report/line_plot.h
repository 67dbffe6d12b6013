#pragma once

#include <string>

#include "report/log_plot.h"

namespace abbe {

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

}  // namespace abbe
