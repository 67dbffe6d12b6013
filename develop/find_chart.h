#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Imath/ImathVec.h>

#include "sensor/film/patch.h"

namespace abbe {

struct LinearImage;

/// Finds a ColorChecker of 24 patches, in any orientation, by the chart detector module. The detector needs
/// red, green and blue: channels R, G, B or X, Y, Z if the image has them. Otherwise the first, central and
/// last channel are tried in order of wavelength and in reverse; a grey image uses its one channel. Returns
/// the corners that `outlines_between` takes, accurate to a pixel or two. Throws Error{input} if there is no
/// chart or the module is missing.
[[nodiscard]] std::array<Imath::V2d, 4> find_chart(const LinearImage& image);

/// Outlines of a chart's patches in an image, from the four corners of its grid of patches. Positions are in
/// pixels from the top left corner of the image, y downwards. The corners are the top left, top right, bottom
/// right and bottom left one as the chart is read, clockwise in the image. The grid has one cell per name,
/// row by row, with `columns` > 0 cells per row. Cells include the gaps, so the corners lie half a gap
/// outside the corner patches. Each outline is the central 0.6 of its cell in width and height, projected in
/// perspective [Heckbert1989]. Throws Error{usage} unless the corners form a convex quadrilateral in that
/// order, and if `columns` does not divide the number of patches.
[[nodiscard]] std::vector<PatchOutline> outlines_between(const std::array<Imath::V2d, 4>& corners,
                                                         std::span<const std::string> names,
                                                         std::size_t columns);

/// A display-encoded 8-bit picture: red, green and blue of each pixel, row by row from the top.
struct ByteImage {
  int width = 0;
  int height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;
};

/// A ColorChecker of 24 patches in a picture.
struct FoundChart {
  std::array<Imath::V2d, 4> corners;  ///< Corners as `outlines_between` takes them.
  /// Dissimilarity of its colours from those of a ColorChecker, on the detector's own scale.
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
