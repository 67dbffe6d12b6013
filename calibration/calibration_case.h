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
struct CalibrationSource {
  std::string camera;  ///< Name or formula, as `camera_channels` takes it.
  /// File with the values that a real camera recorded of the chart's patches.
  std::filesystem::path measured;
  std::filesystem::path series;  ///< Listing of a real camera's photographs with their exposure times.
  std::string chart = "colorchecker24_babelcolor_average";
  std::string test;  ///< Another chart, on which the fitted correction is tested.
  /// Tables of reflectances, separated by commas, to which the correction is fitted instead.
  std::string training;
  /// "linear", "gamma:G" or "s-curve"; if empty, the camera is known to be linear.
  std::string planted_response;
  int bits = 12;
  CharacterisationOptions how;
  /// Quantity that the camera's responses multiply; empty for that of the table.
  std::optional<ResponseKind> camera_response = {};
};

/// A calibration with the inputs that it was requested for.
struct CalibrationCase {
  std::string camera;
  std::string chart;
  std::string response;  ///< Planted response; empty for a measured camera.
  int bits = 0;
  CameraCalibration result;
  std::optional<PatchErrors> test;  ///< Errors on the test chart, if there is one.
};

/// Channels of a camera: a name in `data/camera`, a file, ideal filters "box:a-b,c-d,e-f" [nm] from blue to
/// red, "observer:1931" or "observer:1964". Channels R, G and B (or red, green and blue) are returned in this
/// order, as tables and pictures have them. Reports an unknown name in `diagnostics`. Throws Error{usage} for
/// impossible bands, and for a `response` of filters and observers, which have their own.
[[nodiscard]] std::optional<std::vector<Channel>> camera_channels(const std::string& camera,
                                                                  std::optional<ResponseKind> response,
                                                                  Diagnostics& diagnostics);

/// Calibrates the simulated camera of `source` under `illuminant`. Adds warnings to `diagnostics`. Throws as
/// `calibrate_camera`, and InvalidInput for unknown names.
[[nodiscard]] CalibrationCase simulated_calibration(const CalibrationSource& source,
                                                    const std::string& illuminant, Diagnostics& diagnostics);
/// Calibrates the real camera that photographed the chart under `illuminant`. If `source.series` is set, the
/// response curves of that series first make its values linear. Adds the files that it reads to `inputs`.
/// Throws as `simulated_calibration`, and Error{input} if the channels of the camera or of the photographs
/// are not those of the measured values.
[[nodiscard]] CalibrationCase measured_calibration(const CalibrationSource& source,
                                                   const std::string& illuminant, Inputs& inputs,
                                                   Diagnostics& diagnostics);

/// Response curves of a real camera's channels, recovered from a series of photographs.
struct RecoveredResponses {
  std::vector<ChannelResponse> channels;
  FullScale full_scale = {};  ///< Full scale of the codes to which the curves apply.
};
/// Recovers the response curves from a listing of photographs. Warns of curves that do not follow their
/// codes. Throws InvalidInput for a series that cannot be read, Error{input} for one that does not determine
/// a curve.
[[nodiscard]] RecoveredResponses recover_responses(const std::filesystem::path& series, Inputs& inputs,
                                                   Diagnostics& diagnostics);

}  // namespace abbe
