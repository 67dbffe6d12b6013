#pragma once

#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

/// Nearest hit at t in (t_min, ray.t_max), in units of the ray's direction, by a test of every triangle,
/// edges included. It is exact but slow, for single rays. Triangles of zero area are never hit.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Mesh& mesh, const BasicRay<T>& ray, T t_min);

/// Half the cross product of two edges: the outward unit normal times the area [m^2].
[[nodiscard]] Imath::V3d area_vector(const Mesh& mesh, std::size_t triangle);

/// Memory in bytes of the lists, without slivers.
[[nodiscard]] std::size_t memory_bytes(const Mesh& mesh);
/// Area of one side of all triangles [m^2].
[[nodiscard]] double area(const Mesh& mesh);
[[nodiscard]] Imath::Box3d bounds(const Mesh& mesh);
/// Samples a point uniformly by area, by `u` in [0, 1)^2; `triangle_cdf` is that function's result for the
/// mesh.
[[nodiscard]] SurfacePoint sample_area(const Mesh& mesh, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

}  // namespace abbe
