#pragma once

#include <cstddef>

#include "scene/shapes/shape.h"

namespace abbe {

/// What was put right of a mesh that is to enclose matter, and what keeps it from doing so. Vertices at the
/// same place count as one; triangles that pairwise share edges are a component of the mesh.
struct SolidReport {
  // Put right.
  std::size_t repeated = 0;  ///< Triangles that others repeat, with the same winding: taken out.
  std::size_t rewound = 0;   ///< Triangles of closed components wound against the rest of theirs: turned.
  std::size_t inverted = 0;  ///< Closed components that faced the wrong way: turned.
  // Left as they are.
  std::size_t open_edges = 0;  ///< Edges of one triangle.
  std::size_t crowded_edges =
      0;  ///< Of more than two, as many of them one way round as the other do not share it.
  std::size_t clashing_edges = 0;  ///< Of two triangles that wind against each other.
  std::size_t back_to_back = 0;    ///< Triangles with the corners of another, wound the other way.
  std::size_t buried = 0;          ///< Closed components that face outward within matter of the mesh's own.

  [[nodiscard]] bool mended() const { return repeated + rewound + inverted > 0; }
  [[nodiscard]] bool encloses() const {
    return open_edges + crowded_edges + clashing_edges + back_to_back + buried == 0;
  }
};

/// Makes the triangles of every closed component wind the same way, so that it faces outward. One that lies
/// in matter enclosed by others of the mesh may face inward, around a cavity; what lies in a component that
/// is turned is turned with it.
[[nodiscard]] SolidReport make_solid(Mesh& mesh);

/// Whether two triangles of a mesh have the same corners, whichever way each is wound. Vertices at the same
/// place count as one.
[[nodiscard]] bool has_doubled_triangles(const Mesh& mesh);

/// The volume [m^3] that a shape encloses: of a mesh, the largest of its closed components, cavities not
/// taken off. 0 of what encloses nothing. What lies wholly in a shape has less, unless the shape has further
/// components.
[[nodiscard]] double enclosed_volume(const Mesh& mesh);
[[nodiscard]] double enclosed_volume(const Sphere& sphere);
[[nodiscard]] inline double enclosed_volume(const Disc&) {
  return 0;
}
[[nodiscard]] inline double enclosed_volume(const Quad&) {
  return 0;
}

}  // namespace abbe
