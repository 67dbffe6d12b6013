#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/stokes_film.h"

namespace abbe {

/// A picture of how light is polarised.
struct PolarisationMap {
  std::string name;
  Image map;
};

/// Names of the maps there are.
inline constexpr const char* kDegreeMap = "degree";
inline constexpr const char* kLinearDegreeMap = "linear_degree";
inline constexpr const char* kAngleMap = "angle";

/// Which part of the Stokes vector is known.
enum class Measured { all, linear };

/// The degree, if all of it is known, and the degree of linear polarisation, from 0 (dark) to 1, by
/// `map_color`, and the angle by `cyclic_color`, half a turn being a cycle, which is grey where the light is
/// not linearly polarised.
[[nodiscard]] std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                                             Measured measured, int width, int height);

}  // namespace abbe
