#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Imath/ImathVec.h>

namespace abbe {

/// A display-encoded 8-bit picture: red, green and blue of each pixel, row by row from the top.
struct ByteImage {
  int width = 0;
  int height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// A ColorChecker of 24 patches in a picture.
struct FoundChart {
  /// Outer corners of the cells of the top left, top right, bottom right and bottom left patch, as the chart
  /// is read. Positions are in pixels from the top left corner of the picture, with y downwards.
  std::array<Imath::V2d, 4> corners;
  /// Dissimilarity of its colours from those of a ColorChecker, on the detector's own scale; smaller is
  /// better.
  double misfit = 0;
};

/// Functions of the chart detector module. OpenCV is linked to the module alone, because it depends on some
/// seventy packages.
struct ChartFinder {
  /// Finds the most similar chart; empty if there is none. It uses a single thread.
  std::optional<FoundChart> (*find)(const ByteImage& picture);
};

/// Symbol of the module's function that returns a `const ChartFinder*`.
inline constexpr const char* kChartFinderSymbol = "abbe_chart_finder";

}  // namespace abbe
