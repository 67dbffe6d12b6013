#pragma once

#include <filesystem>
#include <string>

namespace abbe::cli {

/// What `abbe calibrate` was asked for.
struct CalibrateOptions {
  std::string camera;  ///< A camera of `data/camera` or a file, "box:a-b,c-d,e-f" [nm] for ideal filters, or
                       ///< "observer:1931" / "observer:1964".
  std::string illuminant = "D65";
  std::string chart = "colorchecker24_babelcolor_average";
  std::string planted_response = "gamma:2.2";  ///< "linear", "gamma:G" or "s-curve".
  int bits = 12;
  std::filesystem::path
      output;  ///< Folder for the OpenColorIO configuration and the report; nothing is written when empty.
  bool json = false;
};

/// Calibrates a camera on a chart, prints CIEDE2000 per patch, and writes the configuration. Returns the exit
/// code.
int calibrate(const CalibrateOptions& options);

}  // namespace abbe::cli
