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

/// A triangle or a parallelogram; of a disc the square around it.
struct Face {
  std::array<Imath::V3d, 4> corners;  ///< Of a triangle the last one twice.
  Imath::Box3d box;
  Imath::V3d normal;  ///< Unit, to where the shape faces.
};

/// Whether a shape is made of flat faces.
[[nodiscard]] bool has_faces(const Shape& shape);

/// Finds the flat faces of shapes by where they are. Of each mesh it keeps the boxes around all of it and
/// around runs of triangles, so that not all of them are looked at each time; meshes must live as long as it
/// does.
class FaceFinder {
 public:
  /// The faces of a shape the boxes of which meet a box, from low x to high. Of what moves, those when the
  /// shutter opens.
  [[nodiscard]] std::vector<Face> near(const Shape& shape, const Imath::Box3d& box);
  /// The box around a shape, as `bounds` tells it; of a mesh around its triangles.
  [[nodiscard]] Imath::Box3d box_of(const Shape& shape);

  /// The boxes of a mesh.
  struct MeshBoxes {
    Imath::Box3d around;
    std::vector<Imath::Box3d> runs;
  };

 private:
  std::map<const Mesh*, MeshBoxes> known_;
};

/// Whether a pair of faces fits that are no further from each other along x than `reach`; both are in order
/// of x, as `FaceFinder::near` has them. Nothing where there are more pairs than `left`, which counts down.
template <typename Fits>
[[nodiscard]] std::optional<bool> any_near_pair(const std::vector<Face>& of_a, const std::vector<Face>& of_b,
                                                double reach, std::size_t& left, const Fits& fits) {
  auto first = of_b.begin();
  double widest = 0;  // of the faces of b along x
  for (const Face& face : of_b) widest = std::max(widest, face.box.size().x);
  for (const Face& face : of_a) {
    while (first != of_b.end() && first->box.min.x + widest < face.box.min.x - reach) ++first;
    for (auto other = first; other != of_b.end() && other->box.min.x <= face.box.max.x + reach; ++other) {
      if (left == 0) return std::nullopt;
      --left;
      if (fits(face, *other)) return true;
    }
  }
  return false;
}

}  // namespace abbe
