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
TriangleSet with_face_normals(const S& shape) {
  TriangleSet set = triangles_of(shape);
  set.normals.reserve(set.triangles.size());
  for (std::size_t i = 0; i < set.triangles.size(); ++i) set.normals.emplace_back(normal_at(shape, i));
  return set;
}

// barycentric limit: small shapes have no point farther from their edges
constexpr double kMaxMinWeight = 0.25;

// The displacement in a quad, in coordinates along its edges.
Imath::V3d shift_off_sides(const TriangleSet& quad, std::uint32_t half, const Imath::V3d& point,
                           double clear) {
  const auto& [a, b, c] = quad.triangles[half];  // a is the corner common to the quad's sides
  const Imath::V3d corner(quad.vertices[a]);
  const Imath::V3d u = Imath::V3d(quad.vertices[b]) - corner;
  const Imath::V3d v = Imath::V3d(quad.vertices[c]) - corner;
  const Imath::V3d normal = u.cross(v);
  const double area = normal.length();
  if (!(area > 0)) return Imath::V3d(0);
  const auto correction = [&](const Imath::V3d& dual, const Imath::V3d& other) {
    const double weight = dual.dot(point - corner) / (area * area);
    const double min_weight = std::min(clear * other.length() / area, kMaxMinWeight);
    return std::clamp(weight, min_weight, 1 - min_weight) - weight;
  };
  return u * correction(v.cross(normal), v) + v * correction(normal.cross(u), u);
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
  return with_face_normals(mesh);
}
TriangleSet with_normals(const Quad& quad) {
  return with_face_normals(quad);
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
  std::array<double, 3> weights{};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Imath::V3d& next = corner.at((i + 1) % 3);
    const Imath::V3d edge = corner.at((i + 2) % 3) - next;
    const double raw_weight = edge.cross(point - next).dot(normal) / (twice_area * twice_area);
    weights.at(i) = std::max(std::min(clear * edge.length() / twice_area, kMaxMinWeight), raw_weight);
    sum += weights.at(i);
  }
  constexpr double kRounding = 1e-12;
  if (!(sum - 1 > kRounding)) return Imath::V3d(0);  // also for a triangle without area
  return (corner[0] * weights[0] + corner[1] * weights[1] + corner[2] * weights[2]) / sum - point;
}

}  // namespace abbe
