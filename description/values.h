#pragma once

#include <optional>
#include <string_view>

#include <ImathVec.h>

#include "description/load_context.h"
#include "io/object_reader.h"
#include "spectral/curve.h"

namespace abbe::description {

/// Lengths and coordinates, in scene units: beyond this the floats of the render overflow when squared and
/// multiplied.
inline constexpr double kMaxLength = 1e12;
inline constexpr Range kCoordinate{-kMaxLength, kMaxLength};
inline constexpr Range kLength{0, kMaxLength, true, false};
/// Values of curves and powers, safely inside float.
inline constexpr Range kValue{-1e30, 1e30};
inline constexpr Range kPower{0, 1e30};
inline constexpr Range kExposure{0, 1e9, true, false};  ///< [s]
inline constexpr Range kWavelength{kMinWavelengthNm, kMaxWavelengthNm};

/// A position or edge [m].
[[nodiscard]] std::optional<Imath::V3d> read_point(ObjectReader& reader, std::string_view key,
                                                   const LoadContext& context);
/// A unit vector; the zero vector is reported.
[[nodiscard]] std::optional<Imath::V3d> read_direction(ObjectReader& reader, std::string_view key,
                                                       const LoadContext& context);

}  // namespace abbe::description
