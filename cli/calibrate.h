#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "calibration/calibration_case.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Options of `abbe calibrate`.
struct CalibrateOptions : CalibrationSource {
  bool all_cameras = false;
  /// Name of an illuminant; for `camera` also several names separated by commas.
  std::string illuminants = "D65";
  std::filesystem::path transfer{};  ///< Answer of `abbe transfer --json` for the page; empty for none.
  std::filesystem::path mtf{};       ///< Answer of `abbe mtf --json` for the page; empty for none.
  std::filesystem::path output;  ///< Folder for the OpenColorIO configuration and the report; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Calibrates a camera on a colour chart, prints CIEDE2000 per patch and writes the configuration. Several
/// illuminants also give the matrices of DNG. Other options print the quality of a calibration for every
/// shipped camera, or recover the response of a real camera. Returns the exit code.
int calibrate(const CalibrateOptions& options);

}  // namespace abbe::cli
