#pragma once

#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

/// Nearest hit by a test of every triangle, edges included: exact but slow, for single rays. Triangles of
/// zero area are never hit.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Mesh& mesh, const BasicRay<T>& ray, T t_min);

/// Half the cross product of two edges: the unit normal times the area.
[[nodiscard]] Imath::V3d area_vector(const Mesh& mesh, std::size_t triangle);

[[nodiscard]] std::size_t memory_bytes(const Mesh& mesh);
[[nodiscard]] double area(const Mesh& mesh);
[[nodiscard]] Imath::Box3d bounds(const Mesh& mesh);
[[nodiscard]] SurfacePoint sample_area(const Mesh& mesh, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

}  // namespace abbe
