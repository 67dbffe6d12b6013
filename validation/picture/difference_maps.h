#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "validation/statistics/image_difference.h"

namespace abbe {

/// False-colour picture of the differences of two images, on a scale from 0 (dark) to `high` (bright).
struct DifferenceMap {
  std::string name;
  double high;
  Image map;        ///< Picture of the images' size.
  Image histogram;  ///< Histogram of the differences; its bars have the colours of the map.
};

/// Names of the available maps.
inline constexpr const char* kRelativeErrorMap = "relative_error";
inline constexpr const char* kDeltaEMap = "delta_e";

/// Maps of the relative error and, if given, of the colour difference. Each scale ends at the first 1, 2 or 5
/// times a power of ten that exceeds the 99th percentile.
[[nodiscard]] std::vector<DifferenceMap> difference_maps(const std::vector<double>& relative_errors,
                                                         const std::optional<ColorDifference>& color,
                                                         int width, int height);

/// Histogram of values from 0 to `high` with 64 bars and a labelled scale. The last bar includes all larger
/// values.
[[nodiscard]] Image histogram_picture(const std::vector<double>& values, double high);

}  // namespace abbe
