#include "cli/calibrate_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "calibration/metrics/camera_quality.h"
#include "cli/page.h"
#include "cli/sensor_plots.h"
#include "report/display_color.h"
#include "report/line_plot.h"
#include "report/svg.h"

namespace abbe::cli {
namespace {

constexpr double kHistogramStep = 0.25;

std::string response_plot(const std::vector<Channel>& channels) {
  double max_weight = 0;
  for (const Channel& channel : channels) max_weight = std::max(max_weight, channel.weight.max());
  LinePlot plot{"Spectral responses to energy", "wavelength [nm]", "relative to the maximum", {}};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    PlotSeries series{channels[i].name, {}, line_color(channels[i].name, i)};
    for (int nm = SumRange{}.low_nm; nm <= SumRange{}.high_nm; nm += 2)
      series.points.emplace_back(nm, channels[i].weight(nm) / max_weight);
    plot.series.push_back(std::move(series));
  }
  return inline_svg(svg(plot));
}

std::string camera_metrics(const std::vector<Channel>& channels) {
  const CameraSpace space = camera_space(channels);
  return fmt::format(
      "<p>Vora value {:.3f}; residual of x, y and z after the best fit by the channels: {:.0f}, {:.0f} and "
      "{:.0f} %; sensitivity metamerism index {:.1f}.</p>\n",
      space.vora, 100 * space.luther[0], 100 * space.luther[1], 100 * space.luther[2],
      sensitivity_index(channels));
}

// CSS colour of an XYZ relative to D65.
std::string css(const XYZ& xyz) {
  const DisplayColor code = display_code(linear_rgb_of_xyz(xyz));
  return fmt::format("rgb({:.1f}% {:.1f}% {:.1f}%)", 100 * code[0], 100 * code[1], 100 * code[2]);
}

// Patch in three colours: the reference, the camera values with white balance only, and the corrected values.
std::string patch_html(const CameraCalibration& c, std::size_t i) {
  const auto to_d65 = [&](const XYZ& xyz) { return multiply(c.profile.adaptation, xyz); };
  const Raw& raw = c.colors.raw[i];
  const DisplayColor balanced = display_code({raw[0], raw[1], raw[2]});
  return fmt::format(
      "<div class=\"patch\"><div class=\"swatch\"><div style=\"background: {}\"></div><div "
      "style=\"background: rgb({:.1f}% {:.1f}% {:.1f}%)\"></div><div style=\"background: "
      "{}\"></div></div>{}<br><span class=\"soft\">{:.2f}, left out {:.2f}</span></div>\n",
      css(to_d65(c.colors.xyz[i])), 100 * balanced[0], 100 * balanced[1], 100 * balanced[2],
      css(to_d65(c.correction.correction(raw))), escaped(c.patches[i]), c.correction.errors.delta_e[i],
      c.unseen.delta_e[i]);
}

std::string error_table(const CameraCalibration& c) {
  const auto row = [](const char* name, const PatchErrors& errors) {
    return fmt::format("<tr><td>{}</td><td>{:.3f}</td><td>{:.3f}</td></tr>\n", name, errors.mean, errors.max);
  };
  return "<table><tr><th>CIEDE2000</th><th>mean</th><th>max</th></tr>\n" +
         row("least squares", c.correction.start) + row("fitted", c.correction.errors) +
         row("left out of the fit", c.unseen) + "</table>\n";
}

std::string figure_cell(const Json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : table_cell(value);
}

// Table of the figures of each channel, without those that are lists.
std::string noise_section(const Json& answer) {
  std::string html = "<h2>Noise and dynamic range</h2>\n<table>\n";
  for (const auto& [name, values] : answer.items()) {
    if (!values.is_array() || values.empty() || values.front().is_array()) continue;
    html += fmt::format("<tr><td>{}</td>", escaped(name));
    for (const Json& value : values) html += fmt::format("<td>{}</td>", figure_cell(value));
    html += "</tr>\n";
  }
  return html + "</table>\n" + inline_svg(transfer_plot(answer));
}

std::string sharpness_section(const Json& answer) {
  return fmt::format("<h2>Sharpness</h2>\n<p>MTF50: the modulation is one half at {} cycles per pixel.</p>\n",
                     figure_cell(answer.value("mtf50", Json()))) +
         inline_svg(mtf_plot(answer));
}

std::string calibration_section(const CalibrationCase& one) {
  const CameraCalibration& c = one.result;
  std::string html = fmt::format(
      "<h2>{} under {}</h2>\n<p>Chart {}. Each patch shows the reference colour, the camera values with "
      "white balance only, and the corrected colour. The numbers are CIEDE2000 of the fit, and of a fit that "
      "left the patch out.</p>\n<div class=\"patches\">\n",
      escaped(one.camera), escaped(c.profile.light), escaped(one.chart));
  for (std::size_t i = 0; i < c.patches.size(); ++i) html += patch_html(c, i);
  html += "</div>\n" + error_table(c);
  return html + inline_svg(histogram_svg(c.unseen.delta_e, kHistogramStep, "Patches left out of the fit",
                                         "CIEDE2000"));
}

}  // namespace

std::string page_of(const std::vector<CalibrationCase>& cases, const std::vector<Channel>& channels,
                    const MeasurementAnswers& measurements) {
  const std::string camera = cases.empty() ? "" : cases.front().camera;
  std::string html = page_head(camera);
  if (channels.size() == 3) html += response_plot(channels) + camera_metrics(channels);
  if (!measurements.transfer.is_null()) html += noise_section(measurements.transfer);
  if (!measurements.mtf.is_null()) html += sharpness_section(measurements.mtf);
  for (const CalibrationCase& one : cases) html += calibration_section(one);
  return html + kPageEnd;
}

}  // namespace abbe::cli
