#pragma once

#include <filesystem>

#include "scene/shapes/shape.h"

namespace abbe {

/// Rolling ground y = h(x, z) over [-20, 20]^2 seen from above, 2 `cells`^2 triangles: a few sines, so the
/// same everywhere.
[[nodiscard]] Mesh make_terrain(std::uint32_t cells);

/// A ball of radius 1.5 around (0, 1.8, 0) with bumps of 4 %, 4 `rows` (`rows` - 1) triangles.
[[nodiscard]] Mesh make_bumpy_ball(std::uint32_t rows);

/// Writes a mesh as binary PLY, vertices rounded to float. Atomic; throws Error{output}.
void write_ply(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace abbe
