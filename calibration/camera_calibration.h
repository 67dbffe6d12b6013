#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/chart/exposure_series.h"
#include "calibration/chart/measured_patches.h"
#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "calibration/fit/resampling.h"
#include "calibration/fit/response.h"
#include "calibration/output/camera_profile.h"
#include "calibration/output/color_spaces.h"
#include "io/diagnostics.h"
#include "io/inputs.h"
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
  bool choose = false;        ///< Choose the model by `cross_validate_models` instead of using that of `fit`.
  int bootstrap_draws = 200;  ///< Draws for all 95 % intervals, at least 1.
};

/// Selects the correction model by its name; "auto" selects the one with the least cross-validation error.
/// Returns false and changes nothing for an unknown name.
[[nodiscard]] bool choose_correction(CharacterisationOptions& options, std::string_view name);

/// Calibration of a camera under one light.
struct CameraCalibration {
  /// Exposure times of a simulated camera's series, a single 1 if it is linear; empty for measured values.
  std::vector<double> times_s;
  /// One per channel; empty for a camera whose values are linear.
  std::vector<ChannelResponse> responses;
  PatchColors colors;  ///< White-balanced values and true colours of the chart, in the order of all errors.
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
/// Errors per patch therefore include those of curve, code values and correction. Throws as
/// `calibrate_measured` and `integrate`, and Error{usage} for bits out of range and an unknown planted
/// response.
[[nodiscard]] CameraCalibration calibrate_camera(const CalibrationSetup& setup,
                                                 const CharacterisationOptions& options = {});

/// White-balanced values with the colours of their chart, in its order without excluded patches.
struct BalancedPatches {
  PatchColors colors;
  std::array<double, 3> gains{1, 1, 1};  ///< Factors from linear to balanced values, one per channel.
  /// Standard deviations of the balanced values, one per patch of `colors`; empty: unknown.
  std::vector<Raw> deviations = {};
};

/// Inputs of a real camera's calibration.
struct MeasuredCamera {
  std::string name;
  std::string light;                       ///< Name of the light.
  BalancedPatches chart;                   ///< Deviations weight the patches in the fit.
  std::vector<ChannelResponse> responses;  ///< Curves that linearised the values: three, or none.
  /// Patches in the same light to which the correction is fitted instead of the chart, if there are any.
  PatchColors training = {};
};

/// Fits the correction to measured values, and validates it. Throws Error{usage} for too few patches for a
/// root polynomial, and for folds outside 2 to the number of patches. Throws Error{input} if a fit fails, if
/// the patches do not determine the correction, and if chromatic adaptation from the light's white to D65 is
/// impossible.
[[nodiscard]] CameraCalibration calibrate_measured(const MeasuredCamera& camera,
                                                   const CharacterisationOptions& options = {});

/// Balances measured values on the patch named "perfect diffuser", if there is one. Otherwise it uses the
/// value of the perfect diffuser that best fits the chart's neutral patches (chroma below 5), weighted by
/// luminance. These patches are not exactly neutral. The least-squares matrix of all patches corrects for
/// their tinge if the patches determine one.
///
/// Every patch of the chart must have been measured, and no other. Patches with saturated pixels are
/// excluded. Throws Error{input} for an unknown patch and for missing ones, with their names. Throws it also
/// if less than half of the patches remain, and if there is nothing to balance on.
[[nodiscard]] BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured);

