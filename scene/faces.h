#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// A triangle or a parallelogram, or the square around a disc, in render coordinates [m].
struct Face {
  /// A triangle repeats its last corner. In a parallelogram the last corner is opposite to the first.
  std::array<Imath::V3d, 4> corners;
  Imath::Box3d box;    ///< Bounding box of the corners.
  Imath::V3d normal;   ///< Unit normal to the shape's outer side.
  bool round = false;  ///< True if the shape is the disc in a square.
};

/// Finds the flat faces of shapes near a box. It caches the bounding boxes of each mesh and of runs of its
/// triangles, so that a query skips most triangles. Meshes must outlive it and not change. One per thread.
class FaceFinder {
 public:
  /// Faces of a shape whose boxes intersect `box`, in order of the boxes' minimum x. Empty without flat
  /// faces. A moving shape is taken at the opening of the shutter.
  [[nodiscard]] std::vector<Face> near(const Shape& shape, const Imath::Box3d& box);
  /// Bounding box of a shape as by `bounds`, for a moving shape over all times; of a mesh that of its
  /// triangles.
  [[nodiscard]] Imath::Box3d box_of(const Shape& shape);

  /// Cached boxes of a mesh.
  struct MeshBoxes {
    Imath::Box3d around;             ///< Box of all triangles.
    std::vector<Imath::Box3d> runs;  ///< Boxes of runs of 64 consecutive triangles; the last may be shorter.
  };

 private:
  std::map<const Mesh*, MeshBoxes> boxes_of_meshes_;
};

/// True if `matches(a, b)` accepts a face of each list whose boxes are at most `tolerance` [m] apart along x.
/// Both lists are in order of x, as `FaceFinder::near` returns them. Each comparison takes one from `budget`.
/// Nothing if the budget is exhausted before a match.
template <typename Matches>
[[nodiscard]] std::optional<bool> any_near_pair(const std::vector<Face>& faces_a,
                                                const std::vector<Face>& faces_b, double tolerance,
                                                std::size_t& budget, const Matches& matches) {
  auto first = faces_b.begin();
  double widest = 0;  // extent along x of the widest face in faces_b
  for (const Face& face : faces_b) widest = std::max(widest, face.box.size().x);
  for (const Face& face : faces_a) {
    while (first != faces_b.end() && first->box.min.x + widest < face.box.min.x - tolerance) ++first;
    for (auto other = first; other != faces_b.end() && other->box.min.x <= face.box.max.x + tolerance;
         ++other) {
      if (budget == 0) return std::nullopt;
      --budget;
      if (matches(face, *other)) return true;
    }
  }
  return false;
}

}  // namespace abbe
