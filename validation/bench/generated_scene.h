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

/// Ring of rectangular cross-section on the plane y = 0, around the y axis. The inner radius is 0.9, the
/// outer radius 1 and the height 0.5. It has 8 `sides` triangles that face out of the solid; `sides` >= 3.
/// Each flat face spans the angle 2 pi/`sides`.
[[nodiscard]] Mesh make_ring(std::uint32_t sides);

/// Writes a mesh as binary PLY with vertices rounded to float, in the unit of the mesh. The file appears
/// complete or not at all. Throws Error{output} if it cannot be written.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

/// JSON array of `rows`^2 lights (`rows` >= 1) below the ceiling of the hall in `data/bench/hall.json`, for
/// its key `lights`. They are panels, balls and spots of the illuminants A, D65 and FL11, with luminous
/// fluxes from 1 to 30 lm. Each is in its own cell of a grid of `rows` x `rows`. The positions in the cells
/// and the fluxes follow low-discrepancy sequences, so the result is the same on every platform.
[[nodiscard]] std::string make_lights(int rows);

}  // namespace abbe
