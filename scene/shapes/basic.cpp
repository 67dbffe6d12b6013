#include "scene/shapes/basic.h"

#include <utility>

namespace abbe {

SurfaceCoordinates coordinates_on(const Sphere& sphere, const Imath::V3d& point, std::size_t /*triangle*/) {
  const Imath::V3d p = point - sphere.center;
  const double ring = std::hypot(p.x, p.y);
  const double longitude = std::atan2(p.y, p.x);
  constexpr double kTau = 2 * std::numbers::pi;
  SurfaceCoordinates at;
  at.uv = {longitude / kTau + (longitude < 0 ? 1 : 0), 0.5 + std::atan2(p.z, ring) / std::numbers::pi};
  if (ring == 0) return at;
  at.dp_du = Imath::V3d(-p.y, p.x, 0) * kTau;
  at.dp_dv = Imath::V3d(-p.x * p.z / ring, -p.y * p.z / ring, ring) * std::numbers::pi;
  return at;
}

std::optional<Ball> ball_of(const Sphere& sphere) {
  return Ball{sphere.center, sphere.radius};
}

double axial_irradiance(const Sphere& sphere, double distance) {
  const double sine = sphere.radius / distance;
  return sine < 1 ? std::numbers::pi * sine * sine : 0;
}

double enclosed_volume(const Sphere& sphere) {
  return 4 * std::numbers::pi / 3 * sphere.radius * sphere.radius * sphere.radius;
}

bool may_intersect(const Sphere& sphere, const Imath::Box3d& box) {
  Imath::V3d furthest;  // corner relative to the center
  for (int k = 0; k < 3; ++k)
    furthest[k] = std::max(std::abs(box.min[k] - sphere.center[k]), std::abs(box.max[k] - sphere.center[k]));
  return furthest.length() >= sphere.radius;
}

double thickness(const Sphere& sphere) {
  return sphere.radius;
}

OuterSide outer_side(const Sphere& sphere) {
  return {std::numbers::pi * sphere.radius * sphere.radius, std::nullopt};
}

// The silhouette point in each direction u of the drawing: the image under `to_world` of the sphere's extreme
// point along transpose(to_world) u.
Outline outline(const Sphere& sphere, const Imath::M44d& to_world, const DrawingPlane& plane) {
  std::vector<Imath::V3d> points;
  for (int i = 0; i <= kOutlineCorners; ++i) {
    const Imath::V3d u = std::cos(outline_angle(i)) * plane.right + std::sin(outline_angle(i)) * plane.up;
    const Imath::V3d local = moved_direction(u, to_world.transposed()).normalized();
    points.push_back((sphere.center + sphere.radius * local) * to_world);
  }
  return {points};
}

Imath::V3d point_at(const Sphere& sphere, const Imath::V2d& uv) {
  return Imath::V3d(sample_area(sphere, Imath::V2f(uv)).point);
}

Imath::V2d uv_of(const Sphere& sphere, const Imath::V3d& point) {
  const Imath::V3d outward = (point - sphere.center) / sphere.radius;
  const double turn = std::atan2(outward.y, outward.x) / (2 * std::numbers::pi);
  return {(1 - outward.z) / 2, turn < 0 ? turn + 1 : turn};
}

void shift(Sphere& sphere, const Imath::V3d& by) {
  sphere.center += by;
}

void transform(Sphere& sphere, const Imath::M44d& by, double scale) {
  sphere.center *= by;
  sphere.radius *= scale;
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

Imath::V3d point_at(const Disc& disc, const Imath::V2d& uv) {
  return Imath::V3d(sample_area(disc, Imath::V2f(uv)).point);
}

Imath::V2d uv_of(const Disc& disc, const Imath::V3d& point) {
  const Imath::V3d local = Basis<double>(disc.normal).to_local(point - disc.center) / disc.radius;
  return square_of_disc({local.x, local.y});
}

std::optional<FlatFace> flat_face(const Disc& disc) {
  const Basis<double> frame(disc.normal);
  const Imath::V3d across = frame.x * disc.radius;
  const Imath::V3d up = frame.y * disc.radius;
  return FlatFace{disc.center - across - up, across * 2.0, up * 2.0, disc.center, disc.normal, true};
}

double axial_irradiance(const Disc& disc, double distance) {
  const double r2 = disc.radius * disc.radius;
  return std::numbers::pi * r2 / (r2 + distance * distance);
}

OuterSide outer_side(const Disc& disc) {
  return {area(disc), NormalCone{disc.normal, 0}};
}

Outline outline(const Disc& disc, const Imath::M44d& to_world, const DrawingPlane& /*plane*/) {
  const Imath::V3d side =
      disc.normal.cross(std::abs(disc.normal.x) < 0.5 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0))
          .normalized();
  const Imath::V3d other = disc.normal.cross(side);
  std::vector<Imath::V3d> points;
  for (int i = 0; i <= kOutlineCorners; ++i)
    points.push_back((disc.center + disc.radius * (std::cos(outline_angle(i)) * side +
                                                   std::sin(outline_angle(i)) * other)) *
                     to_world);
  return {points};
}

void shift(Disc& disc, const Imath::V3d& by) {
  disc.center += by;
}

void transform(Disc& disc, const Imath::M44d& by, double scale) {
  disc.center *= by;
  disc.normal = moved_direction(disc.normal, by).normalized();
  disc.radius *= scale;
}

SurfaceCoordinates coordinates_on(const Quad& quad, const Imath::V3d& point, std::size_t /*triangle*/) {
  const PlaneCoordinates at(point - quad.corner, quad.edge_u, quad.edge_v);
  return {{at.first, at.second}, quad.edge_u, quad.edge_v};
}

Imath::V3d point_at(const Quad& quad, const Imath::V2d& uv) {
  return quad.corner + quad.edge_u * uv.x + quad.edge_v * uv.y;
}

// Solves (u edge_u + v edge_v) . edge = (point - corner) . edge for both edges.
Imath::V2d uv_of(const Quad& quad, const Imath::V3d& point) {
  const Imath::V3d d = point - quad.corner;
  const double uu = quad.edge_u.length2();
  const double uv = quad.edge_u.dot(quad.edge_v);
  const double vv = quad.edge_v.length2();
  const double determinant = uu * vv - uv * uv;
  const double du = d.dot(quad.edge_u);
  const double dv = d.dot(quad.edge_v);
  return {(du * vv - dv * uv) / determinant, (dv * uu - du * uv) / determinant};
}

std::optional<FlatFace> flat_face(const Quad& quad) {
  return FlatFace{quad.corner, quad.edge_u, quad.edge_v, quad.corner + (quad.edge_u + quad.edge_v) * 0.5,
                  normal_of(quad)};
}

// Half the sum over the edges of the angle that each edge subtends, times the cosine of its tilt
// [Lambert1760]. Let a and b be the vectors from the center to the ends of an edge, n the normal, and d the
// distance. The plane through the edge and the point has the normal (a + n d) x (b + n d). Its component
// along n is that of a x b. In this form nothing cancels at large distances.
double axial_irradiance(const Quad& quad, double distance) {
  const Imath::V3d normal = normal_of(quad);
  const Imath::V3d first = (quad.edge_u + quad.edge_v) / -2;
  const std::array corners{first, first + quad.edge_u, -first, first + quad.edge_v};
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Imath::V3d& a = corners.at(i);
    const Imath::V3d& b = corners.at((i + 1) % corners.size());
    const double along = a.cross(b).dot(normal);
    const double across = std::hypot(along, distance * (b - a).length());
    sum += std::atan2(across, a.dot(b) + distance * distance) * along / across;
  }
  return std::abs(sum) / 2;
}

TriangleSet triangles_of(const Quad& quad) {
  const std::array<Imath::V3f, 4> c = corners(quad);
  return {{c.begin(), c.end()}, {{0, 1, 2}, {3, 2, 1}}, {}, true};
}

Imath::V3d normal_at(const Quad& quad, std::size_t /*triangle*/) {
  return normal_of(quad);
}

OuterSide outer_side(const Quad& quad) {
  return {area(quad), NormalCone{normal_of(quad), 0}};
}

Outline outline(const Quad& quad, const Imath::M44d& to_world, const DrawingPlane& /*plane*/) {
  std::vector<Imath::V3d> points;
  for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}})
    points.push_back(
        (quad.corner + static_cast<double>(u) * quad.edge_u + static_cast<double>(v) * quad.edge_v) *
        to_world);
  return {points};
}

void shift(Quad& quad, const Imath::V3d& by) {
  quad.corner += by;
}

void transform(Quad& quad, const Imath::M44d& by, double /*scale*/) {
  quad.corner *= by;
  quad.edge_u = moved_direction(quad.edge_u, by);
  quad.edge_v = moved_direction(quad.edge_v, by);
}

}  // namespace abbe
