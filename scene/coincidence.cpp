#include "scene/coincidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <ImathBoxAlgo.h>

#include "scene/scene.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::M44d;
using Imath::V3d;

constexpr std::size_t kRunLength = 64;  // triangles

using BoxesOfMeshes = std::map<const Mesh*, FaceFinder::MeshBoxes>;

const FaceFinder::MeshBoxes& boxes_of(const Mesh& mesh, BoxesOfMeshes& boxes_of_meshes) {
  const auto [at, added] = boxes_of_meshes.try_emplace(&mesh);
  auto& [around, runs] = at->second;
  if (!added) return at->second;
  runs.resize((mesh.triangles.size() + kRunLength - 1) / kRunLength);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) runs[i / kRunLength].extendBy(mesh.vertices[vertex]);
  for (const Box3d& run : runs) around.extendBy(run);
  return at->second;
}

// Adds the flat faces of a shape, transformed by a matrix, that intersect the box.
struct FaceCollector {
  const M44d& to_world;
  double handedness;  // of the matrix: -1 if it mirrors, which reverses the winding
  const Box3d& within;
  BoxesOfMeshes& boxes_of_meshes;
  std::vector<Face>& faces;

  void add(std::array<V3d, 4> corners, bool round = false) const {
    Box3d box;
    for (V3d& corner : corners) {
      corner = corner * to_world;
      box.extendBy(corner);
    }
    if (!box.intersects(within)) return;
    const V3d across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    faces.push_back({corners, box, across.normalized() * handedness, round});
  }
  void operator()(const Mesh& mesh) const {
    const std::vector<Box3d>& runs = boxes_of(mesh, boxes_of_meshes).runs;
    const bool is_identity = to_world == M44d();  // transforming boxes takes most of the time
    for (std::size_t run = 0; run < runs.size(); ++run) {
      if (!(is_identity ? runs[run] : Imath::transform(runs[run], to_world)).intersects(within)) continue;
      const std::size_t end = std::min((run + 1) * kRunLength, mesh.triangles.size());
      for (std::size_t i = run * kRunLength; i < end; ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[c]});
      }
    }
  }
  template <typename S>
  void operator()(const S& shape) const {
    const std::optional<FlatFace> flat = flat_face(shape);
    if (!flat) return;
    const auto& [at, u, v, center, normal, round] = *flat;
    add({at, at + u, at + v, at + u + v}, round);
  }
  void operator()(const PlacedShape& placed) const {
    const M44d& at = placed.at->to_world;
    std::visit(FaceCollector{at, std::copysign(1.0, at.determinant()), within, boxes_of_meshes, faces},
               placed.of->shape);
  }
};

// A sphere transformed by a matrix.
struct Ellipsoid {
  V3d center;
  double radius;  // in its own coordinates
  M44d to_world;

  // Vector from the center to the surface point with that outward normal.
  [[nodiscard]] V3d surface_offset(const V3d& normal) const {
    return moved_direction(moved_direction(normal, to_world.transposed()).normalized() * radius, to_world);
  }
  // Radius if the ellipsoid is a sphere to within `tolerance`.
  [[nodiscard]] std::optional<double> radius_of_ball(double tolerance) const {
    const double across = surface_offset(V3d(1, 0, 0)).length();
    for (const V3d& axis : {V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)})
      if (!surface_offset(axis).equalWithAbsError(axis * across, tolerance)) return std::nullopt;
    return across;
  }
};

std::optional<Ellipsoid> ellipsoid_of(const Shape& shape) {
  const std::optional<Ball> ball = ball_of(shape);
  if (!ball) return std::nullopt;
  const auto* placed = std::get_if<PlacedShape>(&shape);
  const M44d to_world = placed != nullptr ? placed->at->to_world : M44d();
  return Ellipsoid{ball->center * to_world, ball->radius, to_world};
}

// Distance of a point from the plane of a face.
double distance_off(const Face& plane, const V3d& point) {
  return std::abs((point - plane.corners[0]).dot(plane.normal));
}

bool has_corner_in_plane(const Face& of, const Face& plane, double tolerance) {
  return std::ranges::any_of(of.corners,
                             [&](const V3d& corner) { return distance_off(plane, corner) <= tolerance; });
}

