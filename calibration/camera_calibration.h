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

/// What a simulated calibration starts from.
struct CalibrationSetup {
  std::string camera;
  std::string illuminant;
  /// See PlantedResponse; empty for a camera whose values are linear and known to be.
  std::string planted_response;
  int bits = 12;  ///< Of the code values, 1 to 16; 0 for no rounding.
  std::vector<Channel> channels;
  Curve light;
  Chart chart;
  Chart training = {};  ///< What the correction is fitted to instead of the chart, if it has patches.
};

/// One channel's recovered curve, judged by the response that was planted, if one was.
struct ChannelResponse {
  std::string channel;
  ResponseFit fit;
  std::optional<double> max_error;  ///< Largest error of linear exposure between 1 % and 99 % of the code
                                    ///< range, as a share of full scale.
};

/// How a camera's colours are fitted and judged.
struct CharacterisationOptions {
  CorrectionOptions fit;
  Adaptation adaptation = Adaptation::bradford;  ///< From the light's white to D65.
  std::size_t folds = 0;  ///< Of the cross-validation; 0 leaves one patch out at a time.
  bool choose = false;    ///< Take the model that shows unseen patches best instead of that of `fit`.
  BootstrapOptions bootstrap;
};

/// Fits the model of that name, or, for "auto", the one that shows unseen patches best. False, and nothing
/// done, for another name.
[[nodiscard]] bool choose_correction(CharacterisationOptions& options, std::string_view name);

/// A camera, calibrated under one light.
struct CameraCalibration {
  std::vector<std::string> patches;
  std::vector<double> times_s;             ///< Of the exposure series.
  std::vector<ChannelResponse> responses;  ///< None for a camera whose values are linear.
  PatchColors colors;                      ///< Of the chart, white balanced.
  CorrectionFit correction;                ///< Its errors are those of the chart.
  std::vector<ModelCandidate> candidates;  ///< Among which the model was chosen; none when it was given.
  std::size_t training_patches = 0;        ///< Other than the chart's, to which the correction was fitted.
  PatchErrors unseen;                      ///< Each patch shown by a fit that has not seen it.
  Interval unseen_mean;  ///< 95 % of the mean of `unseen`, the patches being drawn at random.
  std::vector<std::array<Interval, 3>> columns;  ///< 95 % of the correction's columns.
  CameraProfile profile;
};

/// The whole chain on integrated colours: the chart and a white tile photographed in whole codes, linear
/// ones; or through the planted response at exposures one third of a stop apart, each channel's curve
/// recovered from that series without knowing the response or the patches; the brightest unclipped photograph
/// linearised by the recovered curves, balanced on the tile, and the white-preserving correction fitted to
/// it. Errors per patch are therefore those of curve, code values and correction together. Throws
/// Error{usage} for bits out of range, a camera without three channels or a chart too small for the
/// correction, Error{input} when a fit fails.
[[nodiscard]] CameraCalibration calibrate_camera(const CalibrationSetup& setup,
                                                 const CharacterisationOptions& options = {});

/// What a real camera's calibration starts from.
struct MeasuredCamera {
  std::string name;
  std::string light;
  PatchColors colors;                      ///< White balanced, linear.
  std::array<double, 3> gains{1, 1, 1};    ///< What balanced them.
  std::vector<ChannelResponse> responses;  ///< What made them linear: three, or none.
  /// What the correction is fitted to instead of `colors`, in the same light; none without patches.
  PatchColors training = {};
  /// Standard deviations of the values of `colors`, by which its patches are weighed; empty: all alike.
  std::vector<Raw> deviations = {};
};

/// Fits the correction to measured values. Throws as `calibrate_camera`.
[[nodiscard]] CameraCalibration calibrate_measured(const MeasuredCamera& camera,
                                                   const CharacterisationOptions& options = {});

}  // namespace abbe
