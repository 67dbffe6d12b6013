#include "scene/shapes/mesh.h"

#include <map>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "sampling/discrete.h"

namespace abbe {
namespace {

constexpr std::size_t kMaxDrawnTriangles = 4000;
constexpr double kFlat = 0.9998;  // cosine of one degree between the normals of two faces

std::vector<Imath::V3d> box_outline(const Imath::Box3d& box, const DrawingPlane& plane) {
  // Half extents of the box along the axes of the drawing.
  const Imath::V3d half = box.size() / 2;
  const auto half_extent = [&half](const Imath::V3d& along) {
    return std::abs(half.x * along.x) + std::abs(half.y * along.y) + std::abs(half.z * along.z);
  };
  std::vector<Imath::V3d> points;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
    points.push_back(box.center() + x * half_extent(plane.right) * plane.right +
                     y * half_extent(plane.up) * plane.up);
  return points;
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

std::vector<float> triangle_cdf(const Mesh& mesh) {
  std::vector<float> cdf;
  const double total = area(mesh);
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    sum += area_vector(mesh, i).length();
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

bool may_intersect(const Mesh& mesh, const Imath::Box3d& box) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& corners) {
    Imath::Box3d around;
    for (const std::uint32_t corner : corners) around.extendBy(mesh.vertices[corner]);
    return around.intersects(box);
  });
}

// A flat mesh shows all of its area along its axis; a closed convex mesh shows a quarter of its area on
// average.
OuterSide outer_side(const Mesh& mesh) {
  const double total = area(mesh);
  Imath::V3d sum(0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) sum += area_vector(mesh, i);
  const double flatness = std::min(1.0, sum.length() / total);
  const Imath::V3d axis = sum.normalized();
  double cosine = flatness > 0 ? 1 : -1;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    cosine = std::min(cosine, area_vector(mesh, i).normalized().dot(axis));
  return {total * (1 + 3 * flatness) / 4, NormalCone{axis, std::acos(std::clamp(cosine, -1.0, 1.0))}};
}

// Vertices at equal positions are merged, so edges are found between faces that do not share an index.
Outline outline(const Mesh& mesh, const Imath::M44d& to_world, const DrawingPlane& plane) {
  struct Edge {
    Imath::V3d from, to;
    Imath::V3d normal;
    bool is_crease = true;  // false if an adjacent face is nearly coplanar
  };
  if (mesh.triangles.size() > kMaxDrawnTriangles) {
    Imath::Box3d box;
    for (const Imath::V3d& vertex : mesh.vertices) box.extendBy(vertex * to_world);
    return {box_outline(box, plane)};
  }
  std::map<std::array<double, 6>, Edge> edges;
  for (const auto& triangle : mesh.triangles) {
    std::array<Imath::V3d, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) p.at(i) = mesh.vertices[triangle.at(i)] * to_world;
    const Imath::V3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      Imath::V3d a = p.at(i);
      Imath::V3d b = p.at((i + 1) % 3);
      if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
      const auto [edge, added] = edges.try_emplace({a.x, a.y, a.z, b.x, b.y, b.z}, Edge{a, b, normal});
      if (!added && edge->second.normal.dot(normal) > kFlat) edge->second.is_crease = false;
    }
  }
  Outline lines;
  for (const auto& [key, edge] : edges)
    if (edge.is_crease) lines.push_back({edge.from, edge.to});
  return lines;
}

void shift(Mesh& mesh, const Imath::V3d& by) {
  for (Imath::V3d& vertex : mesh.vertices) vertex += by;
}

void transform(Mesh& mesh, const Imath::M44d& by, double /*scale*/) {
  for (Imath::V3d& vertex : mesh.vertices) vertex *= by;
  for (std::array<Imath::V3f, 3>& corners : mesh.normals)
    for (Imath::V3f& normal : corners)
      normal = Imath::V3f(moved_direction(Imath::V3d(normal), by).normalized());
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

TriangleSet triangles_of(const Mesh& mesh) {
  TriangleSet set;
  set.vertices.reserve(mesh.vertices.size() + 1);
  for (const Imath::V3d& vertex : mesh.vertices) set.vertices.emplace_back(vertex);
  set.triangles = mesh.triangles;
  return set;
}

Imath::V3d normal_at(const Mesh& mesh, std::size_t triangle) {
  return area_vector(mesh, triangle).normalized();
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
