#include "scene/coincidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/scene.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::V3d;

// A triangle or a parallelogram; of a disc the square around it.
struct Face {
  std::array<V3d, 4> corners;
  Box3d box;
  V3d normal;  // unit
};

// Adds those of a shape, placed by a matrix, that are flat and meet the box.
struct FaceCollector {
  const Imath::M44d& to_world;
  const Box3d& within;
  std::vector<Face>& faces;

  void add(std::array<V3d, 4> corners) const {
    Box3d box;
    for (V3d& corner : corners) {
      corner = corner * to_world;
      box.extendBy(corner);
    }
    if (!box.intersects(within)) return;
    faces.push_back({corners, box, (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized()});
  }
  void operator()(const Mesh& mesh) const {
    for (const auto& [a, b, c] : mesh.triangles)
      add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[c]});
  }
  void operator()(const Quad& quad) const {
    const V3d& at = quad.corner;
    add({at, at + quad.edge_u, at + quad.edge_v, at + quad.edge_u + quad.edge_v});
  }
  void operator()(const Disc& disc) const {
    const Basis<double> frame(disc.normal);
    const V3d across = frame.x * disc.radius;
    const V3d up = frame.y * disc.radius;
    const V3d at = disc.center - across - up;
    add({at, at + across * 2.0, at + up * 2.0, disc.center + across + up});
  }
  void operator()(const Sphere&) const {}
  void operator()(const PlacedShape& placed) const {
    std::visit(FaceCollector{placed.at->to_world, within, faces}, placed.of->shape);
  }
};

Box3d grown(const Box3d& box, double by) {
  return {box.min - V3d(by), box.max + V3d(by)};
}

// From low x to high.
std::vector<Face> faces_near(const Shape& shape, const Box3d& box) {
  std::vector<Face> faces;
  std::visit(FaceCollector{Imath::M44d(), box, faces}, shape);
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.box.min.x < b.box.min.x; });
  return faces;
}

bool has_corner_in_plane(const Face& of, const Face& plane, double reach) {
  return std::any_of(of.corners.begin(), of.corners.end(), [&](const V3d& corner) {
    return std::abs((corner - plane.corners[0]).dot(plane.normal)) <= reach;
  });
}

bool coincide(const Face& a, const Face& b, double reach) {
  return grown(a.box, reach).intersects(b.box) &&
         std::abs(a.normal.dot(b.normal)) > TouchingSurfaces::kParallel &&
         (has_corner_in_plane(a, b, reach) || has_corner_in_plane(b, a, reach));
}

bool same_sphere(const Shape& a, const Shape& b, double reach) {
  if (plain<Sphere>(a) == nullptr || plain<Sphere>(b) == nullptr) return false;
  const Box3d of_a = bounds(a);
  const Box3d of_b = bounds(b);
  return of_a.min.equalWithAbsError(of_b.min, reach) && of_a.max.equalWithAbsError(of_b.max, reach);
}

}  // namespace

bool may_coincide(const Shape& a, const Shape& b, double reach) {
  constexpr std::size_t kMostPairs = 50'000'000;
  const Box3d near_a = grown(bounds(a), reach);
  const Box3d near_b = grown(bounds(b), reach);
  if (!near_a.intersects(near_b)) return false;
  if (motion_of(a) != nullptr || motion_of(b) != nullptr || same_sphere(a, b, reach)) return true;
  const std::vector<Face> of_a = faces_near(a, near_b);
  const std::vector<Face> of_b = faces_near(b, near_a);
  std::size_t pairs = 0;
  auto first = of_b.begin();
  double widest = 0;  // of the faces of b along x
  for (const Face& face : of_b) widest = std::max(widest, face.box.size().x);
  for (const Face& face : of_a) {
    while (first != of_b.end() && first->box.min.x + widest < face.box.min.x - reach) ++first;
    for (auto other = first; other != of_b.end() && other->box.min.x <= face.box.max.x + reach; ++other)
      if (++pairs > kMostPairs || coincide(face, *other, reach)) return true;
  }
  return false;
}

}  // namespace abbe
