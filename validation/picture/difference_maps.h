#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "validation/statistics/image_difference.h"

namespace abbe {

/// A picture of how two images differ, its colours from 0 (dark) to `high` (bright).
struct DifferenceMap {
  std::string name;
  double high;
  Image map;        ///< Of the images' size.
  Image histogram;  ///< How many pixels differ by how much; its bars have the colours of the map.
};

/// Names of the maps there are.
inline constexpr const char* kRelativeErrorMap = "relative_error";
inline constexpr const char* kDeltaEMap = "delta_e";

/// The relative error, and the colour difference of images that have one. The scales end at the first of 1,
/// 2, 5 times a power of ten beyond what 99 % of the pixels have.
[[nodiscard]] std::vector<DifferenceMap> difference_maps(const std::vector<double>& relative_errors,
                                                         const std::optional<ColorDifference>& color,
                                                         int width, int height);

/// Bars of a histogram of values from 0 to `high`, 64 of them, with a scale of five numbers below; what is
/// beyond counts in the last bar.
[[nodiscard]] Image histogram_picture(const std::vector<double>& values, double high);

}  // namespace abbe
