#include "calibration/camera_calibration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/error.h"
#include "io/image.h"
#include "io/text.h"
#include "sensor/film/patch.h"
#include "sensor/response/table_range.h"
#include "spectral/library.h"
#include "spectral/sources.h"

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
  for (const std::vector<double>& v : values) brightest = std::max(brightest, std::ranges::max(v));
  for (std::vector<double>& v : values)
    for (double& x : v) x *= kPhotographLevel / brightest;
  return values;
}

// Largest linear value of a patch before white balance.
double brightest_patch(const BalancedPatches& chart) {
  double brightest = 0;
  for (const Raw& raw : chart.colors.raw)
    for (std::size_t k = 0; k < 3; ++k) brightest = std::max(brightest, raw[k] / chart.gains[k]);
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

constexpr const char* kDiffuser = "perfect diffuser";
constexpr double kNeutralChroma = 5;

std::optional<std::size_t> find(const MeasuredPatches& measured, const std::string& name) {
  const auto found = std::ranges::find(measured.names, name);
  if (found == measured.names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - measured.names.begin());
}

// A patch with a misspelt name would count for nothing.
void require_known(const ChartTargets& chart, const MeasuredPatches& measured) {
  std::vector<std::string> known = chart.names;
  known.emplace_back(kDiffuser);
  for (const std::string& name : measured.names)
    if (std::ranges::find(known, name) == known.end())
      throw Error(ErrorCode::input, "measured patches", unknown_name("patch", name, known));
}

// Measured patches in the order of the chart, without saturated ones.
BalancedPatches in_order(const ChartTargets& chart, const MeasuredPatches& measured) {
  BalancedPatches patches{{{}, {}, {}, chart.white}, {}};
  std::vector<std::string> missing;
  for (std::size_t c = 0; c < chart.names.size(); ++c) {
    const std::string& name = chart.names[c];
    const auto i = find(measured, name);
    if (!i) missing.push_back(name);
    if (!i || measured.saturated.contains(name)) continue;
    patches.colors.names.push_back(name);
    patches.colors.xyz.push_back(chart.xyz[c]);
    patches.colors.raw.push_back(measured.values[*i]);
    if (!measured.deviations.empty()) patches.deviations.push_back(measured.deviations[*i]);
  }
  if (!missing.empty())
    throw Error(ErrorCode::input, "measured patches", fmt::format("missing: {}", fmt::join(missing, ", ")));
  const std::size_t remaining = patches.colors.names.size();
  if (2 * remaining < chart.names.size())
    throw Error(
        ErrorCode::input, "measured patches",
        fmt::format("{} of {} have saturated pixels: expose less, or show the chart on more pixels where "
                    "defective ones exceed {:g} % of a patch",
                    chart.names.size() - remaining, chart.names.size(), 100 * kMaxDefectiveFraction));
  return patches;
}

// Colours of a second chart that was photographed as the one from which the gains come.
PatchColors balanced_by(const std::array<double, 3>& gains, const ChartTargets& chart,
                        const MeasuredPatches& measured) {
  require_known(chart, measured);
  PatchColors colors = in_order(chart, measured).colors;
  for (Raw& raw : colors.raw)
    for (std::size_t k = 0; k < 3; ++k) raw[k] *= gains[k];
  return colors;
}

// Matrix from XYZ to the camera's values with the least error; empty if the patches do not determine it.
std::optional<Matrix3> to_camera(const PatchColors& colors) {
  try {
    const Matrix3 to_xyz = least_squares_matrix(colors);
    if (is_invertible(to_xyz)) return to_xyz.inverse(true);
  } catch (const Error&) {
    // Too few colours.
  }
  return std::nullopt;
}

bool is_neutral(const XYZ& xyz, const XYZ& white) {
  const Lab lab = xyz_to_lab(xyz, white);
  return std::hypot(lab[1], lab[2]) < kNeutralChroma;
}

// Values of the perfect diffuser from the neutral patches; not finite if there are none.
Raw diffuser_by_neutrals(const PatchColors& colors) {
  const std::optional<Matrix3> camera = to_camera(colors);
  Raw sum{};
  double weight = 0;
  for (std::size_t i = 0; i < colors.xyz.size(); ++i) {
    const double y = colors.xyz[i][1];
    if (!(y > 0 && is_neutral(colors.xyz[i], colors.white))) continue;  // black patches carry no information
    const Raw grey = camera ? multiply(*camera, colors.white) : Raw{1, 1, 1};
    const Raw tinged = camera ? multiply(*camera, colors.xyz[i]) : Raw{y, y, y};
    for (std::size_t k = 0; k < 3; ++k) sum[k] += colors.raw[i][k] * y * (y * grey[k] / tinged[k]);
    weight += y * y;
  }
  for (double& v : sum) v /= weight;
  return sum;
}

namespace fs = std::filesystem;

// Ideal filter from the text of its two wavelengths, such as "400-500".
Curve box_filter(const std::string& text) {
  const std::vector<std::string> ends = split(text, '-');
  const auto end = [&](std::size_t i) { return ends.size() == 2 ? parse_number(ends[i]).value_or(-1) : -1; };
  if (!(kMinWavelengthNm <= end(0) && end(0) < end(1) && end(1) <= kMaxWavelengthNm))
    throw Error(ErrorCode::usage, "--camera",
                fmt::format("expected bands low-high in nm within [{}, {}] (got {})", kMinWavelengthNm,
                            kMaxWavelengthNm, text));
  return band(end(0), end(1));
}

// Ideal filters from B to R, such as "400-500,500-600,600-700", returned in the order R, G, B.
std::vector<Channel> box_channels(const std::string& bands) {
  const std::vector<std::string> pieces = split(bands, ',');
  if (pieces.size() != 3)
    throw Error(ErrorCode::usage, "--camera", fmt::format("expected three bands (got {})", pieces.size()));
  return {energy_channel("R", box_filter(pieces[2])), energy_channel("G", box_filter(pieces[1])),
          energy_channel("B", box_filter(pieces[0]))};
}

// Channels of a camera that is given by a formula; empty for a table.
std::optional<std::vector<Channel>> formula_channels(const std::string& camera) {
  constexpr std::string_view kBox = "box:";
  if (camera.starts_with(kBox)) return box_channels(camera.substr(kBox.size()));
  if (camera == "observer:1931") return observer_channels(Observer::cie1931);
  if (camera == "observer:1964") return observer_channels(Observer::cie1964);
  return std::nullopt;
}

// Patches of all training tables.
Chart load_training(const CalibrationSource& source, Diagnostics& diagnostics) {
  Chart all{source.training, {}};
  if (source.training.empty()) return all;
  for (const std::string& name : split(source.training, ',')) {
    if (name == source.chart)
      throw Error(ErrorCode::usage, "--training",
                  fmt::format("got {}, which is the chart itself: the correction must be tested on patches "
                              "to which it was not fitted",
                              name));
    auto chart = load_chart(name, {}, diagnostics);
    if (chart) std::move(chart->patches.begin(), chart->patches.end(), std::back_inserter(all.patches));
  }
  return all;
}

template <typename T>
std::vector<std::string> names_of(const std::vector<T>& all, std::string T::*name) {
  std::vector<std::string> names;
  for (const T& one : all) names.push_back(one.*name);
  return names;
}

// Sorts elements that are named R, G and B into that order, which the columns of tables and the planes of
// pictures have. Leaves all others unchanged.
template <typename T>
std::vector<T> in_rgb_order(std::vector<T> all, std::string T::*name) {
  const auto order = rgb_order(names_of(all, name));
  if (!order) return all;
  std::vector<T> sorted;
  for (const std::size_t index : *order) sorted.push_back(std::move(all[index]));
  return sorted;
}

// Throws Error{input} unless the names are R, G and B, by which measured columns are matched.
template <typename T>
void require_rgb(const std::vector<T>& all, std::string T::*name, const char* what) {
  const std::vector<std::string> names = names_of(all, name);
  if (!rgb_order(names))
    throw Error(ErrorCode::input, what,
                fmt::format("has the channels {} (allowed with --measured R, G and B, its columns)",
                            fmt::join(names, ", ")));
}

// Throws Error{usage} if a table states its colours in another light than the requested one.
void require_light_of(const ChartTargets& chart, const NamedCurve& light) {
  const Chromaticity own = chromaticity(chart.white);
  const Chromaticity named = chromaticity(light.curve);
  const bool is_visible = own[0] > 0;  // otherwise the chromatic adaptation reports it
  if (is_visible && !is_same_white(own, named))
    throw Error(
        ErrorCode::usage, "--illuminant",
        fmt::format("got {} with the white ({:.4f}, {:.4f}), but the chart states its colours in a light "
                    "with the white ({:.4f}, {:.4f}): name that light, or use a chart of reflectances",
                    light.name, named[0], named[1], own[0], own[1]));
}

// Converts code values and their deviations to linear ones.
void linearise_all(MeasuredPatches& patches, const std::vector<ChannelResponse>& responses) {
  for (std::size_t i = 0; i < patches.values.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<double>& curve = responses[k].fit.linear;
      double& value = patches.values[i][k];
      if (!patches.deviations.empty())
        patches.deviations[i][k] = linearise_deviation(curve, value, patches.deviations[i][k]);
      value = linearise(curve, value);
    }
}

// Warns of a curve that does not follow its codes.
void warn_of_misfit(const ChannelResponse& response, const fs::path& series, Diagnostics& diagnostics) {
  const auto& misfit = response.fit.misfit;
  if (!misfit) return;
  const auto source = std::make_shared<const SourceText>(SourceText{series.string(), ""});
  diagnostics.warning(
      {source, SourcePosition::kWholeFile, ""},
      fmt::format("the curve of {} does not follow its codes: from {:.3g} to {:.3g} their exposures are off "
                  "by {:.2g} % of full scale, more than noise explains, and its 95 % interval is widened "
                  "there; at a knee, add exposures with codes near it",
                  response.channel, misfit->low_code, misfit->high_code, 100 * misfit->exposure));
}

}  // namespace

