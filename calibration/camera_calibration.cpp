#include "calibration/camera_calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/output/color_spaces.h"
#include "io/atomic_file.h"
#include "io/error.h"

namespace abbe {
namespace {

constexpr double kPhotographLevel =
    0.95;  // linear exposure of the brightest value in the photograph the matrix is fitted to
constexpr double kLowestStop = -9;
constexpr double kHighestStop = 6;
constexpr double kStopsPerExposure = 1.0 / 3;

std::vector<double> exposure_times() {
  std::vector<double> times;
  for (int i = 0; kLowestStop + i * kStopsPerExposure <= kHighestStop; ++i)
    times.push_back(std::exp2(kLowestStop + i * kStopsPerExposure));
  return times;
}

// Raw values of the patches and, last, of the white tile, scaled so that the brightest of all channels is
// kPhotographLevel.
std::vector<std::vector<double>> photographed_values(const CalibrationSetup& setup) {
  std::vector<std::vector<double>> values(3);
  const auto add = [&](const Curve& reflectance) {
    const std::vector<double> raw = camera_raw(setup.channels, setup.light, reflectance);
    for (std::size_t k = 0; k < 3; ++k) values[k].push_back(raw[k]);
  };
  for (const Patch& patch : setup.chart.patches) add(patch.reflectance);
  add(Curve(1.0));
  double brightest = 0;
  for (const std::vector<double>& v : values)
    brightest = std::max(brightest, *std::max_element(v.begin(), v.end()));
  for (std::vector<double>& v : values)
    for (double& x : v) x *= kPhotographLevel / brightest;
  return values;
}

double response_error(const ResponseFit& fit, const PlantedResponse& planted) {
  double error = 0;
  for (int i = 10; i <= 990; ++i)
    error = std::max(error, std::abs(linearise(fit.linear, i / 1000.0) - planted.exposure(i / 1000.0)));
  return error;
}

void require_setup(const CalibrationSetup& setup) {
  if (setup.channels.size() != 3)
    throw Error(
        ErrorCode::usage, "camera",
        fmt::format("calibration needs three channels (got {} of {})", setup.channels.size(), setup.camera));
  if (setup.bits < 0 || setup.bits > 16)
    throw Error(ErrorCode::usage, "bits", fmt::format("expected 0 to 16 (got {})", setup.bits));
}

std::string json_string(std::string_view text) {
  std::string out(1, '"');
  for (const char c : text) {
    if (c == '"' || c == '\\') out.push_back('\\');
    if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out.push_back(c);
  }
  out.push_back('"');
  return out;
}

std::string rows(const Matrix3& m) {
  std::vector<std::string> text;
  for (int i = 0; i < 3; ++i) text.push_back(fmt::format("[{}, {}, {}]", m[i][0], m[i][1], m[i][2]));
  return fmt::format("[{}]", fmt::join(text, ", "));
}

std::string response_json(const ChannelResponse& r) {
  return fmt::format(
      R"({{"channel": {}, "max_error": {}, "median_code": {}, "samples": {}, "iterations": {}, "initial_cost": {}, "final_cost": {}}})",
      json_string(r.channel), r.max_error, r.fit.median_code, r.fit.samples, r.fit.iterations,
      r.fit.initial_cost, r.fit.final_cost);
}

}  // namespace

CameraCalibration calibrate_camera(const CalibrationSetup& setup) {
  require_setup(setup);
  PatchColors colors = integrate(setup.chart, setup.channels, setup.light);
  const PlantedResponse planted(setup.planted_response);
  const std::vector<std::vector<double>> values = photographed_values(setup);
  CameraCalibration result{colors.names, exposure_times(), {}, {}, {}};
  std::array<double, 3> balance{};
  for (std::size_t k = 0; k < 3; ++k) {
    ResponseFit fit = recover_response(expose(values[k], result.times_s, planted, setup.bits));
    const ExposureSeries photograph = expose(values[k], std::array{1.0}, planted, setup.bits);
    const double white = linearise(fit.linear, photograph.codes.back()[0]);
    for (std::size_t i = 0; i < colors.raw.size(); ++i)
      colors.raw[i][k] = linearise(fit.linear, photograph.codes[i][0]) / white;
    balance[k] = 1 / white;
    result.profile.linearisation[k] = fit.linear;
    const double error = response_error(fit, planted);
    result.responses[k] = {setup.channels[k].name, std::move(fit), error};
  }
  result.matrix = fit_matrix(colors);
  result.profile.description = fmt::format("{} under {}", setup.camera, setup.illuminant);
  const std::optional<Matrix3> adaptation = bradford(colors.white, unit_xyz(kD65));
  if (!adaptation)
    throw Error(ErrorCode::input, setup.illuminant, "the light has no white that a display could show");
  result.profile.to_xyz_d65 = *adaptation * result.matrix.raw_to_xyz * diagonal(balance);
  return result;
}

std::string report_json(const CalibrationSetup& setup, const CameraCalibration& calibration) {
  const MatrixFit& fit = calibration.matrix;
  std::vector<std::string> responses;
  for (const ChannelResponse& r : calibration.responses) responses.push_back(response_json(r));
  std::vector<std::string> patches;
  for (std::size_t i = 0; i < calibration.patches.size(); ++i)
    patches.push_back(fmt::format(R"({{"name": {}, "dE00": {}}})", json_string(calibration.patches[i]),
                                  fit.errors.delta_e[i]));
  return fmt::format(
      R"({{"camera": {}, "illuminant": {}, "chart": {}, "planted_response": {}, "bits": {}, "times_s": [{}],
 "responses": [{}],
 "matrix": {{"raw_to_xyz": {}, "initial_cost": {}, "final_cost": {}, "starts": {}, "usable_starts": {}, "seed": {},
  "least_squares_dE00_mean": {}, "least_squares_dE00_max": {}}},
 "to_xyz_d65": {},
 "dE00_mean": {}, "dE00_max": {},
 "patches": [{}]}}
)",
      json_string(setup.camera), json_string(setup.illuminant), json_string(setup.chart.name),
      json_string(setup.planted_response), setup.bits, fmt::join(calibration.times_s, ", "),
      fmt::join(responses, ",\n  "), rows(fit.raw_to_xyz), fit.initial_cost, fit.final_cost, fit.starts,
      fit.usable, MatrixFitOptions{}.seed, fit.start.mean, fit.start.max,
      rows(calibration.profile.to_xyz_d65), fit.errors.mean, fit.errors.max, fmt::join(patches, ",\n  "));
}

void write_calibration(const std::filesystem::path& folder, const CalibrationSetup& setup,
                       const CameraCalibration& calibration) {
  write_ocio_config(folder, calibration.profile);
  write_atomically(folder / "report.json", report_json(setup, calibration));
}

}  // namespace abbe
