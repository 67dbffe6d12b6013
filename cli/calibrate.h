#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "calibration/camera_calibration.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Options of `abbe calibrate`.
struct CalibrateOptions : CalibrationSource {
  bool all_cameras = false;  ///< Print the quality of a calibration for every shipped camera instead.
  /// Name of an illuminant; for a simulated camera also several names separated by commas.
  std::string illuminants = "D65";
  std::filesystem::path transfer{};  ///< Answer of `abbe transfer --json` for the page; empty for none.
  std::filesystem::path mtf{};       ///< Answer of `abbe mtf --json` for the page; empty for none.
  std::filesystem::path output;  ///< Folder for the OpenColorIO configuration and the report; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();  ///< Maximum memory of photographs.
  bool json = false;                                      ///< Print the answer as JSON instead of plain text.
};

/// Calibrates a camera on a colour chart, prints CIEDE2000 per patch and writes the configuration. Several
/// illuminants also give the matrices of DNG. A series without measured values only recovers the response of
/// a real camera. Returns 0.
/// Throws Error{usage} unless exactly one kind of camera is given: `camera`, `all_cameras`, or `measured` and
/// `series`. Throws it also for options without effect, for an illuminant named twice, and for an output that
/// is an input. Throws otherwise as `simulated_calibration`, `measured_calibration` and `write_ocio_config`.
int calibrate(const CalibrateOptions& options);

}  // namespace abbe::cli