// True if two parallel faces overlap by more than `min_overlap`: no line in their plane separates them.
bool overlap(const Face& a, const Face& b, double min_overlap) {
  const auto projection = [](const Face& face, const V3d& along) {
    std::pair<double, double> range(face.corners[0].dot(along), face.corners[0].dot(along));
    for (const V3d& corner : face.corners) {
      range.first = std::min(range.first, corner.dot(along));
      range.second = std::max(range.second, corner.dot(along));
    }
    return range;
  };
  for (const Face* face : {&a, &b})
    for (const auto& [first, to] : {std::pair(0U, 1U), std::pair(0U, 2U), std::pair(1U, 2U)}) {
      const V3d across = a.normal.cross(face->corners.at(to) - face->corners.at(first)).normalized();
      const auto [min_a, max_a] = projection(a, across);
      const auto [min_b, max_b] = projection(b, across);
      if (!(std::min(max_a, max_b) - std::max(min_a, min_b) > min_overlap)) return false;
    }
  return true;
}

bool coincide(const Face& a, const Face& b, double tolerance, double min_overlap) {
  return grown(a.box, tolerance).intersects(b.box) &&
         std::abs(a.normal.dot(b.normal)) > CoincidentHits::kParallel &&
         (has_corner_in_plane(a, b, tolerance) || has_corner_in_plane(b, a, tolerance)) &&
         overlap(a, b, min_overlap);
}

// A triangle lies in the plane if all its corners do, a parallelogram if three corners do.
bool is_in_plane(const Face& face, const Face& plane, double tolerance) {
  return std::all_of(face.corners.begin(), face.corners.begin() + 3,
                     [&](const V3d& corner) { return distance_off(plane, corner) <= tolerance; });
}

bool lies_in(const Face& a, const Face& b, double tolerance) {
  return coincide(a, b, tolerance, tolerance) &&
         (is_in_plane(a, b, tolerance) || is_in_plane(b, a, tolerance));
}

bool are_same_ball(const Ellipsoid& a, const Ellipsoid& b, double tolerance) {
  const std::optional<double> radius_a = a.radius_of_ball(tolerance);
  const std::optional<double> radius_b = b.radius_of_ball(tolerance);
  return radius_a && radius_b && std::abs(*radius_a - *radius_b) <= tolerance &&
         (a.center - b.center).length() <= tolerance;
}

bool tangent(const Ellipsoid& a, const Ellipsoid& b, double tolerance) {
  const std::optional<double> radius_a = a.radius_of_ball(tolerance);
  const std::optional<double> radius_b = b.radius_of_ball(tolerance);
  if (!radius_a || !radius_b) return true;
  const double distance = (a.center - b.center).length();
  return std::abs(distance - (*radius_a + *radius_b)) <= tolerance ||
         std::abs(distance - std::abs(*radius_a - *radius_b)) <= tolerance;
}

// A sphere and its tangent plane are `tolerance` apart at most sqrt(2 radius tolerance) from the point of
// contact.
bool tangent(const Ellipsoid& ball, const Face& face, double tolerance) {
  const V3d side = ball.surface_offset(face.normal);
  const Box3d near = grown(face.box, std::sqrt(2 * side.length() * tolerance));
  return std::ranges::any_of(std::array{ball.center + side, ball.center - side}, [&](const V3d& point) {
    return distance_off(face, point) <= tolerance && near.intersects(point);
  });
}

// True if `shape` is an ellipsoid that is tangent to a part of `other`.
bool ellipsoid_is_tangent(const Shape& shape, const Shape& other, double tolerance, FaceFinder& faces) {
  const std::optional<Ellipsoid> ball = ellipsoid_of(shape);
  if (!ball) return false;
  if (const std::optional<Ellipsoid> another = ellipsoid_of(other))
    return tangent(*ball, *another, tolerance);
  return std::ranges::any_of(faces.near(other, grown(bounds(shape), tolerance)),
                             [&](const Face& face) { return tangent(*ball, face, tolerance); });
}

