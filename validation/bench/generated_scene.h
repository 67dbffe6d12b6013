#pragma once

#include <filesystem>
#include <string>

#include "scene/shapes/shape.h"

namespace abbe {

/// Undulating ground y = h(x, z) over [-20, 20]^2 with 2 `cells`^2 triangles that face +y; `cells` >= 1. The
/// height is a sum of products of sines, about ± 0.5.
[[nodiscard]] Mesh make_terrain(std::uint32_t cells);

/// Ball of radius 1.5 around (0, 1.8, 0) with bumps of 4 % of the radius. It has 4 `rows` (`rows` - 1)
/// triangles that face outwards; `rows` >= 2.
[[nodiscard]] Mesh make_bumpy_ball(std::uint32_t rows);

/// Ring on the plane y = 0 around the y axis, with inner radius 0.9, outer radius 1 and height 0.5. It has
/// 8 `sides` triangles that face out of the solid; `sides` >= 3.
[[nodiscard]] Mesh make_ring(std::uint32_t sides);

/// Writes a mesh as binary PLY with vertices rounded to float. Throws Error{output} if it cannot be
/// written.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

/// JSON array of `rows`^2 panels, balls and spots (`rows` >= 1) of 1 to 30 lm below the ceiling of the hall
/// in `data/bench/hall.json`. Each is in its own cell of a grid. Positions and fluxes follow low-discrepancy
/// sequences, so the result is the same on every platform.
[[nodiscard]] std::string make_lights(int rows);

}  // namespace abbe
