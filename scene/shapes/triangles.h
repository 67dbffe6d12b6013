#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/shapes/shape.h"

namespace abbe {

/// What is rendered as triangles, in float as Embree sees them.
struct TriangleSet {
  std::vector<Imath::V3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Imath::V3f> normals;  ///< Per triangle, from the unrounded vertices; none in a prototype.
};

[[nodiscard]] TriangleSet triangles_of(const Mesh& mesh);
[[nodiscard]] TriangleSet triangles_of(const Quad& quad);
/// Unit normal of a triangle of a mesh or quad, from the unrounded vertices.
[[nodiscard]] Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle);
/// The triangles of a mesh or quad with their normals.
[[nodiscard]] TriangleSet with_normals(const Mesh& mesh);
[[nodiscard]] TriangleSet with_normals(const Quad& quad);

[[nodiscard]] std::size_t memory_bytes_of(const TriangleSet& set);

}  // namespace abbe
