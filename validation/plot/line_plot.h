#pragma once

#include <string>

#include "validation/plot/log_plot.h"

namespace abbe {

/// A plot of y against x on linear axes that begin at the least round number.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;  ///< Drawn as lines without markers; values of any sign.
};

/// The plot as an SVG document.
[[nodiscard]] std::string svg(const LinePlot& plot);

/// How many of `values` lie in bins of this width from 0 on, as bars: an SVG document.
[[nodiscard]] std::string histogram_svg(const std::vector<double>& values, double width,
                                        const std::string& title, const std::string& x_label);

}  // namespace abbe
