#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/chart/matrix3.h"

namespace abbe {

/// What OpenColorIO needs to know of a camera.
struct CameraProfile {
  std::string description;  ///< One line: which camera, under which light.
  /// Per channel the linear exposure of code i/(size - 1), all of one size; empty when the camera's values
  /// are linear.
  std::array<std::vector<double>, 3> linearisation;
  Matrix3 to_xyz_d65;  ///< Linear camera values to XYZ relative to a D65 white.
};

/// Names in the configuration.
inline constexpr const char* kCameraSpace = "Camera";
inline constexpr const char* kDisplay = "sRGB";
inline constexpr const char* kView = "Plain";
inline constexpr const char* kCurveFile = "camera.spi1d";  ///< The linearisation, three components.
inline constexpr const char* kClfFile = "camera.clf";      ///< Linearisation and matrix in one.

/// An OpenColorIO version 2 configuration: reference space linear XYZ-D65; colour spaces Camera (file
/// transform of kCurveFile if there is a linearisation, then the matrix), linear Rec.709 and ACES2065-1;
/// display sRGB with the view Plain, which neither tone-maps nor clips. Throws Error{internal}
/// with OpenColorIO's words.
[[nodiscard]] std::string ocio_config_text(const CameraProfile& profile);

/// Writes config.ocio, the curve and the CLF into `folder`, creating it; config.ocio last, after OpenColorIO
/// has validated it and built the display transform from the files beside it. Throws Error{output} when the
/// folder cannot be written or OpenColorIO objects, as it does when $OCIO_ACTIVE_DISPLAYS names displays of
/// another configuration.
void write_ocio_config(const std::filesystem::path& folder, const CameraProfile& profile);

}  // namespace abbe