CameraCalibration calibrate_measured(const MeasuredCamera& camera, const CharacterisationOptions& options) {
  const bool is_trained = !camera.training.raw.empty();
  const auto& [chart, gains, deviations] = camera.chart;
  PatchColors colors = is_trained ? camera.training : chart;
  if (!is_trained && !deviations.empty()) colors.weights = noise_weights(colors, deviations);
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
  result.colors = chart;
  result.correction = fit_correction(colors, how);
  if (is_trained) {
    result.training_patches = colors.raw.size();
    result.correction.start = patch_errors(chart, white_preserving_least_squares(colors, how.model));
    result.unseen = result.correction.errors = patch_errors(chart, result.correction.correction);
  } else {
    result.unseen = cross_validate(colors, how, options.folds > 0 ? options.folds : colors.raw.size());
  }
  result.unseen_mean = bootstrap_mean(result.unseen.delta_e, options.bootstrap_draws);
  result.columns = bootstrap_columns(colors, how, options.bootstrap_draws);
  result.profile.light = camera.light;
  result.profile.description = valid_utf8(fmt::format("{} under {}", camera.name, camera.light));
  for (std::size_t k = 0; k < camera.responses.size(); ++k)
    result.profile.linearisation.at(k) = camera.responses[k].fit.linear;
  result.profile.gains = gains;
  result.profile.brightest_patch = brightest_patch(camera.chart);
  result.profile.correction = result.correction.correction;
  result.profile.adaptation = *to_d65;
  result.responses = camera.responses;
  return result;
}

