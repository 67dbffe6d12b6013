#include "scene/shapes/triangles.h"

#include <algorithm>

#include "scene/shapes/mesh.h"
#include "scene/shapes/quad.h"

namespace abbe {
namespace {

Imath::V3d normal_at(const Mesh& mesh, std::size_t triangle) {
  return area_vector(mesh, triangle).normalized();
}
Imath::V3d normal_at(const Quad& quad, std::size_t /*triangle*/) {
  return normal_of(quad);
}

template <typename S>
TriangleSet completed(const S& shape) {
  TriangleSet set = triangles_of(shape);
  set.normals.reserve(set.triangles.size());
  for (std::size_t i = 0; i < set.triangles.size(); ++i) set.normals.emplace_back(normal_at(shape, i));
  return set;
}

constexpr double kMostShare = 0.25;  // of what makes 1: small shapes have no place further off their edges

// In a quad, by the shares of its edges that lead to the point.
Imath::V3d shift_off_sides(const TriangleSet& quad, std::uint32_t half, const Imath::V3d& point,
                           double clear) {
  const auto& [a, b, c] = quad.triangles[half];  // a is the corner where its sides meet
  const Imath::V3d corner(quad.vertices[a]);
  const Imath::V3d u = Imath::V3d(quad.vertices[b]) - corner;
  const Imath::V3d v = Imath::V3d(quad.vertices[c]) - corner;
  const Imath::V3d normal = u.cross(v);
  const double area = normal.length();
  if (!(area > 0)) return Imath::V3d(0);
  const auto more = [&](const Imath::V3d& to_share, const Imath::V3d& other) {
    const double share = to_share.dot(point - corner) / (area * area);
    const double least = std::min(clear * other.length() / area, kMostShare);
    return std::clamp(share, least, 1 - least) - share;
  };
  return u * more(v.cross(normal), v) + v * more(normal.cross(u), u);
}

}  // namespace

TriangleSet triangles_of(const Mesh& mesh) {
  TriangleSet set;
  set.vertices.reserve(mesh.vertices.size() + 1);
  for (const Imath::V3d& vertex : mesh.vertices) set.vertices.emplace_back(vertex);
  set.triangles = mesh.triangles;
  return set;
}

TriangleSet triangles_of(const Quad& quad) {
  const std::array<Imath::V3f, 4> c = corners(quad);
  return {{c.begin(), c.end()}, {kQuadTriangles.begin(), kQuadTriangles.end()}, {}, true};
}

Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return normal_at(*mesh, triangle);
  return normal_at(std::get<Quad>(shape), triangle);
}

TriangleSet with_normals(const Mesh& mesh) {
  return completed(mesh);
}
TriangleSet with_normals(const Quad& quad) {
  return completed(quad);
}

std::size_t memory_bytes_of(const TriangleSet& set) {
  return (set.vertices.size() + set.normals.size()) * sizeof(Imath::V3f) +
         set.triangles.size() * sizeof(set.triangles[0]);
}

Imath::V3d shift_off_edges(const TriangleSet& set, std::uint32_t triangle, const Imath::V3d& point,
                           double clear) {
  if (set.is_quad) return shift_off_sides(set, triangle, point, clear);
  std::array<Imath::V3d, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) corner.at(i) = Imath::V3d(set.vertices[set.triangles[triangle].at(i)]);
  const Imath::V3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double twice_area = normal.length();
  std::array<double, 3> share{};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Imath::V3d& next = corner.at((i + 1) % 3);
    const Imath::V3d edge = corner.at((i + 2) % 3) - next;
    const double there = edge.cross(point - next).dot(normal) / (twice_area * twice_area);
    share.at(i) = std::max(std::min(clear * edge.length() / twice_area, kMostShare), there);
    sum += share.at(i);
  }
  constexpr double kRounding = 1e-12;
  if (!(sum - 1 > kRounding)) return Imath::V3d(0);  // nor where a triangle has no area
  return (corner[0] * share[0] + corner[1] * share[1] + corner[2] * share[2]) / sum - point;
}

}  // namespace abbe
