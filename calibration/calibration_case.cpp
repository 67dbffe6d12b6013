#include "calibration/calibration_case.h"

#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/photographed_series.h"
#include "calibration/fit/balance.h"
#include "calibration/output/color_spaces.h"
#include "io/diagnostics.h"
#include "io/error.h"
#include "io/image.h"
#include "io/text.h"
#include "sensor/response/table_range.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

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
  const auto light = load_illuminant(illuminant, {}, diagnostics);
  const auto chart = light ? load_chart_targets(source.chart, light->curve, {}, diagnostics) : std::nullopt;
  auto patches = load_measured_patches(source.measured, diagnostics);
  const Chart training = load_training(source, diagnostics);
  std::optional<std::vector<Channel>> channels;
  if (!training.patches.empty())
    channels = camera_channels(source.camera, source.camera_response, diagnostics);
  require_no_errors(diagnostics);
  require_light_of(*chart, *light);
  if (channels) require_rgb(*channels, &Channel::name, "--camera");
  MeasuredCamera camera{source.measured.stem().string(), illuminant, {}, {}, {}};
  if (!source.series.empty()) {
    RecoveredResponses recovered = recover_responses(source.series, inputs, diagnostics);
    require_rgb(recovered.channels, &ChannelResponse::channel, "--series");
    camera.responses = in_rgb_order(std::move(recovered.channels), &ChannelResponse::channel);
    scale_to_codes(*patches, recovered.full_scale, source.measured);
    linearise_all(*patches, camera.responses);
  } else if (patches->unit == kCodeValues) {
    warn_of_codes(source.measured, "measure raw files, or give a --series", diagnostics);
  }
  const BalancedPatches balanced = balance(*chart, *patches);
  camera.colors = balanced.colors;
  camera.gains = balanced.gains;
  camera.deviations = balanced.deviations;
  if (channels) camera.training = integrate(training, *channels, light->curve);
  return {camera.name, source.chart, "", 0, calibrate_measured(camera, source.how), {}};
}

}  // namespace abbe
