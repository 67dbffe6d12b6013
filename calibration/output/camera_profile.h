#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/fit/correction.h"
#include "io/raw_picture.h"
#include "sensor/response/channel.h"
#include "spectral/colorimetry.h"
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

/// Matrices of a DNG file for a camera under one light [DNG, ch. 6].
struct DngMatrices {
  /// ColorMatrix: from unadapted XYZ to linear camera values, scaled so that the largest value of white is 1.
  Matrix3 color;
  Matrix3 forward;  ///< ForwardMatrix: from camera values balanced on the light to XYZ relative to D50.
  /// AsShotNeutral of a picture in this light: the camera values of white, the largest of which is 1.
  std::array<double, 3> neutral;
};

/// Matrices of a camera, from the matrix `to_xyz` of its linear values to XYZ under a light with this white
/// (Y = 1). Empty for a matrix without an inverse, and for a white that is not positive in every channel.
/// Empty also if chromatic adaptation to the white is impossible.
[[nodiscard]] std::optional<DngMatrices> dng_matrices(const Matrix3& to_xyz, const XYZ& white);

/// Calibration of a camera under one light, as a DNG file records it.
struct DngLight {
  std::string light;  ///< Name of the light.
  int code;           ///< CalibrationIlluminant: the light's number in Exif, 255 for others.
  double kelvin;      ///< Correlated colour temperature of its white [K].
  Matrix3 color;      ///< ColorMatrix, scaled as in `DngMatrices`.
  Matrix3 forward;    ///< ForwardMatrix, as in `DngMatrices`.
};

/// Matrices of a profile, from the XYZ of its light's white (Y = 1). Empty for a root polynomial, for a light
/// without a colour temperature, and if `dng_matrices` is.
[[nodiscard]] std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white);

/// Reorders the light of a profile, whose channels are R, G and B, for a sensor that may have them in another
/// order. The light is unchanged for channels of other names.
[[nodiscard]] RawLight light_for(std::span<const std::string> channels, const RawLight& light);

/// Forward matrix for a colour temperature T = `kelvin` [K] between two lights: linear in 1/T, constant
/// outside [DNG, ch. 6]. The order of the lights has no effect.
[[nodiscard]] Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin);

/// White of DNG's profile connection space, D50 as ICC profiles state it, with Y = 1.
[[nodiscard]] inline XYZ dng_white() {
  return {0.9642, 1, 0.8249};
}

/// Exif light source number [Exif] of an illuminant by its name in the data directory, aliases included. It
/// knows A, B, C, D50, D55, D65, D75 and the CIE's fluorescent lights (FL1, F1, FL3.7 ...), which Exif
/// classifies by colour temperature. Other names, and all tables of users, give 255 (other light).
[[nodiscard]] int exif_light_source(const std::string& name);

/// Exif light source number of the illuminant with this chromaticity (`is_same_white`), 255 if there is none.
/// Standard illuminants are tried first, then FL1 to FL12.
[[nodiscard]] int exif_light_source(const Chromaticity& white);

/// Spectral sensitivities of a camera as JSON text for rawtoaces and physlight, which fit ACES input
/// transforms to them. Contains the name `camera` and energy responses every 5 nm from 380 to 780 nm, with a
/// maximum of 1 over all channels, one of which must respond there. `read_camera_json` reads it.
[[nodiscard]] std::string sensitivities_json(const std::string& camera, std::span<const Channel> channels);

}  // namespace abbe
