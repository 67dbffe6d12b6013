#pragma once

#include <string>

#include "validation/plot/log_plot.h"

namespace abbe {

/// Plot of y against x on linear axes with round limits.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;  ///< Drawn as lines without markers; values may have any sign.
};

/// The plot as an SVG document.
[[nodiscard]] std::string svg(const LinePlot& plot);

/// SVG document with a histogram of `values` in bins of the given width, starting at 0.
[[nodiscard]] std::string histogram_svg(const std::vector<double>& values, double width,
                                        const std::string& title, const std::string& x_label);

}  // namespace abbe
