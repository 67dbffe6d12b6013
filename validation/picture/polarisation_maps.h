#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/stokes_film.h"

namespace abbe {

/// False-colour picture of a property of polarisation.
struct PolarisationMap {
  std::string name;
  Image map;
};

/// Names of the available maps.
inline constexpr const char* kDegreeMap = "degree";
inline constexpr const char* kLinearDegreeMap = "linear_degree";
inline constexpr const char* kAngleMap = "angle";

/// Components of the Stokes vector that were measured.
enum class MeasuredStokes { all, linear };

/// Maps of the degree of polarisation (if `measured` is `all`), the degree of linear polarisation and the
/// angle. Degrees use `map_color` from 0 (dark) to 1. Angles use `cyclic_color` with a period of half a turn,
/// so that light without linear polarisation is grey.
[[nodiscard]] std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                                             MeasuredStokes measured, int width, int height);

}  // namespace abbe
