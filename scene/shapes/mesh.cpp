#include "scene/shapes/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sampling/discrete.h"
#include "scene/shapes/triangle.h"

namespace abbe {
template <typename T>
std::optional<ShapeHit<T>> intersect(const Mesh& mesh, const BasicRay<T>& ray, T t_min) {
  T nearest = ray.t_max;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const std::optional<T> t =
        intersect_triangle(Imath::Vec3<T>(mesh.vertices[a]), Imath::Vec3<T>(mesh.vertices[b]),
                           Imath::Vec3<T>(mesh.vertices[c]), ray);
    if (!t || !(*t > t_min && *t < nearest)) continue;
    nearest = *t;
    found = i;
  }
  if (!found) return std::nullopt;
  const Imath::V3d normal = area_vector(mesh, *found).normalized();
  return ShapeHit<T>{nearest, ray.origin + ray.direction * nearest, Imath::Vec3<T>(normal)};
}
template std::optional<ShapeHit<float>> intersect(const Mesh&, const BasicRay<float>&, float);
template std::optional<ShapeHit<double>> intersect(const Mesh&, const BasicRay<double>&, double);

Imath::V3d area_vector(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]) * 0.5;
}

std::size_t memory_bytes(const Mesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) + mesh.triangles.size() * sizeof(mesh.triangles[0]) +
         mesh.coordinates.size() * sizeof(mesh.coordinates[0]) +
         mesh.normals.size() * sizeof(mesh.normals[0]);
}

double area(const Mesh& mesh) {
  double total = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) total += area_vector(mesh, i).length();
  return total;
}

Imath::Box3d bounds(const Mesh& mesh) {
  Imath::Box3d box;
  for (const Imath::V3d& vertex : mesh.vertices) box.extendBy(vertex);
  return box;
}

std::vector<float> triangle_cdf(const Shape& shape) {
  std::vector<float> cdf;
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr) return cdf;
  const double total = area(*mesh);
  double sum = 0;
  for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
    sum += area_vector(*mesh, i).length();
    cdf.push_back(static_cast<float>(sum / total));
  }
  return cdf;
}

SurfacePoint sample_area(const Mesh& mesh, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  const auto [index, within] = invert_cdf(std::span(triangle_cdf), static_cast<double>(u.x));
  // Uniform over the triangle: the square root makes the rows equal in area. [Pharr2023, sec. A.5.1]
  const double root = std::sqrt(within);
  const double weight_c = static_cast<double>(u.y) * root;
  const auto& [a, b, c] = mesh.triangles[index];
  const auto rendered = [&mesh](std::uint32_t i) { return Imath::V3d(Imath::V3f(mesh.vertices[i])); };
  const Imath::V3d point =
      rendered(a) * (1 - root) + rendered(b) * (root - weight_c) + rendered(c) * weight_c;
  return {Imath::V3f(point), Imath::V3f(area_vector(mesh, index).normalized())};
}

Mesh make_prism(double apex_deg, double side, double length) {
  const double half_apex = apex_deg * std::numbers::pi / 360;
  const double half_base = side * std::sin(half_apex);
  const double height = side * std::cos(half_apex);
  Mesh prism;
  for (const double y : {-length / 2, length / 2}) {
    prism.vertices.emplace_back(-half_base, y, -height / 3);
    prism.vertices.emplace_back(half_base, y, -height / 3);
    prism.vertices.emplace_back(0, y, height * 2 / 3);
  }
  prism.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
  constexpr std::array<std::array<float, 2>, 3> kSection{{{0, 0}, {1, 0}, {0.5F, 1}}};
  for (std::size_t i = 0; i < prism.triangles.size(); ++i) {
    const auto at = [&](std::uint32_t vertex) {
      const std::uint32_t corner = vertex % 3;
      const auto [x, z] = kSection.at(corner);
      if (i < 2) return Imath::V2f(i == 0 ? x : 1 - x, z);
      return Imath::V2f(vertex < 3 ? 0.0F : 1.0F, corner == (i - 2) / 2 ? 0.0F : 1.0F);
    };
    const auto& [a, b, c] = prism.triangles[i];
    prism.coordinates.push_back({at(a), at(b), at(c)});
  }
  return prism;
}

}  // namespace abbe
