#include "calibration/camera_calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/fit/noise_weights.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr double kPhotographLevel =
    0.95;  // linear exposure of the brightest value in the photograph to which the matrix is fitted
constexpr double kLowestStop = -9;
constexpr double kHighestStop = 6;
constexpr double kStopsPerExposure = 1.0 / 3;

// Times from 2^-9 to 2^6 s in thirds of a stop. The brightest value reaches kPhotographLevel in 1 s.
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

// Largest linear value of a patch before white balance.
double brightest_patch(const MeasuredCamera& camera) {
  double brightest = 0;
  for (const Raw& raw : camera.colors.raw)
    for (std::size_t k = 0; k < 3; ++k) brightest = std::max(brightest, raw[k] / camera.gains[k]);
  return brightest;
}

// Largest error of exposure between 1 % and 99 % of the code range.
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
    throw Error(ErrorCode::usage, "--bits", fmt::format("expected 0 to 16 (got {})", setup.bits));
}

}  // namespace

CameraCalibration calibrate_measured(const MeasuredCamera& camera, const CharacterisationOptions& options) {
  const bool is_trained = !camera.training.raw.empty();
  PatchColors colors = is_trained ? camera.training : camera.colors;
  if (!is_trained && !camera.deviations.empty()) colors.weights = noise_weights(colors, camera.deviations);
  CorrectionOptions how = options.fit;
  const std::optional<Matrix3> to_d65 = adaptation(colors.white, unit_xyz(kD65), options.adaptation);
  if (!to_d65)
    throw Error(ErrorCode::input, camera.light, "chromatic adaptation of its white to D65 is impossible");
  CameraCalibration result;
  if (options.choose) {
    result.candidates = cross_validate_models(colors, how, options.folds);
    how.model = result.candidates.front().model;
  }
  require_enough_patches(how.model, colors.raw.size());
  result.colors = camera.colors;
  result.patches = camera.colors.names;
  result.correction = fit_correction(colors, how);
  if (is_trained) {
    result.training_patches = colors.raw.size();
    result.correction.start = patch_errors(camera.colors, white_preserving_least_squares(colors, how.model));
    result.unseen = result.correction.errors = patch_errors(camera.colors, result.correction.correction);
  } else {
    result.unseen = cross_validate(colors, how, options.folds > 0 ? options.folds : colors.raw.size());
  }
  result.unseen_mean = bootstrap_mean(result.unseen.delta_e, options.bootstrap);
  result.columns = bootstrap_columns(colors, how, options.bootstrap);
  result.profile.light = camera.light;
  result.profile.description = valid_utf8(fmt::format("{} under {}", camera.name, camera.light));
  for (std::size_t k = 0; k < camera.responses.size(); ++k)
    result.profile.linearisation.at(k) = camera.responses[k].fit.linear;
  result.profile.gains = camera.gains;
  result.profile.brightest_patch = brightest_patch(camera);
  result.profile.correction = result.correction.correction;
  result.profile.adaptation = *to_d65;
  result.responses = camera.responses;
  return result;
}

bool choose_correction(CharacterisationOptions& options, std::string_view name) {
  const auto known = std::find(kCorrectionNames.begin(), kCorrectionNames.end(), name);
  const bool is_model = known != kCorrectionNames.end();
  if (!is_model && name != "auto") return false;
  options.choose = !is_model;
  if (is_model) options.fit.model = static_cast<CorrectionModel>(known - kCorrectionNames.begin());
  return true;
}

CameraCalibration calibrate_camera(const CalibrationSetup& setup, const CharacterisationOptions& options) {
  require_setup(setup);
  const bool is_linear = setup.planted_response.empty();
  const PlantedResponse planted(is_linear ? "linear" : setup.planted_response);
  const std::vector<std::vector<double>> values = photographed_values(setup);
  MeasuredCamera camera{
      setup.camera, setup.illuminant, integrate(setup.chart, setup.channels, setup.light), {}, {}};
  if (!setup.training.patches.empty())
    camera.training = integrate(setup.training, setup.channels, setup.light);
  const std::vector<double> times_s = is_linear ? std::vector{1.0} : exposure_times();
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> linear;
    for (const std::vector<double>& code :
         expose(values[k], std::array{1.0}, planted, {setup.bits, 0, 0}).codes)
      linear.push_back(code[0]);
    if (!is_linear) {
      ResponseFit fit = recover_response(expose(values[k], times_s, planted, {setup.bits, 0, 0}));
      for (double& v : linear) v = linearise(fit.linear, v);
      const double error = response_error(fit, planted);
      camera.responses.push_back({setup.channels[k].name, std::move(fit), error});
    }
    const double white = linear.back();
    for (std::size_t i = 0; i < camera.colors.raw.size(); ++i) camera.colors.raw[i][k] = linear[i] / white;
    camera.gains[k] = 1 / white;
  }
  CameraCalibration result = calibrate_measured(camera, options);
  result.times_s = times_s;
  for (std::size_t k = 0; k < 3; ++k) result.profile.channels[k] = setup.channels[k].name;
  return result;
}

}  // namespace abbe
