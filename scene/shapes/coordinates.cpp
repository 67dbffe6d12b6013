#include "scene/shapes/coordinates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/shapes/placed.h"

namespace abbe {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

/// Coordinates of a vector in a plane, with respect to two edges that span it.
struct PlaneCoordinates {
  double first;
  double second;

  PlaneCoordinates(const Imath::V3d& vector, const Imath::V3d& edge_a, const Imath::V3d& edge_b) {
    const Imath::V3d normal = edge_a.cross(edge_b);
    first = vector.cross(edge_b).dot(normal) / normal.length2();
    second = edge_a.cross(vector).dot(normal) / normal.length2();
  }
};

SurfaceCoordinates coordinates_on(const Quad& quad, const Imath::V3d& point, std::size_t /*triangle*/) {
  const PlaneCoordinates at(point - quad.corner, quad.edge_u, quad.edge_v);
  return {{at.first, at.second}, quad.edge_u, quad.edge_v};
}

SurfaceCoordinates coordinates_on(const Disc& disc, const Imath::V3d& point, std::size_t /*triangle*/) {
  constexpr double kNearZ = 0.9;
  const Imath::V3d up = std::abs(disc.normal.z) > kNearZ ? Imath::V3d(0, 1, 0) : Imath::V3d(0, 0, 1);
  const Imath::V3d u = up.cross(disc.normal).normalized();
  const Imath::V3d v = disc.normal.cross(u);
  const Imath::V3d from_center = point - disc.center;
  const double size = 2 * disc.radius;
  return {{0.5 + from_center.dot(u) / size, 0.5 + from_center.dot(v) / size}, u * size, v * size};
}

SurfaceCoordinates coordinates_on(const Sphere& sphere, const Imath::V3d& point, std::size_t /*triangle*/) {
  const Imath::V3d p = point - sphere.center;
  const double ring = std::hypot(p.x, p.y);
  const double longitude = std::atan2(p.y, p.x);
  SurfaceCoordinates at;
  at.uv = {longitude / kTau + (longitude < 0 ? 1 : 0), 0.5 + std::atan2(p.z, ring) / std::numbers::pi};
  if (ring == 0) return at;
  at.dp_du = Imath::V3d(-p.y, p.x, 0) * kTau;
  at.dp_dv = Imath::V3d(-p.x * p.z / ring, -p.y * p.z / ring, ring) * std::numbers::pi;
  return at;
}

SurfaceCoordinates coordinates_on(const Mesh& mesh, const Imath::V3d& point, std::size_t triangle) {
  if (mesh.coordinates.empty()) return {};
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Imath::V3d& origin = mesh.vertices[a];
  const Imath::V3d edge_b = mesh.vertices[b] - origin;
  const Imath::V3d edge_c = mesh.vertices[c] - origin;
  const auto& [uv_a, uv_b, uv_c] = mesh.coordinates[triangle];
  const Imath::V2d along_b = Imath::V2d(uv_b) - Imath::V2d(uv_a);
  const Imath::V2d along_c = Imath::V2d(uv_c) - Imath::V2d(uv_a);
  const PlaneCoordinates weights(point - origin, edge_b, edge_c);
  SurfaceCoordinates at;
  at.uv = Imath::V2d(uv_a) + along_b * weights.first + along_c * weights.second;
  const double area = along_b.cross(along_c);
  if (area == 0) return at;
  at.dp_du = (edge_b * along_c.y - edge_c * along_b.y) / area;
  at.dp_dv = (edge_c * along_b.x - edge_b * along_c.x) / area;
  return at;
}

// The placement of an instance at that time.
const Placement& current_placement(const PlacedShape& placed, float time, std::optional<Placement>& moved) {
  if (!placed.at->motion) return *placed.at;
  return moved.emplace(placement_at(*placed.at, static_cast<double>(time)));
}

SurfaceCoordinates coordinates_on(const PlacedShape& placed, const Placement& now, const Imath::V3d& point,
                                  std::size_t triangle) {
  const Imath::V3d inside = point * now.to_prototype;
  SurfaceCoordinates at = std::visit(
      [&](const auto& shape) { return coordinates_on(shape, inside, triangle); }, placed.of->shape);
  for (Imath::V3d* tangent : {&at.dp_du, &at.dp_dv}) {
    const Imath::V3d moved = *tangent;
    now.to_world.multDirMatrix(moved, *tangent);
  }
  return at;
}

}  // namespace

std::optional<Imath::V3d> interpolated_normal(const Shape& shape, const Imath::V3d& point,
                                              std::size_t triangle, const Imath::V3d& geometric, float time) {
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr || mesh->normals.empty()) return std::nullopt;
  const auto* placed = std::get_if<PlacedShape>(&shape);
  std::optional<Placement> moved;
  const Placement* now = placed != nullptr ? &current_placement(*placed, time, moved) : nullptr;
  const auto& [a, b, c] = mesh->triangles[triangle];
  const Imath::V3d& origin = mesh->vertices[a];
  const PlaneCoordinates weights((now ? point * now->to_prototype : point) - origin,
                                 mesh->vertices[b] - origin, mesh->vertices[c] - origin);
  const auto& [at_a, at_b, at_c] = mesh->normals[triangle];
  Imath::V3d normal = Imath::V3d(at_a) * (1 - weights.first - weights.second) +
                      Imath::V3d(at_b) * weights.first + Imath::V3d(at_c) * weights.second;
  if (now) normal = normal_to_world(*now, normal);
  normal.normalize();
  const double side = normal.dot(geometric);
  if (side == 0) return geometric;  // the interpolated normals cancel
  return side < 0 ? -normal : normal;
}

SurfaceCoordinates coordinates(const Shape& shape, const Imath::V3d& point, std::size_t triangle,
                               float time) {
  const auto on = [&](const auto& s) {
    if constexpr (std::is_same_v<std::decay_t<decltype(s)>, PlacedShape>) {
      std::optional<Placement> moved;
      return coordinates_on(s, current_placement(s, time, moved), point, triangle);
    } else {
      return coordinates_on(s, point, triangle);
    }
  };
  return std::visit(on, shape);
}

}  // namespace abbe
