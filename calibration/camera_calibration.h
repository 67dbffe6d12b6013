#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/chart/exposure_series.h"
#include "calibration/chart/patches.h"
#include "calibration/fit/matrix.h"
#include "calibration/fit/response.h"
#include "calibration/output/ocio.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"

namespace abbe {

/// What a simulated calibration starts from.
struct CalibrationSetup {
  std::string camera;
  std::string illuminant;
  std::string planted_response;  ///< See PlantedResponse.
  int bits = 12;                 ///< Of the code values, 1 to 16; 0 for no rounding.
  std::vector<Channel> channels;
  Curve light;
  Chart chart;
};

/// One channel's recovered curve, judged by the response that was planted.
struct ChannelResponse {
  std::string channel;
  ResponseFit fit;
  double max_error = 0;  ///< Largest error of linear exposure between 1 % and 99 % of the code range, as a
                         ///< share of full scale.
};

/// A camera, calibrated.
struct CameraCalibration {
  std::vector<std::string> patches;
  std::vector<double> times_s;
  std::array<ChannelResponse, 3> responses;
  MatrixFit matrix;
  CameraProfile profile;
};

/// The whole chain on integrated colours: the chart and a white tile photographed through the planted
/// response at exposures one third of a stop apart; each channel's curve recovered from that series without
/// knowing the response or the patches; the brightest unclipped photograph linearised by the recovered
/// curves, balanced on the tile, and the white-preserving matrix fitted to it. Errors per patch are therefore
/// those of curve, code values and matrix together. Throws Error{usage} for bits out of range or a camera
/// without three channels, Error{input} when a fit fails.
[[nodiscard]] CameraCalibration calibrate_camera(const CalibrationSetup& setup);

/// The calibration as one JSON object: names, times, response and matrix fits with their costs, CIEDE2000 per
/// patch.
[[nodiscard]] std::string report_json(const CalibrationSetup& setup, const CameraCalibration& calibration);

/// Writes the OpenColorIO configuration and `report.json` into `folder`.
void write_calibration(const std::filesystem::path& folder, const CalibrationSetup& setup,
                       const CameraCalibration& calibration);

}  // namespace abbe