/// Inputs of a calibration of a simulated or a real camera. Texts and paths that do not apply are empty.
struct CalibrationSource {
  /// Camera as `camera_channels` takes it; for a real camera only with `training`.
  std::string camera;
  /// Table of the values that a real camera recorded of the patches, for `load_measured_patches`.
  std::filesystem::path measured;
  /// Listing of a real camera's photographs with their exposure times, for `read_series`.
  std::filesystem::path series;
  /// Chart to photograph: a table of `data/reflectance` or a file.
  std::string chart = "colorchecker24_babelcolor_average";
  std::string test;  ///< Another chart, on which the fitted correction is tested.
  /// Table like `measured`, of the patches of `test` in the same light at the same exposure.
  std::filesystem::path test_measured = {};
  /// Tables of reflectances, separated by commas, to which the correction is fitted instead. A real camera
  /// then also needs `camera`, whose responses give the raw values.
  std::string training;
  /// Description of a simulated camera's PlantedResponse. If empty, the camera is linear, and its response is
  /// not recovered.
  std::string planted_response;
  int bits = 12;  ///< Bits of a simulated camera's codes, 1 to 16; 0 for no rounding.
  CharacterisationOptions how;
  /// Quantity that the camera's responses multiply; empty for that of the table.
  std::optional<ResponseKind> camera_response = {};
};

/// A calibration with the inputs that it was requested for.
struct CalibrationCase {
  /// Name or formula; for measured values the name of their file without extension.
  std::string camera;
  std::string chart;
  std::string response;  ///< Planted response; empty for a real or a linear camera.
  int bits = 0;          ///< Bits of a simulated camera's codes; 0 for a real camera or no rounding.
  CameraCalibration result;
  std::optional<PatchErrors> test;  ///< Errors on the test chart; empty without one.
};

/// Channels of a camera. `camera` is a name in `data/camera`, a file, ideal filters "box:a-b,c-d,e-f" [nm]
/// from blue to red, "observer:1931" or "observer:1964". Channels R, G and B (or red, green and blue) are
/// returned in this order. Others keep the order of their table. `response` is the quantity that the
/// responses multiply; without it the table decides (`load_camera`). Returns nothing after an error in
/// `diagnostics`, such as an unknown name. Throws Error{usage} for impossible bands, and for a `response` of
/// filters and observers, which have their own.
[[nodiscard]] std::optional<std::vector<Channel>> camera_channels(const std::string& camera,
                                                                  std::optional<ResponseKind> response,
                                                                  Diagnostics& diagnostics);

/// Calibrates the simulated camera of `source` under `illuminant`, a name of `data/illuminant` or a formula.
/// Adds warnings to `diagnostics`. Throws as `calibrate_camera` and `camera_channels`, InvalidInput for
/// unknown names and invalid tables, and Error{usage} if the chart is among the training tables.
[[nodiscard]] CalibrationCase simulated_calibration(const CalibrationSource& source,
                                                    const std::string& illuminant, Diagnostics& diagnostics);
/// Calibrates the real camera that photographed the chart under `illuminant`. If `source.series` is set, the
/// response curves of that series first make its values linear. Otherwise values count as linear, with a
/// warning for code values. Adds the photographs that it reads to `inputs`, and warnings to `diagnostics`.
/// Throws InvalidInput for unknown names and invalid tables. Throws Error{usage} if a table states the
/// chart's colours in another light, or if the chart is among the training tables. Throws Error{input} if the
/// channels of the camera or of the photographs are not R, G and B. Throws also as `recover_responses`,
/// `scale_to_codes`, `balance` and `calibrate_measured`. A test chart is balanced by the gains of the chart.
[[nodiscard]] CalibrationCase measured_calibration(const CalibrationSource& source,
                                                   const std::string& illuminant, Inputs& inputs,
                                                   Diagnostics& diagnostics);

/// Response curves of a real camera's channels, recovered from a series of photographs.
struct RecoveredResponses {
  std::vector<ChannelResponse> channels;  ///< In the order of the photographs.
  FullScale full_scale = {};              ///< Full scale of the codes to which the curves apply.
};
/// Recovers the response curves from a listing of photographs (`read_series`), whose files are added to
/// `inputs`. Warns of curves that do not follow their codes. Throws InvalidInput for an invalid listing.
/// Throws Error{input} if a photograph cannot be read or the series does not determine a curve,
/// Error{resource} if a photograph is too large.
[[nodiscard]] RecoveredResponses recover_responses(const std::filesystem::path& series, Inputs& inputs,
                                                   Diagnostics& diagnostics);

}  // namespace abbe
