#include "cli/calibrate_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "calibration/fit/resampling.h"
#include "calibration/output/camera_profile.h"
#include "report/display_color.h"
#include "report/plot.h"
#include "report/svg.h"

namespace abbe::cli {
namespace {

Json json_of(const Interval& interval) {
  return Json::array({interval.low, interval.high});
}

Json json_of(const Matrix3& m) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({m[i][0], m[i][1], m[i][2]});
  return rows;
}

const char* name_of(CorrectionModel model) {
  return kCorrectionNames.at(static_cast<std::size_t>(model));
}

Json correction_json(const CameraCalibration& c) {
  const CorrectionFit& fit = c.correction;
  Json correction;
  correction["model"] = name_of(fit.correction.model);
  correction["columns"] = fit.correction.columns;
  for (const auto& column : c.columns)
    correction["columns_95"].push_back({json_of(column[0]), json_of(column[1]), json_of(column[2])});
  correction["initial_cost"] = fit.initial_cost;
  correction["final_cost"] = fit.final_cost;
  correction["starts"] = fit.starts;
  correction["usable_starts"] = fit.usable;
  correction["seed"] = CorrectionOptions{}.seed;
  correction["least_squares_dE00_mean"] = fit.start.mean;
  correction["least_squares_dE00_max"] = fit.start.max;
  return correction;
}

// Patch colours after chromatic adaptation to another white.
PatchColors adapted(PatchColors colors, const XYZ& white) {
  const Matrix3 to_white = adaptation(colors.white, white).value();
  for (XYZ& xyz : colors.xyz) xyz = multiply(to_white, xyz);
  colors.white = white;
  return colors;
}

std::string row(const std::string& name, double fit, double start, double unseen) {
  return fmt::format("{:<28}{:>10.4f}{:>16.4f}{:>12.4f}\n", name, fit, start, unseen);
}

// Column of the table of cameras.
struct QualityColumn {
  const char* heading;
  double (*value)(const CameraQuality&);
};
constexpr QualityColumn kQualityColumns[] = {
    {"LS mean", [](const CameraQuality& q) { return q.least_squares.mean; }},
    {"max", [](const CameraQuality& q) { return q.least_squares.max; }},
    {"matrix", [](const CameraQuality& q) { return q.matrix.mean; }},
    {"max", [](const CameraQuality& q) { return q.matrix.max; }},
    {"left out", [](const CameraQuality& q) { return q.matrix_unseen.mean; }},
    {"max", [](const CameraQuality& q) { return q.matrix_unseen.max; }},
    {"root", [](const CameraQuality& q) { return q.root.mean; }},
    {"max", [](const CameraQuality& q) { return q.root.max; }},
    {"left out", [](const CameraQuality& q) { return q.root_unseen.mean; }},
    {"max", [](const CameraQuality& q) { return q.root_unseen.max; }},
    {"index", [](const CameraQuality& q) { return q.sensitivity_index; }},
};

Json summary(const PatchErrors& errors) {
  return {{"mean", errors.mean}, {"max", errors.max}};
}

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
      css(to_d65(c.correction.correction(raw))), escaped(c.colors.names[i]), c.correction.errors.delta_e[i],
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
  for (std::size_t i = 0; i < c.colors.names.size(); ++i) html += patch_html(c, i);
  html += "</div>\n" + error_table(c);
  return html + inline_svg(histogram_svg(c.unseen.delta_e, kHistogramStep, "Patches left out of the fit",
                                         "CIEDE2000"));
}

}  // namespace

Json json_of(const ChannelResponse& r) {
  Json answer{{"channel", r.channel}};
  if (r.max_error) answer["max_error"] = *r.max_error;
  answer["uncertainty_95"] = largest_uncertainty(r.fit);
  if (r.fit.misfit)
    answer["misfit"] = {{"codes", {r.fit.misfit->low_code, r.fit.misfit->high_code}},
                        {"exposure", r.fit.misfit->exposure}};
  answer["median_code"] = r.fit.median_code;
  answer["noise_scale"] = r.fit.noise_scale;
  answer["roughness"] = r.fit.roughness;
  answer["samples"] = r.fit.samples;
  answer["iterations"] = r.fit.iterations;
  answer["initial_cost"] = r.fit.initial_cost;
  answer["final_cost"] = r.fit.final_cost;
  return answer;
}

