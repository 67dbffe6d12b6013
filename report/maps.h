#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "report/image_difference.h"
#include "sensor/film/film_planes.h"

namespace abbe {

/// False-colour picture of the differences of two images, on a scale from 0 (dark) to `high` (bright), in
/// sRGB code values.
struct DifferenceMap {
  std::string name;  ///< `kRelativeErrorMap` or `kDeltaEMap`.
  double high;       ///< End of the scale, in the unit of the differences.
  Image map;
  Image histogram;  ///< `histogram_picture` of the differences.
};

/// Names of the available maps.
inline constexpr const char* kRelativeErrorMap = "relative_error";
inline constexpr const char* kDeltaEMap = "delta_e";

/// Maps of the relative error and, if given, of the colour difference, in this order. Both contain one value
/// per pixel of a picture of `width` x `height`, row by row. Each scale ends at the first 1, 2 or 5 times a
/// power of ten that exceeds the 99th percentile. The end is clamped to [1e-3, 1e5], and is 1 if the
/// percentile is not positive.
[[nodiscard]] std::vector<DifferenceMap> difference_maps(const std::vector<double>& relative_errors,
                                                         const std::optional<ColorDifference>& color,
                                                         int width, int height);

/// Histogram of values from 0 to `high` with 64 bars and a labelled scale. The bars have the colours of
/// `map_color`; their heights are proportional to the counts. The last bar includes all larger values, the
/// first one negative values. Needs at least one value, none of them NaN, and `high` > 0. The picture has 584
/// x 252 pixels.
[[nodiscard]] Image histogram_picture(const std::vector<double>& values, double high);

/// False-colour picture of a property of polarisation in sRGB code values.
struct PolarisationMap {
  std::string name;  ///< One of the names below.
  Image map;
};

/// Names of the available maps.
inline constexpr const char* kDegreeMap = "degree";
inline constexpr const char* kLinearDegreeMap = "linear_degree";
inline constexpr const char* kAngleMap = "angle";

/// Measured components of the Stokes vector: I, Q, U and V (`all`), or I, Q and U (`linear`).
enum class MeasuredStokes { all, linear };

/// Maps of the degree of polarisation (if `measured` is `all`), the degree of linear polarisation and the
/// angle, in this order. `pixels` contains one value per pixel of a picture of `width` x `height`, row by
/// row. Degrees use `map_color` from 0 (dark) to 1. Angles use `cyclic_color` with a period of 180 degrees,
/// and the degree of linear polarisation as its strength.
[[nodiscard]] std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                                             MeasuredStokes measured, int width, int height);

}  // namespace abbe