bool choose_correction(CharacterisationOptions& options, std::string_view name) {
  const auto known = std::ranges::find(kCorrectionNames, name);
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
      setup.camera, setup.illuminant, {integrate(setup.chart, setup.channels, setup.light)}, {}};
  auto& [colors, gains, deviations] = camera.chart;
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
    for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.raw[i][k] = linear[i] / white;
    gains[k] = 1 / white;
  }
  CameraCalibration result = calibrate_measured(camera, options);
  result.times_s = times_s;
  for (std::size_t k = 0; k < 3; ++k) result.profile.channels[k] = setup.channels[k].name;
  return result;
}

BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured) {
  require_known(chart, measured);
  BalancedPatches balanced = in_order(chart, measured);
  const auto diffuser = measured.saturated.contains(kDiffuser) ? std::nullopt : find(measured, kDiffuser);
  const Raw white = diffuser ? measured.values[*diffuser] : diffuser_by_neutrals(balanced.colors);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::isfinite(white[k]) && white[k] > 0))
      throw Error(
          ErrorCode::input, "measured patches",
          fmt::format("nothing to balance white on: neither a row \"{}\" nor neutral patches", kDiffuser));
    balanced.gains[k] = 1 / white[k];
    for (Raw& raw : balanced.colors.raw) raw[k] /= white[k];
    for (Raw& deviation : balanced.deviations) deviation[k] /= white[k];
  }
  return balanced;
}

