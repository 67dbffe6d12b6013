#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "calibration/output/camera_profile.h"
#include "io/raw_picture.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Colour matrices of a DNG file for a camera under one light [DNG, ch. 6].
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

}  // namespace abbe