std::string table_of(const std::vector<ChannelResponse>& responses) {
  const auto percent = [](double fraction) { return fmt::format("{:.4f}", 100 * fraction); };
  std::string text = fmt::format("{:<10}{:>22}{:>18}{:>14}{:>9}\n", "channel", "response error [%]",
                                 "uncertainty [%]", "residual [%]", "samples");
  for (const ChannelResponse& r : responses)
    text +=
        fmt::format("{:<10}{:>22}{:>18}{:>14}{:>9}\n", r.channel, r.max_error ? percent(*r.max_error) : "-",
                    percent(largest_uncertainty(r.fit)), percent(r.fit.median_code), r.fit.samples);
  return text;
}

std::string csv_of(const std::vector<ChannelResponse>& responses, const std::string& source) {
  std::string text = fmt::format(
      "# title: response of a camera\n# unit: linear exposure, 1 at full scale, with its 95 % interval\n"
      "# source: {}\ncode",
      source);
  for (const ChannelResponse& r : responses) text += fmt::format(",{0},{0}_low,{0}_high", r.channel);
  const std::size_t size = responses.front().fit.linear.size();
  for (std::size_t i = 0; i < size; ++i) {
    text += fmt::format("\n{}", static_cast<double>(i) / static_cast<double>(size - 1));
    for (const ChannelResponse& r : responses) {
      const auto [low, high] = bounds_95(r.fit, i);
      text += fmt::format(",{:.8g},{:.8g},{:.8g}", r.fit.linear[i], low, high);
    }
  }
  return text + "\n";
}

Json json_of(const CalibrationCase& calibration) {
  const CameraCalibration& c = calibration.result;
  Json answer;
  answer["camera"] = calibration.camera;
  answer["illuminant"] = c.profile.light;
  answer["chart"] = calibration.chart;
  if (!calibration.response.empty()) {
    answer["planted_response"] = calibration.response;
    answer["times_s"] = c.times_s;
  }
  if (calibration.bits > 0) answer["bits"] = calibration.bits;
  answer["responses"] = Json::array();
  for (const ChannelResponse& r : c.responses) answer["responses"].push_back(json_of(r));
  answer["gains"] = c.profile.gains;
  answer["white_values"] = white_values(c.profile);
  if (!c.candidates.empty())
    for (const ModelCandidate& candidate : c.candidates)
      answer["candidates"].push_back(
          {{"correction", name_of(candidate.model)}, {"unseen_dE00_mean", candidate.unseen_mean}});
  if (c.training_patches > 0) answer["training_patches"] = c.training_patches;
  answer["correction"] = correction_json(c);
  answer["adaptation"] = json_of(c.profile.adaptation);
  if (c.profile.correction.model == CorrectionModel::linear)
    answer["to_xyz_d65"] = json_of(matrix_to_xyz_d65(c.profile));
  answer["dE00_mean"] = c.correction.errors.mean;
  answer["dE00_max"] = c.correction.errors.max;
  answer["dE76_mean"] = c.correction.errors.mean_76;
  answer["unseen_dE00_mean"] = c.unseen.mean;
  answer["unseen_dE00_mean_95"] = json_of(c.unseen_mean);
  answer["unseen_dE00_max"] = c.unseen.max;
  if (calibration.test) {
    answer["test_dE00_mean"] = calibration.test->mean;
    answer["test_dE00_max"] = calibration.test->max;
  }
  answer["patches"] = Json::array();
  for (std::size_t i = 0; i < c.colors.names.size(); ++i)
    answer["patches"].push_back({{"name", c.colors.names[i]},
                                 {"dE00", c.correction.errors.delta_e[i]},
                                 {"unseen_dE00", c.unseen.delta_e[i]}});
  return answer;
}

