#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/chart/exposure_series.h"
#include "calibration/chart/patches.h"
#include "calibration/fit/correction_fit.h"
#include "calibration/fit/resampling.h"
#include "calibration/fit/response.h"
#include "calibration/output/camera_profile.h"
#include "calibration/output/color_spaces.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"

namespace abbe {

/// Inputs of a simulated calibration.
struct CalibrationSetup {
  std::string camera;
  std::string illuminant;
  /// Description of a PlantedResponse; empty for a camera whose values are known to be linear.
  std::string planted_response;
  int bits = 12;  ///< Bits of the code values, 1 to 16; 0 for no rounding.
  std::vector<Channel> channels;
  Curve light;
  Chart chart;
  Chart training = {};  ///< Patches to which the correction is fitted instead of the chart, if there are any.
};

/// Recovered response curve of one channel, compared with the planted response if there was one.
struct ChannelResponse {
  std::string channel;
  ResponseFit fit;
  /// Largest error of linear exposure between 1 % and 99 % of the code range, as a fraction of full scale.
  std::optional<double> max_error;
};

/// Options of the colour correction and of its validation.
struct CharacterisationOptions {
  CorrectionOptions fit;
  Adaptation adaptation = Adaptation::bradford;  ///< Chromatic adaptation from the light's white to D65.
  std::size_t folds = 0;  ///< Folds of the cross-validation; 0 leaves one patch out at a time.
  bool choose = false;  ///< Choose the model with the least cross-validation error instead of that of `fit`.
  BootstrapOptions bootstrap;
};

/// Selects the correction model by its name; "auto" selects the one with the least cross-validation error.
/// Returns false and changes nothing for an unknown name.
[[nodiscard]] bool choose_correction(CharacterisationOptions& options, std::string_view name);

/// Calibration of a camera under one light.
struct CameraCalibration {
  std::vector<std::string> patches;
  std::vector<double> times_s;             ///< Exposure times of the series.
  std::vector<ChannelResponse> responses;  ///< Empty for a camera whose values are linear.
  PatchColors colors;                      ///< White-balanced colours of the chart.
  CorrectionFit correction;                ///< Fitted correction with its errors on the chart.
  std::vector<ModelCandidate> candidates;  ///< Models that were compared; empty if the model was given.
  /// Number of patches, other than the chart's, to which the correction was fitted.
  std::size_t training_patches = 0;
  PatchErrors unseen;    ///< Cross-validation errors: each patch is predicted by a fit without it.
  Interval unseen_mean;  ///< 95 % interval of the mean of `unseen`, for patches drawn at random.
  std::vector<std::array<Interval, 3>> columns;  ///< 95 % intervals of the correction's columns.
  CameraProfile profile;
};

/// Simulates the whole calibration on integrated colours of the chart and a white tile.
///
/// - A linear camera photographs them once, in whole codes.
/// - Otherwise a series is exposed through the planted response, in steps of one third of a stop. The curve
///   of each channel is recovered from that series, without knowledge of the response or the patches. The
///   curves linearise the brightest photograph that is not clipped.
/// - The values are balanced on the tile, and the white-preserving correction is fitted to them.
///
/// Errors per patch therefore include those of curve, code values and correction. Throws Error{usage} for
/// bits out of range, for a camera without three channels and for a chart too small for the correction.
/// Throws Error{input} if a fit fails.
[[nodiscard]] CameraCalibration calibrate_camera(const CalibrationSetup& setup,
                                                 const CharacterisationOptions& options = {});

/// Inputs of a real camera's calibration.
struct MeasuredCamera {
  std::string name;
  std::string light;
  PatchColors colors;                      ///< Linear, white-balanced values of the chart.
  std::array<double, 3> gains{1, 1, 1};    ///< Factors that balanced them.
  std::vector<ChannelResponse> responses;  ///< Curves that linearised them: three, or none.
  /// Patches in the same light to which the correction is fitted instead of `colors`, if there are any.
  PatchColors training = {};
  /// Standard deviations of the values of `colors`, which weight its patches; empty for equal weights.
  std::vector<Raw> deviations = {};
};

/// Fits the correction to measured values. Throws as `calibrate_camera`.
[[nodiscard]] CameraCalibration calibrate_measured(const MeasuredCamera& camera,
                                                   const CharacterisationOptions& options = {});

}  // namespace abbe
