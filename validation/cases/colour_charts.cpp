// The ColorChecker: colours integrated from its spectra, and differences between its editions.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "io/table.h"
#include "spectral/astm_e308.h"
#include "validation/cases/charts.h"
#include "validation/cases/figures.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

struct IntegratedTable {
  const char* reference;
  const char* spectra;
};
constexpr std::array<IntegratedTable, 2> kTables{
    {{"colorchecker_babelcolor_2deg", "colorchecker24_babelcolor_average"},
     {"colorchecker_ohta_iso17321_2deg", "colorchecker24_ohta1997"}}};

// X, Y, Z, L*, a*, b* of every patch under every illuminant of a reference table.
std::vector<Figure> patches_of(const IntegratedTable& chart, SumRange range) {
  const ReferenceTable table(chart.reference);
  std::map<std::string, ChartColors> integrated;
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& light = table.text(row, "illuminant");
    if (!integrated.contains(light)) integrated[light] = chart_colors(chart.spectra, light, range);
    const ChartColors& colors = integrated[light];
    const auto patch = static_cast<std::size_t>(table.number(row, "index")) - 1;
    const std::string what = light + " " + table.text(row, "patch") + " ";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string xyz(1, "XYZ"[i]);
      const std::string lab(1, "Lab"[i]);
      figures.push_back(exact_figure(what + xyz, table.number(row, xyz), colors.xyz.at(patch)[i]));
      figures.push_back(exact_figure(what + lab, table.number(row, lab), colors.lab.at(patch)[i]));
    }
  }
  return figures;
}
std::vector<Figure> babelcolor_patches() {
  return patches_of(kTables[0], kVisibleRange);
}
std::vector<Figure> ohta_patches() {
  return patches_of(kTables[1], kVisibleRange);
}
std::vector<Figure> whole_range_patches() {
  return patches_of({"colorchecker_babelcolor_360_830", kTables[0].spectra}, {});
}

// L*a*b* of every patch by the weights of ASTM E308. Another program computed the reference from the same
// tables.
std::vector<Figure> astm_patches() {
  const ReferenceTable table(kTables[0].reference);
  std::map<std::string, TristimulusWeights> weights;
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& light = table.text(row, "illuminant");
    if (light.starts_with("FL"))
      continue;  // that program extrapolates their first value below 380 nm as a constant
    if (!weights.contains(light))
      weights[light] = astm_weights(shipped_illuminant(light), Observer::cie1931, 10);
    Diagnostics diagnostics;
    const std::string& patch = table.text(row, "patch");
    const Samples samples = shipped(
        load_astm_samples(std::string(kTables[0].spectra) + ":" + patch, {}, diagnostics), diagnostics);
    const Lab lab = xyz_to_lab(astm_tristimulus(weights[light], samples), astm_white(weights[light]));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name(1, "Lab"[i]);
      figures.push_back(
          exact_figure(light + " " + patch + " " + name, table.number(row, name + "_E308"), lab[i]));
    }
  }
  return figures;
}

// Mean CIEDE2000 between the integrated patches and the reference, for each table and illuminant.
std::vector<Figure> integrated_differences() {
  std::vector<Figure> figures;
  for (const IntegratedTable& chart : kTables) {
    const ReferenceTable table(chart.reference);
    std::map<std::string, std::vector<Lab>> known;
    for (std::size_t row = 0; row < table.rows(); ++row)
      known[table.text(row, "illuminant")].push_back(
          {table.number(row, "L"), table.number(row, "a"), table.number(row, "b")});
    for (const auto& [light, labs] : known)
      figures.push_back(
          exact_figure(fmt::format("{} {}", chart.spectra, light), 0,
                       difference_of(labs, chart_colors(chart.spectra, light, kVisibleRange).lab).mean));
  }
  return figures;
}

// Differences between editions under D50: the uncertainty of the chart itself.
std::vector<Figure> edition_spread() {
  struct Pair {
    const char *first, *second;
    double mean, max;
  };
  constexpr std::array<Pair, 2> kPairs{{{"before_nov2014", "after_nov2014", 0.848, 1.951},
                                        {"2005_xyY", "babelcolor_average_xyY", 0.489, 1.128}}};
  std::vector<Figure> figures;
  for (const Pair& pair : kPairs) {
    const ChartDifference d = difference_of(edition_lab(pair.first), edition_lab(pair.second));
    const std::string what = fmt::format("{} / {}", pair.first, pair.second);
    figures.push_back(exact_figure(what + " mean", pair.mean, d.mean));
    figures.push_back(exact_figure(what + " max", pair.max, d.max));
  }
  return figures;
}

}  // namespace

