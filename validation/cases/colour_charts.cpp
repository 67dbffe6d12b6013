// The ColorChecker: colours integrated from its spectra, differences between its editions, and renders with
// the CIE 1931 observer as sensor.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "calibration/output/display.h"
#include "io/data_directory.h"
#include "io/table.h"
#include "scene/chart/readout.h"
#include "spectral/astm_e308.h"
#include "transport/render/render.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

// Colours of a chart's patches for the CIE 1931 observer, with Y = 100 for the perfect diffuser.
struct ChartColors {
  std::vector<std::string> names;
  std::vector<XYZ> xyz;
  std::vector<Lab> lab;  ///< L*a*b* relative to the illuminant's white.
};

// CIEDE2000 of each patch, in the order of the chart, with mean and maximum.
struct ChartDifference {
  std::vector<double> patches;
  double mean = 0;
  double max = 0;
};

// Sums over a shipped chart and illuminant in steps of 1 nm, by default from 360 to 830 nm.
ChartColors chart_colors(const std::string& spectra, const std::string& illuminant, SumRange range = {}) {
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

// Differences of two lists of patches in the same order, with at least one patch. Throws Error{internal} if
// their lengths differ.
ChartDifference difference_of(const std::vector<Lab>& reference, const std::vector<Lab>& sample) {
  if (reference.size() != sample.size())
    throw Error(ErrorCode::internal, "charts",
                fmt::format("{} patches against {}", sample.size(), reference.size()));
  ChartDifference difference;
  for (std::size_t i = 0; i < sample.size(); ++i)
    difference.patches.push_back(delta_e_2000(reference[i], sample[i]));
  difference.mean = std::accumulate(difference.patches.begin(), difference.patches.end(), 0.0) /
                    static_cast<double>(sample.size());
  difference.max = *std::ranges::max_element(difference.patches);
  return difference;
}

// L*a*b* of the patches under D50. `edition` is the name of a table without "colorchecker24_", such as
// "after_nov2014". Editions without spectra have their published values.
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

struct IntegratedTable {
  const char* reference;
  const char* spectra;
};
constexpr std::array<IntegratedTable, 2> kTables{
    {{"colorchecker_babelcolor_2deg", "colorchecker24_babelcolor_average"},
     {"colorchecker_ohta_iso17321_2deg", "colorchecker24_ohta1997"}}};

// X, Y, Z, L*, a*, b* of every patch under every illuminant of a reference table.
Figures patches_of(const IntegratedTable& chart, SumRange range) {
  std::map<std::string, ChartColors> integrated;
  return figures_of_rows(chart.reference, [&](Figures& figures, const ReferenceRow& row) {
    const std::string& light = row.text("illuminant");
    if (!integrated.contains(light)) integrated[light] = chart_colors(chart.spectra, light, range);
    const ChartColors& colors = integrated[light];
    const auto patch = static_cast<std::size_t>(row.number("index")) - 1;
    const std::string what = light + " " + row.text("patch") + " ";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string xyz(1, "XYZ"[i]);
      const std::string lab(1, "Lab"[i]);
      figures.push_back({what + xyz, row.number(xyz), {colors.xyz.at(patch)[i]}});
      figures.push_back({what + lab, row.number(lab), {colors.lab.at(patch)[i]}});
    }
  });
}
// L*a*b* of every patch by the weights of ASTM E308. Another program computed the reference from the same
// tables.
Figures astm_patches() {
  std::map<std::string, TristimulusWeights> weights;
  return figures_of_rows(kTables[0].reference, [&](Figures& figures, const ReferenceRow& row) {
    const std::string& light = row.text("illuminant");
    if (light.starts_with("FL"))
      return;  // that program extrapolates their first value below 380 nm as a constant
    if (!weights.contains(light))
      weights[light] = astm_weights(shipped_illuminant(light), Observer::cie1931, 10);
    Diagnostics diagnostics;
    const std::string& patch = row.text("patch");
    const Samples samples = shipped(
        load_astm_samples(std::string(kTables[0].spectra) + ":" + patch, {}, diagnostics), diagnostics);
    const Lab lab = xyz_to_lab(astm_tristimulus(weights[light], samples), astm_white(weights[light]));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name(1, "Lab"[i]);
      figures.push_back({light + " " + patch + " " + name, row.number(name + "_E308"), {lab[i]}});
    }
  });
}

// Mean CIEDE2000 between the integrated patches and the reference, for each table and illuminant.
Figures integrated_differences() {
  Figures figures;
  for (const IntegratedTable& chart : kTables) {
    const ReferenceTable table(chart.reference);
    std::map<std::string, std::vector<Lab>> known;
    for (std::size_t row = 0; row < table.rows(); ++row)
      known[table.text(row, "illuminant")].push_back(
          {table.number(row, "L"), table.number(row, "a"), table.number(row, "b")});
    for (const auto& [light, labs] : known)
      figures.push_back({fmt::format("{} {}", chart.spectra, light),
                         0,
                         {difference_of(labs, chart_colors(chart.spectra, light, kVisibleRange).lab).mean}});
  }
  return figures;
}

// Differences between editions under D50: the uncertainty of the chart itself.
Figures edition_spread() {
  struct Pair {
    const char *first, *second;
    double mean, max;
  };
  constexpr std::array<Pair, 2> kPairs{{{"before_nov2014", "after_nov2014", 0.848, 1.951},
                                        {"2005_xyY", "babelcolor_average_xyY", 0.489, 1.128}}};
  Figures figures;
  for (const Pair& pair : kPairs) {
    const ChartDifference d = difference_of(edition_lab(pair.first), edition_lab(pair.second));
    const std::string what = fmt::format("{} / {}", pair.first, pair.second);
    figures.push_back({what + " mean", pair.mean, {d.mean}});
    figures.push_back({what + " max", pair.max, {d.max}});
  }
  return figures;
}