// Faces that certainly belong to the shape: for a disc the inscribed square.
std::vector<Face> certain_faces(const Shape& shape, const Box3d& near, FaceFinder& faces) {
  std::vector<Face> found = faces.near(shape, near);
  for (Face& face : found) {
    if (!face.round) continue;
    const V3d center = (face.corners[0] + face.corners[3]) / 2;
    face.box.makeEmpty();
    for (V3d& corner : face.corners) {
      corner = center + (corner - center) / std::numbers::sqrt2;
      face.box.extendBy(corner);
    }
  }
  return found;
}

// True if `matches` accepts a pair of faces that are near each other along x. Nothing if there are too many
// pairs.
template <typename Matches>
std::optional<bool> any_pair(const std::vector<Face>& faces_a, const std::vector<Face>& faces_b,
                             double tolerance, const Matches& matches) {
  std::size_t budget = kMaxPairs;
  return any_near_pair(faces_a, faces_b, tolerance, budget, matches);
}

}  // namespace

std::vector<Face> FaceFinder::near(const Shape& shape, const Box3d& box) {
  std::vector<Face> faces;
  const M44d unmoved;
  std::visit(FaceCollector{unmoved, 1, box, boxes_of_meshes_, faces}, shape);
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.box.min.x < b.box.min.x; });
  return faces;
}

Box3d FaceFinder::box_of(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh != nullptr ? boxes_of(*mesh, boxes_of_meshes_).around : bounds(shape);
}

bool may_coincide(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces) {
  const Box3d near_a = grown(faces.box_of(a), tolerance);
  const Box3d box_b = faces.box_of(b);
  if (!near_a.intersects(box_b)) return false;
  if (motion_of(a) != nullptr || motion_of(b) != nullptr) return true;
  const auto is_known = [](const Shape& shape) { return has_faces(shape) || ellipsoid_of(shape); };
  if (!is_known(a) || !is_known(b)) return true;
  if (ellipsoid_of(a) || ellipsoid_of(b))
    return ellipsoid_is_tangent(a, b, tolerance, faces) || ellipsoid_is_tangent(b, a, tolerance, faces);
  return any_pair(
             faces.near(a, grown(box_b, tolerance)), faces.near(b, near_a), tolerance,
             [&](const Face& one, const Face& other) { return coincide(one, other, tolerance, -tolerance); })
      .value_or(true);
}

bool overlaps(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces, Facing facing) {
  if (motion_of(a) != nullptr || motion_of(b) != nullptr) return false;
  const std::optional<Ellipsoid> ball_a = ellipsoid_of(a);
  const std::optional<Ellipsoid> ball_b = ellipsoid_of(b);
  if (ball_a && ball_b) return are_same_ball(*ball_a, *ball_b, tolerance);
  const std::vector<Face> faces_a = certain_faces(a, grown(faces.box_of(b), tolerance), faces);
  const std::vector<Face> faces_b = certain_faces(b, grown(faces.box_of(a), tolerance), faces);
  const auto matches = [&](const Face& one, const Face& other) {
    return (facing == Facing::any || one.normal.dot(other.normal) > 0) && lies_in(one, other, tolerance);
  };
  return any_pair(faces_a, faces_b, tolerance, matches).value_or(false);
}

bool coats(const Shape& coat, const Shape& body, double tolerance, FaceFinder& faces) {
  if (ellipsoid_of(coat) || ellipsoid_of(body)) return overlaps(coat, body, tolerance, faces);
  if (motion_of(coat) != nullptr || motion_of(body) != nullptr || !has_faces(coat)) return false;
  const std::vector<Face> of_coat = certain_faces(coat, faces.box_of(coat), faces);
  const std::vector<Face> of_body = certain_faces(body, faces.box_of(body), faces);
  std::vector<bool> covered(of_coat.size(), false);
  const auto cover = [&](const Face& one, const Face& other) {
    if (one.normal.dot(other.normal) > 0 && lies_in(one, other, tolerance))
      covered[static_cast<std::size_t>(&one - of_coat.data())] = true;
    return false;
  };
  return any_pair(of_coat, of_body, tolerance, cover) && std::ranges::all_of(covered, std::identity());
}

}  // namespace abbe
