#pragma once

#include <string>
#include <vector>

#include "io/data_directory.h"
#include "io/table.h"
#include "spectral/colorimetry.h"
#include "validation/cases/tables.h"

namespace abbe {

/// Colours of a chart's patches for the CIE 1931 observer, with Y = 100 for the perfect diffuser.
/// All three lists have one entry per patch, in the order of the chart.
struct ChartColors {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;
  std::vector<Lab> lab;  ///< L*a*b* relative to the illuminant's white.
};
/// Integrates the colours of a chart in steps of 1 nm over a range, by default 360 to 830 nm. `spectra` names
/// a shipped chart of reflectances, `illuminant` a shipped illuminant. Throws Error{input} for an unknown
/// name.
[[nodiscard]] ChartColors chart_colors(const std::string& spectra, const std::string& illuminant,
                                       SumRange range = {});

/// CIEDE2000 of each patch, in the order of the chart, with mean and maximum.
struct ChartDifference {
  std::vector<double> patches;
  double mean = 0;
  double max = 0;
};
/// Differences of two lists of patches in the same order, with at least one patch. Throws Error{internal} if
/// their lengths differ.
[[nodiscard]] ChartDifference difference_of(const std::vector<Lab>& reference,
                                            const std::vector<Lab>& sample);

/// L*a*b* of the patches of an edition of the ColorChecker under D50, in the order of its table. `edition` is
/// the name of a table in `data/reflectance` without "colorchecker24_", such as "after_nov2014". The values
/// are integrated if the edition has spectra, and as published otherwise. Throws Error{input} for an unknown
/// edition.
[[nodiscard]] std::vector<Lab> edition_lab(const std::string& edition);

}  // namespace abbe
