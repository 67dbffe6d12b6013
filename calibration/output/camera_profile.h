#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/fit/correction.h"
#include "spectral/matrix3.h"

namespace abbe {

/// How one camera's values under one light become colour.
struct CameraProfile {
  std::string light;        ///< Name of the light: what tells the profiles of one camera apart.
  std::string description;  ///< One line: which camera, under which light.
  /// Per channel the linear exposure of code i/(size - 1), all of one size; empty when the camera's values
  /// are linear.
  std::array<std::vector<double>, 3> linearisation;
  std::array<double, 3> gains{1, 1, 1};  ///< White balance: from linear to the values the correction takes.
  ColorCorrection correction;            ///< To XYZ relative to the light's white.
  Matrix3 adaptation;                    ///< From there to XYZ relative to a D65 white.
  std::array<std::string, 3> channels{"R", "G", "B"};  ///< Names of the camera's values.
  double brightest_patch = 0;  ///< The largest linear value of a patch that was calibrated.
};

/// Linear camera values of the perfect diffuser, which become XYZ of the white with Y = 1: the scale in which
/// values are to be given.
[[nodiscard]] inline Raw white_values(const CameraProfile& profile) {
  return {1 / profile.gains[0], 1 / profile.gains[1], 1 / profile.gains[2]};
}

/// Linear camera values to XYZ relative to a D65 white.
[[nodiscard]] inline XYZ to_xyz_d65(const CameraProfile& profile, const Raw& linear) {
  return multiply(profile.adaptation, profile.correction(multiply(diagonal(profile.gains), linear)));
}

/// The matrix from white-balanced raw values to XYZ under D65, of a profile whose correction is linear.
[[nodiscard]] inline Matrix3 matrix_to_xyz_d65(const CameraProfile& profile) {
  return profile.adaptation * linear_part(profile.correction) * diagonal(profile.gains);
}

}  // namespace abbe
