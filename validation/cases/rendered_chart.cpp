// The rendered ColorChecker, with the CIE 1931 observer as sensor.
#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "scene/chart/readout.h"
#include "transport/render/render.h"
#include "validation/cases/charts.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

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

std::vector<Case> rendered_chart_cases() {
  constexpr int kSamples = 512;
  std::vector<Case> cases;
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

}  // namespace abbe
