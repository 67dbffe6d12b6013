#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/fit/correction.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Conversion of one camera's values under one light to colour.
struct CameraProfile {
  std::string light;        ///< Name of the light, which distinguishes the profiles of one camera.
  std::string description;  ///< One line: camera and light.
  /// Linear exposure of code i/(size - 1) for each channel, all of one size. Empty if the camera's values are
  /// linear.
  std::array<std::vector<double>, 3> linearisation;
  /// White balance: factors from linear values to the input of the correction.
  std::array<double, 3> gains{1, 1, 1};
  ColorCorrection correction;  ///< Correction of balanced values to XYZ relative to the light's white.
  Matrix3 adaptation;          ///< Adaptation of the corrected XYZ to a D65 white.
  std::array<std::string, 3> channels{"R", "G", "B"};  ///< Names of the camera's values.
  /// Largest linear value of a patch of the calibration, before white balance.
  double brightest_patch = 0;
};

/// Linear camera values of the perfect diffuser, which map to the white with Y = 1. They define the scale of
/// the camera's values.
[[nodiscard]] inline Raw white_values(const CameraProfile& profile) {
  return {1 / profile.gains[0], 1 / profile.gains[1], 1 / profile.gains[2]};
}

/// Converts linear camera values to XYZ relative to a D65 white, with Y = 1 for the perfect diffuser.
[[nodiscard]] inline XYZ to_xyz_d65(const CameraProfile& profile, const Raw& linear) {
  return multiply(profile.adaptation, profile.correction(multiply(diagonal(profile.gains), linear)));
}

/// Matrix from linear camera values to XYZ relative to D65, for a profile with a linear correction. Terms of
/// a root polynomial other than R, G and B are left out.
[[nodiscard]] inline Matrix3 matrix_to_xyz_d65(const CameraProfile& profile) {
  return profile.adaptation * linear_part(profile.correction) * diagonal(profile.gains);
}

}  // namespace abbe
