#include "report/outline.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <ImathMatrix.h>

namespace abbe {
namespace {

using V3d = Imath::V3d;
using Lines = std::vector<std::vector<V3d>>;

constexpr int kCorners = 64;  // of a circle's polygon
constexpr std::size_t kMaxTriangles = 4000;
constexpr double kFlat = 0.9998;  // cosine of one degree between the normals of two faces

double angle_of(int corner) {
  return 2 * std::numbers::pi * corner / kCorners;
}

// The silhouette point in each direction u of the drawing: the image under `to_world` of the sphere's extreme
// point along transpose(to_world) u.
Lines outline_of(const Sphere& sphere, const Imath::M44d& to_world, const DrawingPlane& plane) {
  std::vector<V3d> points;
  for (int i = 0; i <= kCorners; ++i) {
    const V3d u = std::cos(angle_of(i)) * plane.right + std::sin(angle_of(i)) * plane.up;
    V3d local;
    to_world.transposed().multDirMatrix(u, local);
    points.push_back((sphere.center + sphere.radius * local.normalized()) * to_world);
  }
  return {points};
}

Lines outline_of(const Disc& disc, const Imath::M44d& to_world, const DrawingPlane&) {
  V3d side = disc.normal.cross(std::abs(disc.normal.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
  const V3d other = disc.normal.cross(side);
  std::vector<V3d> points;
  for (int i = 0; i <= kCorners; ++i)
    points.push_back(
        (disc.center + disc.radius * (std::cos(angle_of(i)) * side + std::sin(angle_of(i)) * other)) *
        to_world);
  return {points};
}

Lines outline_of(const Quad& quad, const Imath::M44d& to_world, const DrawingPlane&) {
  std::vector<V3d> points;
  for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}})
    points.push_back(
        (quad.corner + static_cast<double>(u) * quad.edge_u + static_cast<double>(v) * quad.edge_v) *
        to_world);
  return {points};
}

std::vector<V3d> box_outline(const Imath::Box3d& box, const DrawingPlane& plane) {
  // Half extents of the box along the axes of the drawing.
  const V3d half = box.size() / 2;
  const auto half_extent = [&half](const V3d& along) {
    return std::abs(half.x * along.x) + std::abs(half.y * along.y) + std::abs(half.z * along.z);
  };
  std::vector<V3d> points;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
    points.push_back(box.center() + x * half_extent(plane.right) * plane.right +
                     y * half_extent(plane.up) * plane.up);
  return points;
}

// Vertices at equal positions are merged, so edges are found between faces that do not share an index.
Lines outline_of(const Mesh& mesh, const Imath::M44d& to_world, const DrawingPlane& plane) {
  struct Edge {
    V3d from, to;
    V3d normal;
    bool is_crease = true;  // false if an adjacent face is nearly coplanar
  };
  if (mesh.triangles.size() > kMaxTriangles) {
    Imath::Box3d box;
    for (const V3d& vertex : mesh.vertices) box.extendBy(vertex * to_world);
    return {box_outline(box, plane)};
  }
  std::map<std::array<double, 6>, Edge> edges;
  for (const auto& triangle : mesh.triangles) {
    std::array<V3d, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) p.at(i) = mesh.vertices[triangle.at(i)] * to_world;
    const V3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      V3d a = p.at(i);
      V3d b = p.at((i + 1) % 3);
      if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
      const auto [edge, added] = edges.try_emplace({a.x, a.y, a.z, b.x, b.y, b.z}, Edge{a, b, normal});
      if (!added && edge->second.normal.dot(normal) > kFlat) edge->second.is_crease = false;
    }
  }
  Lines lines;
  for (const auto& [key, edge] : edges)
    if (edge.is_crease) lines.push_back({edge.from, edge.to});
  return lines;
}

}  // namespace

Lines outline(const Shape& shape, const DrawingPlane& plane) {
  const auto drawn = [&plane](const auto& plain, const Imath::M44d& to_world) {
    return outline_of(plain, to_world, plane);
  };
  if (const auto* placed = std::get_if<PlacedShape>(&shape))
    return std::visit([&](const auto& plain) { return drawn(plain, placed->at->to_world); },
                      placed->of->shape);
  return std::visit(
      [&](const auto& plain) -> Lines {
        if constexpr (std::is_same_v<std::decay_t<decltype(plain)>, PlacedShape>)
          return {};
        else
          return drawn(plain, Imath::M44d());
      },
      shape);
}

}  // namespace abbe