constexpr const char* kScene = "colorchecker.json";
constexpr const char* kSpectra = "colorchecker24_babelcolor_average";
// The scene's light gives the chart 1 lx. A pinhole of f-number 1 reduces the exposure of a perfect diffuser
// to a quarter.
constexpr double kWhite = 0.25;
const std::vector<std::string> kChannels{"X", "Y", "Z"};

std::vector<Lab> rendered_lab(const Scene& scene, const Image& film, const XYZ& white) {
  std::vector<Lab> labs;
  for (const PatchReading& patch : read_patches(scene, scene.charts.at(0), film, kChannels)) {
    XYZ xyz{};
    for (std::size_t i = 0; i < 3; ++i) xyz[i] = 100 / kWhite * patch.mean[i];
    labs.push_back(xyz_to_lab(xyz, white));
  }
  return labs;
}

// Differences between the render and other editions. The edition with spectra is compared under any light,
// the others under D50.
std::vector<Remark> editions(const std::vector<Lab>& rendered, const std::string& illuminant) {
  std::vector<Remark> remarks;
  const auto add = [&](const std::string& name, const std::vector<Lab>& lab) {
    const ChartDifference d = difference_of(lab, rendered);
    remarks.push_back({fmt::format("ΔE2000 to edition {}, mean", name), d.mean});
    remarks.push_back({fmt::format("ΔE2000 to edition {}, max", name), d.max});
  };
  add("ohta1997", chart_colors("colorchecker24_ohta1997", illuminant).lab);
  if (illuminant != "D50") return remarks;
  for (const char* edition : {"2005_xyY", "babelcolor_average_xyY", "before_nov2014", "after_nov2014"})
    add(edition, edition_lab(edition));
  remarks.push_back({"ΔE2000 between the editions before and after November 2014, mean",
                     difference_of(edition_lab("before_nov2014"), edition_lab("after_nov2014")).mean});
  return remarks;
}

}  // namespace

std::vector<Case> chart_cases() {
  const ComputedCases computed{Suite::colour};
  std::vector<Case> cases{
      computed("chart-patches", "ColorChecker, mean of 30 charts: XYZ and L*a*b* of each patch",
               "spectra of [Pascale2012], 1 nm sums [CIE15, sec. 7.1]", "", {1e-5},
               [] {
                 return patches_of({"colorchecker_babelcolor_360_830", kTables[0].spectra}, {});
               }),
      computed("chart-babelcolor",
               "ColorChecker, mean of 30 charts, summed from 380 to 780 nm: XYZ and L*a*b* of each patch",
               "spectra of [Pascale2012], 1 nm sums [CIE15, sec. 7.1]", "", {1e-5},
               [] { return patches_of(kTables[0], kVisibleRange); }),
      computed("chart-ohta", "ColorChecker of Ohta, summed from 380 to 780 nm: XYZ and L*a*b* of each patch",
               "spectra of [Ohta1997], 1 nm sums [CIE15, sec. 7.1]", "", {1e-5},
               [] { return patches_of(kTables[1], kVisibleRange); }),
      computed("chart-astm", "ColorChecker by the weights of ASTM E308: L*a*b* of each patch",
               "spectra of [Pascale2012], [ASTM308]", "", {1e-5}, astm_patches),
      computed("chart-integrated", "ColorChecker integrated against the same spectra: mean ΔE2000",
               "[Pascale2012], [Ohta1997], [CIE15, sec. 7.1]", "", {0.001}, integrated_differences),
      computed("chart-editions", "editions of the ColorChecker against each other, D50: ΔE2000",
               "tables of [XRite2016] and [Pascale2012]", "", {0.001}, edition_spread),
  };
  constexpr int kSamples = 512;
  for (const char* illuminant : {"A", "D50", "D65", "FL2", "FL11", "LED-B1"})
    cases.push_back({Suite::colour,
                     fmt::format("chart-{}", illuminant),
                     fmt::format("ColorChecker rendered under {}: ΔE2000 to its own spectra", illuminant),
                     "spectra of [Pascale2012], 1 nm sums [CIE15, sec. 7.1]",
                     "ΔE",
                     {0.15},
                     RenderedChart{illuminant, kSamples, 0.05}});
  return cases;
}

CaseResult measure(const Case& item, const RenderedChart& method, const CaseSettings& settings) {
  Scene scene = load_case_scene(item.id, kScene,
                                std::vector<Override>{{"/lights/0/emission/illuminant", method.illuminant}});
  scene.render.samples = method.samples;
  const RenderResult rendered = render(scene, {.threads = settings.threads});
  const Image film = rendered.film.image(kChannels);
  const Curve light = shipped_illuminant(method.illuminant);
  const std::vector<Lab> labs = rendered_lab(scene, film, tristimulus(light, Curve(1), Observer::cie1931));
  const ChartColors truth = chart_colors(kSpectra, method.illuminant);
  const ChartDifference difference = difference_of(truth.lab, labs);
  CaseResult result{};
  result.margin = item.margin;
  result.figures = {{"mean", 0, {difference.mean, 0}, Margin{method.mean_margin}}};
  for (std::size_t i = 0; i < labs.size(); ++i)
    result.figures.push_back({truth.names[i], 0, {difference.patches[i], 0}, {}});
  result.samples = method.samples;
  result.remarks = editions(labs, method.illuminant);
  result.picture = make_display(scene.channels, light)(film, 1 / kWhite).image;
  return result;
}

}  // namespace abbe
