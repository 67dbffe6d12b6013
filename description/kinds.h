#pragma once

#include <ImathVec.h>

#include "io/schema/fields.h"
#include "spectral/curve.h"

// What the tables of the scene file share.
namespace abbe::spec {

/// Lengths and coordinates, in scene units: beyond this the floats of the render overflow when squared and
/// multiplied.
inline constexpr double kMaxLength = 1e12;
inline constexpr Range kCoordinate = Range{-kMaxLength, kMaxLength}.in("units");
inline constexpr Range kLength{0, kMaxLength, true, false, "units"};
/// Values of curves and powers, safely inside float.
inline constexpr Range kValue{-1e30, 1e30};
inline constexpr Range kPower{0, 1e30};
inline constexpr Range kAngle = kValue.in("degrees");
inline constexpr Range kExposure{0, 1e9, true, false, "s"};
/// Wavelengths of a table's samples: wide enough for tables beyond the rendered range, too high for
/// micrometres.
inline constexpr Range kTableWavelength = Range{100, 1e5}.in("nm");
inline constexpr Range kWavelength = Range{kMinWavelengthNm, kMaxWavelengthNm}.in("nm");

/// A direction of any length but zero, as an Imath::V3d.
[[nodiscard]] inline schema::Kind direction() {
  return schema::vector<Imath::V3d>(kCoordinate, true);
}

}  // namespace abbe::spec
