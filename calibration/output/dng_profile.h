#pragma once

#include <optional>
#include <string>

#include "calibration/chart/matrix3.h"
#include "calibration/output/camera_profile.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// What a DNG file tells of a camera under one light [DNG, ch. 6].
struct DngLight {
  std::string light;
  int code;       ///< CalibrationIlluminant: the light's number in EXIF, 255 for others.
  double kelvin;  ///< Correlated colour temperature of its white.
  Matrix3 color;  ///< ColorMatrix: XYZ, not adapted, to linear camera values, scaled so that white reaches 1.
  Matrix3 forward;  ///< ForwardMatrix: camera values balanced on the light to XYZ relative to D50.
};

/// The matrices of a profile, from the XYZ of its light's white (Y = 1). Nothing for a root polynomial, and
/// for a light without a colour temperature.
[[nodiscard]] std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white);

/// The forward matrix of a light between two: linear in 1/T, held beyond them [DNG, ch. 6].
[[nodiscard]] Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin);

/// The white that DNG's matrices lead to, as ICC profiles state it.
[[nodiscard]] inline XYZ dng_white() {
  return {0.9642, 1, 0.8249};
}

}  // namespace abbe
