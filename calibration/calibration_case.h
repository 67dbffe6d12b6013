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

/// What a calibration is made of: a camera whose curves are known, or photographs of a real one.
struct CalibrationSource {
  std::string camera;              ///< As `camera_channels` takes it.
  std::filesystem::path measured;  ///< Values of a real camera's photograph of the chart.
  std::filesystem::path series;    ///< Photographs of a real camera with their exposure times.
  std::string chart = "colorchecker24_babelcolor_average";
  std::string test;      ///< Another chart that the fitted correction is tried on.
  std::string training;  ///< Reflectances that the correction is fitted to instead, with commas between.
  std::string planted_response;  ///< "linear", "gamma:G" or "s-curve"; empty: linear, and known to be.
  int bits = 12;
  CharacterisationOptions how;
  std::optional<ResponseKind> camera_response = {};  ///< What the camera's curves multiply, where it is told.
};

/// One calibration and what was asked of it.
struct CalibrationCase {
  std::string camera;
  std::string chart;
  std::string response;  ///< The planted one; empty for a measured camera.
  int bits = 0;
  CameraCalibration result;
  std::optional<PatchErrors> test;  ///< Of another chart.
};

/// The channels of a camera of `data/camera` or of a file, of ideal filters "box:a-b,c-d,e-f" [nm] from blue
/// to red, or of an "observer:1931" or "observer:1964". R, G and B, or red, green and blue, come in this
/// order, whatever that of the file: so tables and pictures have them. Reports a name that is none of these;
/// throws Error{usage} for bands that cannot be, and for a response of what has its own, as filters and
/// observers do.
[[nodiscard]] std::optional<std::vector<Channel>> camera_channels(const std::string& camera,
                                                                  std::optional<ResponseKind> response,
                                                                  Diagnostics& diagnostics);

/// Calibrates the camera of the source, simulated in a light; adds warnings to `diagnostics`. Throws as
/// `calibrate_camera`, and InvalidInput for unknown names.
[[nodiscard]] CalibrationCase simulated_calibration(const CalibrationSource& source,
                                                    const std::string& illuminant, Diagnostics& diagnostics);
/// Calibrates the real camera that photographed the chart in that light; by `series`, if there is one, its
/// values are made linear before. The files that are read are added to `inputs`. Throws as above, and
/// Error{input} where the channels of the camera or of the photographs are not those of the measured values.
[[nodiscard]] CalibrationCase measured_calibration(const CalibrationSource& source,
                                                   const std::string& illuminant, Inputs& inputs,
                                                   Diagnostics& diagnostics);

/// The curves of a real camera's channels, of a series of photographs.
struct RecoveredResponses {
  std::vector<ChannelResponse> channels;
  FullScale full_scale = {};  ///< Of which they are.
};
/// Throws InvalidInput for a series that cannot be read, Error{input} for one that determines no curve.
[[nodiscard]] RecoveredResponses recover_responses(const std::filesystem::path& series, Inputs& inputs,
                                                   Diagnostics& diagnostics);

}  // namespace abbe