std::string table_of(const CalibrationCase& calibration) {
  const CameraCalibration& c = calibration.result;
  std::string text =
      fmt::format("{} under {}, chart {}", calibration.camera, c.profile.light, calibration.chart);
  text += calibration.bits == 0 ? "\n" : fmt::format(", {} bits\n", calibration.bits);
  if (!c.responses.empty()) text += "\n" + table_of(c.responses);
  const CorrectionFit& fit = c.correction;
  text += fmt::format("\n{:<28}{:>10}{:>16}{:>12}\n", "patch", "dE2000", "least squares", "left out");
  for (std::size_t i = 0; i < c.colors.names.size(); ++i)
    text += row(c.colors.names[i], fit.errors.delta_e[i], fit.start.delta_e[i], c.unseen.delta_e[i]);
  text += row("mean", fit.errors.mean, fit.start.mean, c.unseen.mean);
  text += row("max", fit.errors.max, fit.start.max, c.unseen.max);
  text += fmt::format("mean left out, 95 %: {:.4f} to {:.4f}\n", c.unseen_mean.low, c.unseen_mean.high);
  if (c.training_patches > 0) text += fmt::format("fitted to {} other reflectances\n", c.training_patches);
  for (const ModelCandidate& candidate : c.candidates)
    text += fmt::format("{}: mean left out {:.4f}{}\n", name_of(candidate.model), candidate.unseen_mean,
                        candidate.model == fit.correction.model ? ", chosen" : "");
  if (calibration.test)
    text += fmt::format("on the test chart: mean {:.4f}, max {:.4f}\n", calibration.test->mean,
                        calibration.test->max);
  return text;
}

Json dng_json(const std::vector<CalibrationCase>& cases) {
  std::vector<DngLight> lights;
  for (const CalibrationCase& calibration : cases)
    if (const auto light = dng_light(calibration.result.profile, calibration.result.colors.white))
      lights.push_back(*light);
  if (lights.size() < 2 || lights.size() < cases.size()) return {};
  const auto [warm, cool] = std::minmax_element(
      lights.begin(), lights.end(), [](const DngLight& a, const DngLight& b) { return a.kelvin < b.kelvin; });
  Json answer{{"camera", cases.front().camera}};
  for (const DngLight* light : {&*warm, &*cool})
    answer["lights"].push_back({{"light", light->light},
                                {"CalibrationIlluminant", light->code},
                                {"CCT_K", light->kelvin},
                                {"ColorMatrix", json_of(light->color)},
                                {"ForwardMatrix", json_of(light->forward)}});
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const DngLight& light = lights[i];
    if (&light == &*warm || &light == &*cool) continue;
    const CameraCalibration& calibration = cases[i].result;
    const PatchColors adapted_colors = adapted(calibration.colors, dng_white());
    const ColorCorrection interpolated = linear_correction(forward_between(*warm, *cool, light.kelvin));
    answer["between"].push_back({{"light", light.light},
                                 {"CCT_K", light.kelvin},
                                 {"dE00_mean", patch_errors(adapted_colors, interpolated).mean},
                                 {"own_dE00_mean", calibration.correction.errors.mean}});
  }
  return answer;
}

Json json_of(const std::vector<CameraQuality>& all) {
  Json list = Json::array();
  for (const CameraQuality& q : all)
    list.push_back({{"camera", q.camera},
                    {"least_squares", summary(q.least_squares)},
                    {"matrix", summary(q.matrix)},
                    {"matrix_unseen", summary(q.matrix_unseen)},
                    {"root_polynomial", summary(q.root)},
                    {"root_polynomial_unseen", summary(q.root_unseen)},
                    {"sensitivity_index", q.sensitivity_index}});
  return {{"cameras", std::move(list)}};
}

std::string table_of(const std::vector<CameraQuality>& all) {
  std::string heading = fmt::format("{:<36}", "camera");
  std::string medians = fmt::format("{:<36}", "median");
  std::string text;
  for (const CameraQuality& q : all) {
    text += fmt::format("{:<36}", q.camera);
    for (const QualityColumn& column : kQualityColumns) text += fmt::format("{:>9.2f}", column.value(q));
    text += '\n';
  }
  for (const QualityColumn& column : kQualityColumns) {
    std::vector<double> values;
    for (const CameraQuality& q : all) values.push_back(column.value(q));
    heading += fmt::format("{:>9}", column.heading);
    medians += fmt::format("{:>9.2f}", median(std::move(values)));
  }
  return heading + '\n' + text + medians + '\n';
}

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
