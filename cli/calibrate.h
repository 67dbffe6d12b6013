#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "calibration/calibration_case.h"
#include "io/inputs.h"

namespace abbe::cli {

/// What `abbe calibrate` was asked for.
struct CalibrateOptions : CalibrationSource {
  bool all_cameras = false;
  std::string illuminants = "D65";   ///< One name, or for `camera` several with commas between them.
  std::filesystem::path transfer{};  ///< What `abbe transfer --json` and
  std::filesystem::path mtf{};       ///< `abbe mtf --json` have answered, for the page; empty: nothing.
  std::filesystem::path
      output;  ///< Folder for the OpenColorIO configuration and the report; nothing is written when empty.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Calibrates a camera on a colour chart, prints CIEDE2000 per patch, and writes the configuration; with
/// several lights, also the matrices of DNG. Or prints how well every shipped camera can be calibrated; or
/// recovers the response of a real one. Returns the exit code.
int calibrate(const CalibrateOptions& options);

}  // namespace abbe::cli
