#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sensor/film/patch.h"

namespace abbe {

/// Where the middles of a chart's patches lie between its outer corners in an image [pixels]: those of its
/// top left, top right, bottom right and bottom left patch, as the chart is read. Patches fill even cells row
/// by row, `columns` to a row; their outlines are the middle 0.6 of each cell, seen in perspective
/// [Heckbert1989]. Throws Error{usage} unless the corners are those of a convex quadrilateral.
[[nodiscard]] std::vector<PatchOutline> outlines_between(const std::array<Imath::V2d, 4>& corners,
                                                         std::span<const std::string> names,
                                                         std::size_t columns);

}  // namespace abbe
