#pragma once

#include <ImathVec.h>

#include "io/schema/fields.h"
#include "spectral/curve.h"

// Value ranges that the key tables of the scene file have in common. The arguments of `Range` are its lower
// and upper end, then true for each end that is excluded, then the unit.
namespace abbe::spec {

/// Largest length or coordinate, in scene units. Larger values overflow in single precision when squared and
/// multiplied.
inline constexpr double kMaxLength = 1e12;
inline constexpr Range kCoordinate = Range{-kMaxLength, kMaxLength}.in("units");
inline constexpr Range kLength{0, kMaxLength, true, false, "units"};  ///< (0, kMaxLength]
// Values of curves and angles, and values that are not negative, such as powers. Single precision holds them
// safely.
inline constexpr Range kValue{-1e30, 1e30};
inline constexpr Range kPower{0, 1e30};
inline constexpr Range kAngle = kValue.in("degrees");
inline constexpr Range kExposure{0, 1e9, true, false, "s"};  ///< Exposure times: (0, 1e9] s.
/// Wavelengths of table samples. The range admits tables that extend past the rendered wavelengths, and
/// excludes values in micrometres.
inline constexpr Range kTableWavelength = Range{100, 1e5}.in("nm");
/// Wavelengths that Abbe renders: [300, 1100] nm.
inline constexpr Range kWavelength = Range{kMinWavelengthNm, kMaxWavelengthNm}.in("nm");

/// The form in which scene files write a direction: an Imath::V3d of any length except zero. It is not
/// normalised.
[[nodiscard]] inline schema::ValueType direction() {
  return schema::vector<Imath::V3d>(kCoordinate, true);
}

}  // namespace abbe::spec
