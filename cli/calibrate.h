#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "calibration/camera_calibration.h"
#include "io/inputs.h"

namespace abbe::cli {

/// What `abbe calibrate` was asked for.
struct CalibrateOptions {
  std::string camera;  ///< A camera of `data/camera` or a file, "box:a-b,c-d,e-f" [nm] for ideal filters, or
                       ///< "observer:1931" / "observer:1964".
  bool all_cameras = false;
  std::filesystem::path measured;   ///< Values of a real camera's photograph of the chart.
  std::filesystem::path series;     ///< Photographs of a real camera with their exposure times.
  std::string illuminants = "D65";  ///< One name, or for `camera` several with commas between them.
  std::string chart = "colorchecker24_babelcolor_average";
  std::string test;      ///< Another chart that the fitted correction is tried on.
  std::string training;  ///< Reflectances that the correction is fitted to instead, with commas between.
  std::string planted_response;  ///< "linear", "gamma:G" or "s-curve"; empty: linear, and known to be.
  int bits = 12;
  CharacterisationOptions how;
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
