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

// The functions below take shapes in render coordinates [m]. `faces` caches the boxes of meshes between
// calls. None of them throws.

/// Maximum number of pairs of shapes or faces that a check compares. More pairs would take seconds.
inline constexpr std::size_t kMaxPairs = 50'000'000;

/// True if a face of one shape may coincide with a face of the other, or if the shapes may be tangent. False
/// if their bounding boxes are more than `tolerance` [m] apart. Otherwise true if one of these holds:
/// - two faces meet all conditions below;
/// - a sphere or ellipsoid is tangent to a face, or a sphere to another sphere, within `tolerance`;
/// - both are spheres or ellipsoids, and at least one is no sphere;
/// - either shape moves, or is curved and no ellipsoid;
/// - more than `kMaxPairs` pairs of faces would have to be compared.
///
/// Conditions for two faces:
/// - their normals are parallel by `CoincidentHits::kParallel`;
/// - their boxes intersect after one of them has grown by `tolerance` on all sides;
/// - at least one corner of either face is at most `tolerance` off the plane of the other;
/// - no line in their plane that is parallel to an edge or diagonal separates them by `tolerance` or more.
[[nodiscard]] bool may_coincide(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces);

/// Relative orientation of the outward normals of two coincident faces: arbitrary, or to the same side.
enum class Facing { any, same };

/// True if a face of one shape certainly coincides with a face of the other, or if both are the same sphere.
/// Faces must overlap over an area and have the given orientation:
/// - three corners of either face are at most `tolerance` [m] off the plane of the other face;
/// - the faces overlap by more than `tolerance` in every direction, so adjacent faces do not count;
/// - of two spheres, centers and radii differ by at most `tolerance`.
/// A disc counts as the square inscribed in it. `facing` has no effect on two spheres. False if either
/// shape moves, for ellipsoids that are not spheres, and if there are more than `kMaxPairs` pairs of faces.
[[nodiscard]] bool overlaps(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces,
                            Facing facing = Facing::any);

/// True if the whole surface of a closed shape certainly lies on another shape. Each of its faces coincides
/// with a face of `body` that faces the same side, or both are one sphere; `tolerance` [m] as in `overlaps`.
/// False if either shape moves, or if there are more than `kMaxPairs` pairs of faces.
[[nodiscard]] bool coats(const Shape& coat, const Shape& body, double tolerance, FaceFinder& faces);

}  // namespace abbe
