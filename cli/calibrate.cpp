#include "cli/calibrate.h"

#include <cstdio>

#include <fmt/format.h>

#include "calibration/camera_calibration.h"
#include "cli/answer.h"
#include "io/error.h"
#include "io/text.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe::cli {
namespace {

// "400-500": the two wavelengths of an ideal filter.
Curve box_filter(const std::string& text) {
  const std::vector<std::string> ends = split(text, '-');
  const auto end = [&](std::size_t i) { return ends.size() == 2 ? parse_number(ends[i]).value_or(-1) : -1; };
  if (!(kMinWavelengthNm <= end(0) && end(0) < end(1) && end(1) <= kMaxWavelengthNm))
    throw Error(ErrorCode::usage, "--camera",
                fmt::format("expected bands low-high in nm within [{}, {}] (got {})", kMinWavelengthNm,
                            kMaxWavelengthNm, text));
  return band(end(0), end(1));
}

// "400-500,500-600,600-700": ideal filters from B to R, in the order R, G, B.
std::vector<Channel> box_channels(const std::string& bands) {
  const std::vector<std::string> pieces = split(bands, ',');
  if (pieces.size() != 3)
    throw Error(ErrorCode::usage, "--camera", fmt::format("expected three bands (got {})", pieces.size()));
  return {energy_channel("R", box_filter(pieces[2])), energy_channel("G", box_filter(pieces[1])),
          energy_channel("B", box_filter(pieces[0]))};
}

std::optional<std::vector<Channel>> camera_channels(const std::string& camera, Diagnostics& diagnostics) {
  constexpr std::string_view kBox = "box:";
  if (camera.starts_with(kBox)) return box_channels(camera.substr(kBox.size()));
  if (camera == "observer:1931") return observer_channels(Observer::cie1931);
  if (camera == "observer:1964") return observer_channels(Observer::cie1964);
  return load_camera(camera, {}, diagnostics);
}

CalibrationSetup load_setup(const CalibrateOptions& options) {
  Diagnostics diagnostics;
  const std::optional<std::vector<Channel>> channels = camera_channels(options.camera, diagnostics);
  const std::optional<NamedCurve> light = load_illuminant(options.illuminant, {}, diagnostics);
  const std::optional<Chart> chart = load_chart(options.chart, {}, diagnostics);
  check(diagnostics);
  return {options.camera, options.illuminant, options.planted_response, options.bits, *channels, light->curve,
          *chart};
}

void print_table(const CalibrationSetup& setup, const CameraCalibration& calibration) {
  fmt::print("{} under {}, chart {}, {} bits\n\n", setup.camera, setup.illuminant, setup.chart.name,
             setup.bits);
  fmt::print("{:<10}{:>22}{:>14}{:>9}\n", "channel", "response error [%]", "residual [%]", "samples");
  for (const ChannelResponse& r : calibration.responses)
    fmt::print("{:<10}{:>22.4f}{:>14.4f}{:>9}\n", r.channel, 100 * r.max_error, 100 * r.fit.median_code,
               r.fit.samples);
  const MatrixFit& fit = calibration.matrix;
  fmt::print("\n{:<28}{:>10}{:>16}\n", "patch", "dE2000", "least squares");
  for (std::size_t i = 0; i < calibration.patches.size(); ++i)
    fmt::print("{:<28}{:>10.4f}{:>16.4f}\n", calibration.patches[i], fit.errors.delta_e[i],
               fit.start.delta_e[i]);
  fmt::print("{:<28}{:>10.4f}{:>16.4f}\n", "mean", fit.errors.mean, fit.start.mean);
  fmt::print("{:<28}{:>10.4f}{:>16.4f}\n", "max", fit.errors.max, fit.start.max);
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  const CalibrationSetup setup = load_setup(options);
  const CameraCalibration calibration = calibrate_camera(setup);
  if (!options.output.empty()) write_calibration(options.output, setup, calibration);
  if (options.json)
    fmt::print("{}", report_json(setup, calibration));
  else
    print_table(setup, calibration);
  return 0;
}

}  // namespace abbe::cli
