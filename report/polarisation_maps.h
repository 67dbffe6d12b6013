#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/film_planes.h"

namespace abbe {

/// False-colour picture of a property of polarisation.
struct PolarisationMap {
  std::string name;  ///< One of the names below.
  Image map;         ///< Channels R, G and B with sRGB code values in [0, 1].
};

/// Names of the available maps.
inline constexpr const char* kDegreeMap = "degree";
inline constexpr const char* kLinearDegreeMap = "linear_degree";
inline constexpr const char* kAngleMap = "angle";

/// Components of the Stokes vector that were measured: I, Q, U and V (`all`), or I, Q and U (`linear`).
enum class MeasuredStokes { all, linear };

/// Maps of the degree of polarisation (if `measured` is `all`), the degree of linear polarisation and the
/// angle, in this order. `pixels` contains one value per pixel of a picture of `width` x `height`, row by
/// row. Degrees use `map_color` from 0 (dark) to 1. Angles use `cyclic_color` with a period of 180 degrees,
/// and the degree of linear polarisation as its strength. Light without linear polarisation is therefore
/// grey.
[[nodiscard]] std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                                             MeasuredStokes measured, int width, int height);

}  // namespace abbe
