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

/// How a DNG file tells the colours of a camera under one light [DNG, ch. 6].
struct DngMatrices {
  Matrix3 color;  ///< ColorMatrix: XYZ, not adapted, to linear camera values, scaled so that white reaches 1.
  Matrix3 forward;  ///< ForwardMatrix: camera values balanced on the light to XYZ relative to D50.
  std::array<double, 3> neutral;  ///< AsShotNeutral of a picture in this light: what white becomes.
};

/// The matrices of a camera whose linear values `to_xyz` takes to XYZ under a light with this white (Y = 1).
/// Nothing for a matrix without an inverse, a white that no eye adapts to, and one that is not positive in
/// every channel.
[[nodiscard]] std::optional<DngMatrices> dng_matrices(const Matrix3& to_xyz, const XYZ& white);

/// What calibration says of a camera under one light.
struct DngLight {
  std::string light;
  int code;         ///< CalibrationIlluminant: the light's number in Exif, 255 for others.
  double kelvin;    ///< Correlated colour temperature of its white.
  Matrix3 color;    ///< As in `DngMatrices`.
  Matrix3 forward;  ///< As in `DngMatrices`.
};

/// The matrices of a profile, from the XYZ of its light's white (Y = 1). Nothing for a root polynomial, and
/// for a light without a colour temperature.
[[nodiscard]] std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white);

/// The light of a profile, which has R, G and B in this order, for a sensor with these channels, which may be
/// the same in another.
[[nodiscard]] RawLight light_for(std::span<const std::string> channels, const RawLight& light);

/// The forward matrix of a light between two: linear in 1/T, held beyond them [DNG, ch. 6].
[[nodiscard]] Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin);

/// The white that DNG's matrices lead to, as ICC profiles state it.
[[nodiscard]] inline XYZ dng_white() {
  return {0.9642, 1, 0.8249};
}

}  // namespace abbe
