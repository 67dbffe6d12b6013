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
  std::string camera;      ///< Name of the camera, for the profile and for messages.
  std::string illuminant;  ///< Name of the light, for the profile and for messages.
  /// Description of a PlantedResponse; empty for a camera whose values are known to be linear.
  std::string planted_response;
  int bits = 12;                  ///< Bits of the code values, 1 to 16; 0 for no rounding.
  std::vector<Channel> channels;  ///< Three channels; their order is that of all values.
  Curve light;                    ///< Spectral power of the light on any scale.
  Chart chart;
  Chart training = {};  ///< Patches to which the correction is fitted instead of the chart, if there are any.
};

/// Recovered response curve of one channel.
struct ChannelResponse {
  std::string channel;
  ResponseFit fit;
  /// Largest error of linear exposure between 1 % and 99 % of the code range, as a fraction of full scale.
  /// Empty without a planted response to compare with.
  std::optional<double> max_error;
};

/// Options of the colour correction and of its validation.
struct CharacterisationOptions {
  CorrectionOptions fit;
  Adaptation adaptation = Adaptation::bradford;  ///< Chromatic adaptation from the light's white to D65.
  /// Folds of the cross-validation, at least 2; 0 leaves one patch out at a time.
  std::size_t folds = 0;
  bool choose = false;  ///< Choose the model by `cross_validate_models` instead of using that of `fit`.
  BootstrapOptions bootstrap;
};

/// Selects the correction model by its name; "auto" selects the one with the least cross-validation error.
/// Returns false and changes nothing for an unknown name.
[[nodiscard]] bool choose_correction(CharacterisationOptions& options, std::string_view name);

/// Calibration of a camera under one light.
struct CameraCalibration {
  std::vector<std::string> patches;  ///< Names of the chart's patches, in the order of all errors.
  /// Exposure times of a simulated camera's series, a single 1 if it is linear; empty for measured values.
  std::vector<double> times_s;
  /// One per channel; empty for a camera whose values are linear.
  std::vector<ChannelResponse> responses;
  PatchColors colors;  ///< White-balanced values and true colours of the chart.
  /// Fitted correction. All its errors are those on the chart, also with training patches.
  CorrectionFit correction;
  /// Models that were compared, the chosen one first; empty if the model was given.
  std::vector<ModelCandidate> candidates;
  /// Number of patches, other than the chart's, to which the correction was fitted; 0 without training.
  std::size_t training_patches = 0;
  /// Errors of patches that the fit did not use. They are those of the chart if there are training patches,
  /// otherwise those of a cross-validation: each patch is predicted by a fit without it.
  PatchErrors unseen;
  Interval unseen_mean;  ///< 95 % interval of the mean of `unseen`, for patches drawn at random.
  /// 95 % intervals of `correction.correction.columns`: those of X, Y and Z for each term, by bootstrap.
  std::vector<std::array<Interval, 3>> columns;
  CameraProfile profile;  ///< Conversion that the calibration found, for the outputs.
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
/// - bits out of range, and an unknown planted response;
/// - a camera without three channels;
/// - a chart too small for a root polynomial, and folds outside 2 to its number of patches.
///
/// Throws Error{input} if
/// - a fit fails, or the patches do not determine a matrix;
/// - a channel receives nothing from the light;
/// - chromatic adaptation from the light's white to D65 is impossible.
[[nodiscard]] CameraCalibration calibrate_camera(const CalibrationSetup& setup,
                                                 const CharacterisationOptions& options = {});

/// Inputs of a real camera's calibration.
struct MeasuredCamera {
  std::string name;                        ///< Name of the camera, for the profile.
  std::string light;                       ///< Name of the light, for the profile and for messages.
  PatchColors colors;                      ///< Linear, white-balanced values of the chart.
  std::array<double, 3> gains{1, 1, 1};    ///< Factors from linear to balanced values, one per channel.
  std::vector<ChannelResponse> responses;  ///< Curves that linearised them: three, or none.
  /// Patches in the same light to which the correction is fitted instead of `colors`, if there are any.
  PatchColors training = {};
  /// Standard deviations of the values of `colors`, which weight its patches; empty for equal weights. Not
  /// used with `training`.
  std::vector<Raw> deviations = {};
};

/// Fits the correction to measured values, and validates it. Throws Error{usage} for too few patches for a
/// root polynomial, and for folds outside 2 to the number of patches. Throws Error{input} if a fit fails, if
/// the patches do not determine the correction, and if chromatic adaptation from the light's white to D65 is
/// impossible.
[[nodiscard]] CameraCalibration calibrate_measured(const MeasuredCamera& camera,
                                                   const CharacterisationOptions& options = {});

}  // namespace abbe