ChartColors chart_colors(const std::string& spectra, const std::string& illuminant, SumRange range) {
  const Curve light = shipped_illuminant(illuminant);
  const XYZ white = tristimulus(light, Curve(1), Observer::cie1931, range);
  ChartColors colors;
  for (const Patch& patch : shipped_chart(spectra).patches) {
    colors.names.push_back(patch.name);
    colors.xyz.push_back(tristimulus(light, patch.reflectance, Observer::cie1931, range));
    colors.lab.push_back(xyz_to_lab(colors.xyz.back(), white));
  }
  return colors;
}

ChartDifference difference_of(const std::vector<Lab>& reference, const std::vector<Lab>& sample) {
  if (reference.size() != sample.size())
    throw Error(ErrorCode::internal, "charts",
                fmt::format("{} patches against {}", sample.size(), reference.size()));
  ChartDifference difference;
  for (std::size_t i = 0; i < sample.size(); ++i)
    difference.patches.push_back(delta_e_2000(reference[i], sample[i]));
  difference.mean = std::accumulate(difference.patches.begin(), difference.patches.end(), 0.0) /
                    static_cast<double>(sample.size());
  difference.max = *std::max_element(difference.patches.begin(), difference.patches.end());
  return difference;
}

std::vector<Lab> edition_lab(const std::string& edition) {
  const std::string stem = "colorchecker24_" + edition;
  Diagnostics diagnostics;
  const Table table = shipped(
      read_table(data_directory() / "reflectance" / (stem + ".csv"), TableOrigin::shipped, diagnostics),
      diagnostics);
  if (table.column("wavelength_nm")) return chart_colors(stem, "D50").lab;
  const bool derived = table.column("L_derived").has_value();
  std::array<std::vector<double>, 3> columns;
  for (std::size_t i = 0; i < 3; ++i)
    columns[i] = shipped(
        table.numbers(*table.column(std::string(1, "Lab"[i]) + (derived ? "_derived" : "")), diagnostics),
        diagnostics);
  std::vector<Lab> labs;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    labs.push_back({columns[0][row], columns[1][row], columns[2][row]});
  return labs;
}

std::vector<Case> chart_cases() {
  const auto computed = [](std::string id, std::string title, std::string source, Margin margin,
                           std::vector<Figure> (*figures)()) {
    return computed_case(Suite::colour, std::move(id), std::move(title), std::move(source), "", margin,
                         figures);
  };
  return {
      computed("chart-patches", "ColorChecker, mean of 30 charts: XYZ and L*a*b* of each patch",
               "spectra of [Pascale2012], 1 nm sums [CIE15, sec. 7.1]", {1e-5}, whole_range_patches),
      computed("chart-babelcolor",
               "ColorChecker, mean of 30 charts, summed from 380 to 780 nm: XYZ and L*a*b* of each patch",
               "spectra of [Pascale2012], 1 nm sums [CIE15, sec. 7.1]", {1e-5}, babelcolor_patches),
      computed("chart-ohta", "ColorChecker of Ohta, summed from 380 to 780 nm: XYZ and L*a*b* of each patch",
               "spectra of [Ohta1997], 1 nm sums [CIE15, sec. 7.1]", {1e-5}, ohta_patches),
      computed("chart-astm", "ColorChecker by the weights of ASTM E308: L*a*b* of each patch",
               "spectra of [Pascale2012], [ASTM308]", {1e-5}, astm_patches),
      computed("chart-integrated", "ColorChecker integrated against the same spectra: mean ΔE2000",
               "[Pascale2012], [Ohta1997], [CIE15, sec. 7.1]", {0.001}, integrated_differences),
      computed("chart-editions", "editions of the ColorChecker against each other, D50: ΔE2000",
               "tables of [XRite2016] and [Pascale2012]", {0.001}, edition_spread),
  };
}

}  // namespace abbe
