#include "scene/shapes/triangles.h"

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
  return {{c.begin(), c.end()}, {kQuadTriangles.begin(), kQuadTriangles.end()}, {}};
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

}  // namespace abbe