std::optional<std::vector<Channel>> camera_channels(const std::string& camera,
                                                    std::optional<ResponseKind> response,
                                                    Diagnostics& diagnostics) {
  if (auto channels = formula_channels(camera)) {
    if (response)
      throw Error(
          ErrorCode::usage, "camera response",
          fmt::format("applies to measured curves only (got {}, which has its own response)", camera));
    return channels;
  }
  auto channels = load_camera(camera, {}, diagnostics, response, ResponseScale::relative);
  if (channels) channels = in_rgb_order(*std::move(channels), &Channel::name);
  return channels;
}

CalibrationCase simulated_calibration(const CalibrationSource& source, const std::string& illuminant,
                                      Diagnostics& diagnostics) {
  const auto channels = camera_channels(source.camera, source.camera_response, diagnostics);
  const NeededRange needed = channels ? needed_by(*channels) : NeededRange();
  const auto light = load_illuminant(illuminant, {}, diagnostics, needed);
  if (channels && light) check_light_range(*light, *channels, {}, diagnostics);
  const auto chart = load_chart(source.chart, {}, diagnostics, kReflectanceFactorUse, needed);
  const auto test =
      source.test.empty() ? Chart{} : load_chart(source.test, {}, diagnostics, kReflectanceFactorUse, needed);
  const Chart training = load_training(source, diagnostics);
  require_no_errors(diagnostics);
  CalibrationCase calibration{source.camera, source.chart, source.planted_response, source.bits, {}, {}};
  calibration.result = calibrate_camera({source.camera, illuminant, source.planted_response, source.bits,
                                         *channels, light->curve, *chart, training},
                                        source.how);
  if (!source.test.empty())
    calibration.test =
        patch_errors(integrate(*test, *channels, light->curve), calibration.result.correction.correction);
  return calibration;
}

RecoveredResponses recover_responses(const fs::path& series, Inputs& inputs, Diagnostics& diagnostics) {
  const auto photographs = read_series(series, diagnostics, &inputs);
  require_no_errors(diagnostics);
  RecoveredResponses recovered{{}, photographs->full_scale};
  for (std::size_t k = 0; k < photographs->channels.size(); ++k) {
    recovered.channels.push_back({photographs->channels[k], recover_response(photographs->series[k]), {}});
    warn_of_misfit(recovered.channels.back(), series, diagnostics);
  }
  return recovered;
}

CalibrationCase measured_calibration(const CalibrationSource& source, const std::string& illuminant,
                                     Inputs& inputs, Diagnostics& diagnostics) {
  const bool is_tested = !source.test_measured.empty();
  const auto light = load_illuminant(illuminant, {}, diagnostics);
  const auto chart = light ? load_chart_targets(source.chart, light->curve, {}, diagnostics) : std::nullopt;
  const auto test =
      light && is_tested ? load_chart_targets(source.test, light->curve, {}, diagnostics) : std::nullopt;
  auto patches = load_measured_patches(source.measured, diagnostics);
  auto test_patches = is_tested ? load_measured_patches(source.test_measured, diagnostics) : std::nullopt;
  const Chart training = load_training(source, diagnostics);
  std::optional<std::vector<Channel>> channels;
  if (!training.patches.empty())
    channels = camera_channels(source.camera, source.camera_response, diagnostics);
  require_no_errors(diagnostics);
  require_light_of(*chart, *light);
  if (test) require_light_of(*test, *light);
  if (channels) require_rgb(*channels, &Channel::name, "--camera");
  MeasuredCamera camera{source.measured.stem().string(), illuminant, {}, {}};
  if (!source.series.empty()) {
    RecoveredResponses recovered = recover_responses(source.series, inputs, diagnostics);
    require_rgb(recovered.channels, &ChannelResponse::channel, "--series");
    camera.responses = in_rgb_order(std::move(recovered.channels), &ChannelResponse::channel);
    const auto make_linear = [&](MeasuredPatches& values, const fs::path& file) {
      scale_to_codes(values, recovered.full_scale, file);
      linearise_all(values, camera.responses);
    };
    make_linear(*patches, source.measured);
    if (test_patches) make_linear(*test_patches, source.test_measured);
  } else if (patches->unit == kCodeValues) {
    warn_of_codes(source.measured, "measure raw files, or give a --series", diagnostics);
  }
  camera.chart = balance(*chart, *patches);
  if (channels) camera.training = integrate(training, *channels, light->curve);
  CalibrationCase calibration{camera.name, source.chart, "", 0, calibrate_measured(camera, source.how), {}};
  if (test)
    calibration.test = patch_errors(balanced_by(camera.chart.gains, *test, *test_patches),
                                    calibration.result.correction.correction);
  return calibration;
}

}  // namespace abbe
