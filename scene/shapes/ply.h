#pragma once

#include <filesystem>
#include <optional>

#include "io/diagnostics.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// Reads the triangles of a PLY file (ASCII or binary; convex polygons are cut into triangles), in the file's
/// own units. Reports, as input errors at `where`, a file that is missing or not regular, a header promising
/// more than the file holds (before anything is allocated for it), and whatever `check_mesh` reports.
[[nodiscard]] std::optional<Mesh> load_ply(const std::filesystem::path& path, const SourcePosition& where,
                                           Diagnostics& diagnostics);

/// Reports a vertex that is not finite and a triangle naming a vertex that does not exist, each by index;
/// drops triangles of zero area with a warning that counts them. False when the mesh cannot be used.
[[nodiscard]] bool check_mesh(Mesh& mesh, const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
