#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "calibration/camera_calibration.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Options of `abbe calibrate`, which its help explains.
struct CalibrateOptions : CalibrationSource {
  bool all_cameras = false;
  std::string illuminants = "D65";  ///< Several, separated by commas, for a simulated camera only.
  std::filesystem::path transfer{};
  std::filesystem::path mtf{};
  std::filesystem::path output;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Calibrates a camera on a colour chart, prints CIEDE2000 per patch and writes the configuration. Several
/// illuminants also give the matrices of DNG. A series without measured values only recovers the response of
/// a real camera.
/// Throws Error{usage} unless exactly one kind of camera is given: `camera`, `all_cameras`, or `measured` and
/// `series`. Throws it also for options without effect, for an illuminant named twice, and for an output that
/// is an input. Throws otherwise as `simulated_calibration`, `measured_calibration` and `write_ocio_config`.
void calibrate(const CalibrateOptions& options);

}  // namespace abbe::cli
