#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Imath/ImathVec.h>

namespace abbe {

/// A picture as people look at it: red, green and blue of each pixel, row by row.
struct ByteImage {
  int width = 0;
  int height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// A ColorChecker of 24 patches in a picture.
struct FoundChart {
  /// The outer corners of its top left, top right, bottom right and bottom left patch's cell [pixels].
  std::array<Imath::V2d, 4> corners;
  double misfit = 0;  ///< Of its colours, the smaller the more it looks like one.
};

/// What the module that finds charts offers: OpenCV, which some seventy packages bring, is there with it.
struct ChartFinder {
  /// The chart that looks most like one; nothing where there is none.
  std::optional<FoundChart> (*find)(const ByteImage& picture);
};

/// The name under which the module exports a function that returns a `const ChartFinder*`.
inline constexpr const char* kChartFinderSymbol = "abbe_chart_finder";

}  // namespace abbe
