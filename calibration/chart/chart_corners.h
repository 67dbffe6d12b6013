#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sensor/film/patch.h"

namespace abbe {

/// Outlines of a chart's patches in an image, from the positions [pixels] of the centers of its four corner
/// patches. These are the top left, top right, bottom right and bottom left patch, as the chart is read.
/// Patches fill an even grid row by row, with `columns` patches per row. Each outline is the central 0.6 of
/// its cell in width and height, projected in perspective [Heckbert1989]. Throws Error{usage} unless the
/// positions form a convex quadrilateral in that order, and if `columns` does not divide the number of
/// patches.
[[nodiscard]] std::vector<PatchOutline> outlines_between(const std::array<Imath::V2d, 4>& corners,
                                                         std::span<const std::string> names,
                                                         std::size_t columns);

}  // namespace abbe
