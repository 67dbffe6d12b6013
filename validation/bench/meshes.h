#pragma once

#include <filesystem>

#include "scene/shapes/shape.h"

namespace abbe {

/// Rolling ground y = h(x, z) over [-20, 20]^2 seen from above, 2 `cells`^2 triangles: a few sines, so the
/// same everywhere.
[[nodiscard]] Mesh make_terrain(std::uint32_t cells);

/// A ball of radius 1.5 around (0, 1.8, 0) with bumps of 4 %, 4 `rows` (`rows` - 1) triangles.
[[nodiscard]] Mesh make_bumpy_ball(std::uint32_t rows);

/// A ring of rectangular cross-section that stands on y = 0 around the y axis, its inside a cylinder of
/// radius 0.9 and its outside one of radius 1, 0.5 high, of 8 `sides` triangles: a flat face is as wide as
/// its corner 2 pi/`sides` tells.
[[nodiscard]] Mesh make_ring(std::uint32_t sides);

/// Writes a mesh as binary PLY, vertices rounded to float. Atomic; throws Error{output}.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace abbe
