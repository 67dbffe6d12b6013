#pragma once

#include <string>
#include <vector>

#include "io/data_directory.h"
#include "io/table.h"
#include "spectral/colorimetry.h"
#include "validation/cases/tables.h"

namespace abbe {

/// What the CIE 1931 observer makes of a chart's patches: Y = 100 for the perfect diffuser.
struct ChartColors {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;
  std::vector<Lab> lab;  ///< Relative to the illuminant's white.
};
/// Colours of a chart from a shipped table of spectra, by 1 nm sums over a range.
[[nodiscard]] ChartColors chart_colors(const std::string& spectra, const std::string& illuminant,
                                       SumRange range = {});

/// CIEDE2000 patch by patch.
struct ChartDifference {
  std::vector<double> patches;
  double mean = 0;
  double max = 0;
};
[[nodiscard]] ChartDifference difference_of(const std::vector<Lab>& reference,
                                            const std::vector<Lab>& sample);

/// L*a*b* of the patches of an edition of the ColorChecker under D50, as "after_nov2014": from its spectra,
/// or as published.
[[nodiscard]] std::vector<Lab> edition_lab(const std::string& edition);

}  // namespace abbe
