#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera_calibration.h"
#include "calibration/chart/measured_patches.h"
#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// Inputs of a calibration: a camera whose spectral responses are known, or photographs of a real camera.
/// Texts and paths that do not apply are empty.
struct CalibrationSource {
  /// Camera as `camera_channels` takes it; for a real camera only with `training`.
  std::string camera;
  /// Table of the values that a real camera recorded of the chart's patches, as `load_measured_patches` reads
  /// it.
  std::filesystem::path measured;
  /// Listing of a real camera's photographs with their exposure times, as `read_series` reads it.
  std::filesystem::path series;
  /// Chart to photograph: a table of `data/reflectance` or a file.
  std::string chart = "colorchecker24_babelcolor_average";
  std::string test;  ///< Another chart, on which the fitted correction of a simulated camera is tested.
  /// Tables of reflectances, separated by commas, to which the correction is fitted instead. A real camera
  /// then also needs `camera`, whose responses give the raw values.
  std::string training;
  /// Response of a simulated camera: "linear", "gamma:G" or "s-curve". If empty, the camera is linear, and
  /// its response is not recovered.
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
/// Adds warnings to `diagnostics`.
/// Throws as `calibrate_camera` and `camera_channels`, and InvalidInput for unknown names and invalid tables.
/// Throws Error{usage} if the chart is among the training tables, and Error{input} if a channel receives
/// nothing from the light.
[[nodiscard]] CalibrationCase simulated_calibration(const CalibrationSource& source,
                                                    const std::string& illuminant, Diagnostics& diagnostics);
/// Calibrates the real camera that photographed the chart under `illuminant`. If `source.series` is set, the
/// response curves of that series first make its values linear. Otherwise values count as linear, with a
/// warning for code values. Adds the photographs that it reads to `inputs`, and warnings to `diagnostics`.
/// Throws InvalidInput for unknown names and invalid tables. Throws Error{usage} if a table states the
/// chart's colours in another light, or if the chart is among the training tables. Throws Error{input} if the
/// channels of the camera or of the photographs are not R, G and B. Throws also as `recover_responses`,
/// `scale_to_codes`, `balance` and `calibrate_measured`.
[[nodiscard]] CalibrationCase measured_calibration(const CalibrationSource& source,
                                                   const std::string& illuminant, Inputs& inputs,
                                                   Diagnostics& diagnostics);

/// Response curves of a real camera's channels, recovered from a series of photographs.
struct RecoveredResponses {
  /// One response per channel, in the order of the photographs.
  std::vector<ChannelResponse> channels;
  FullScale full_scale = {};  ///< Full scale of the codes to which the curves apply.
};
/// Recovers the response curves from a listing of photographs (`read_series`), whose files are added to
/// `inputs`. Warns of curves that do not follow their codes. Throws InvalidInput for an invalid listing.
/// Throws Error{input} if a photograph cannot be read or the series does not determine a curve,
/// Error{resource} if a photograph is too large.
[[nodiscard]] RecoveredResponses recover_responses(const std::filesystem::path& series, Inputs& inputs,
                                                   Diagnostics& diagnostics);

}  // namespace abbe
