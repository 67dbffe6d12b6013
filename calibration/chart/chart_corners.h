#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sensor/film/patch.h"

namespace abbe {

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

}  // namespace abbe
