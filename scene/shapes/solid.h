#pragma once

#include <cstddef>

#include "scene/shapes/mesh.h"

namespace abbe {

/// Numbers of repairs and of remaining faults of a mesh that shall enclose a medium. Vertices at the same
/// position count as one. Triangles that share edges in pairs form a component.
struct SolidReport {
  // Repaired:
  std::size_t repeated = 0;  ///< Duplicate triangles with the same winding: removed.
  /// Triangles in closed components with a winding against the others: flipped.
  std::size_t rewound = 0;
  std::size_t inverted = 0;  ///< Closed components that faced the wrong way: flipped.
  // Not repaired:
  std::size_t open_edges = 0;  ///< Edges with one triangle.
  /// Edges with more than two triangles whose windings do not cancel.
  std::size_t crowded_edges = 0;
  std::size_t clashing_edges = 0;  ///< Edges with two triangles whose windings disagree.
  std::size_t back_to_back = 0;    ///< Triangles with the corners of another one and the opposite winding.
  /// Closed components that face outward inside the mesh's own medium.
  std::size_t buried = 0;

  /// True if the mesh was changed.
  [[nodiscard]] bool repaired() const { return repeated + rewound + inverted > 0; }
  /// True if the mesh, as repaired, encloses a medium everywhere: there are no faults.
  [[nodiscard]] bool encloses() const {
    return open_edges + crowded_edges + clashing_edges + back_to_back + buried == 0;
  }
};

/// Removes repeated triangles of a mesh in place and orients every closed component consistently, facing
/// outward. A component inside the medium enclosed by others may face inward and bound a cavity. Components
/// inside a flipped component are flipped with it.
[[nodiscard]] SolidReport make_solid(Mesh& mesh);

}  // namespace abbe
