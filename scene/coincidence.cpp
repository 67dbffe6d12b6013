#include "scene/coincidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "scene/extent.h"
#include "scene/scene.h"

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::M44d;
using Imath::V3d;

// A sphere placed by a matrix.
struct Ellipsoid {
  V3d center;
  double radius;  // in its own coordinates
  M44d to_world;

  // From the middle to where the outward normal is that.
  [[nodiscard]] V3d to_side(const V3d& normal) const {
    V3d own;
    to_world.transposed().multDirMatrix(normal, own);
    V3d side;
    to_world.multDirMatrix(own.normalized() * radius, side);
    return side;
  }
  // Its radius where it is a ball but for so much.
  [[nodiscard]] std::optional<double> radius_of_ball(double reach) const {
    const double across = to_side(V3d(1, 0, 0)).length();
    for (const V3d& axis : {V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)})
      if (!to_side(axis).equalWithAbsError(axis * across, reach)) return std::nullopt;
    return across;
  }
};

std::optional<Ellipsoid> ellipsoid_of(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return Ellipsoid{sphere->center, sphere->radius, M44d()};
  const auto* placed = std::get_if<PlacedShape>(&shape);
  const auto* sphere = placed == nullptr ? nullptr : std::get_if<Sphere>(&placed->of->shape);
  if (sphere == nullptr) return std::nullopt;
  const M44d& to_world = placed->at->to_world;
  return Ellipsoid{sphere->center * to_world, sphere->radius, to_world};
}

bool has_corner_in_plane(const Face& of, const Face& plane, double reach) {
  return std::any_of(of.corners.begin(), of.corners.end(), [&](const V3d& corner) {
    return std::abs((corner - plane.corners[0]).dot(plane.normal)) <= reach;
  });
}

// Whether two faces that are parallel reach over each other by more than that, as which no line between them
// parts them.
bool overlap(const Face& a, const Face& b, double by) {
  const auto extent = [](const Face& face, const V3d& along) {
    std::pair<double, double> range(face.corners[0].dot(along), face.corners[0].dot(along));
    for (const V3d& corner : face.corners) {
      range.first = std::min(range.first, corner.dot(along));
      range.second = std::max(range.second, corner.dot(along));
    }
    return range;
  };
  for (const Face* face : {&a, &b})
    for (const auto& [from, to] : {std::pair(0U, 1U), std::pair(0U, 2U), std::pair(1U, 2U)}) {
      const V3d across = a.normal.cross(face->corners.at(to) - face->corners.at(from)).normalized();
      const auto [least_a, most_a] = extent(a, across);
      const auto [least_b, most_b] = extent(b, across);
      if (!(std::min(most_a, most_b) - std::max(least_a, least_b) > by)) return false;
    }
  return true;
}

bool coincide(const Face& a, const Face& b, double reach, double by) {
  return grown(a.box, reach).intersects(b.box) &&
         std::abs(a.normal.dot(b.normal)) > TouchingSurfaces::kParallel &&
         (has_corner_in_plane(a, b, reach) || has_corner_in_plane(b, a, reach)) && overlap(a, b, by);
}

// A triangle has all of its corners there, and a parallelogram where it has three.
bool is_in_plane(const Face& face, const Face& plane, double reach) {
  return std::all_of(face.corners.begin(), face.corners.begin() + 3, [&](const V3d& corner) {
    return std::abs((corner - plane.corners[0]).dot(plane.normal)) <= reach;
  });
}

bool lies_in(const Face& a, const Face& b, double reach) {
  return coincide(a, b, reach, reach) && (is_in_plane(a, b, reach) || is_in_plane(b, a, reach));
}

bool are_one_ball(const Ellipsoid& a, const Ellipsoid& b, double reach) {
  const std::optional<double> radius_a = a.radius_of_ball(reach);
  const std::optional<double> radius_b = b.radius_of_ball(reach);
  return radius_a && radius_b && std::abs(*radius_a - *radius_b) <= reach &&
         (a.center - b.center).length() <= reach;
}

bool touch(const Ellipsoid& a, const Ellipsoid& b, double reach) {
  const std::optional<double> radius_a = a.radius_of_ball(reach);
  const std::optional<double> radius_b = b.radius_of_ball(reach);
  if (!radius_a || !radius_b) return true;
  const double apart = (a.center - b.center).length();
  return std::abs(apart - (*radius_a + *radius_b)) <= reach ||
         std::abs(apart - std::abs(*radius_a - *radius_b)) <= reach;
}

// Where a ball and a plane that touch are `reach` apart, at most the root of 2 radius reach from there.
bool touch(const Ellipsoid& ball, const Face& face, double reach) {
  const V3d side = ball.to_side(face.normal);
  const Box3d near = grown(face.box, std::sqrt(2 * side.length() * reach));
  return std::ranges::any_of(std::array{ball.center + side, ball.center - side}, [&](const V3d& point) {
    return std::abs((point - face.corners[0]).dot(face.normal)) <= reach && near.intersects(point);
  });
}

// Of a shape that is one, with what the other is made of.
bool ellipsoid_touches(const Shape& shape, const Shape& other, double reach, FaceFinder& faces) {
  const std::optional<Ellipsoid> ball = ellipsoid_of(shape);
  if (!ball) return false;
  if (const std::optional<Ellipsoid> another = ellipsoid_of(other)) return touch(*ball, *another, reach);
  return std::ranges::any_of(faces.near(other, grown(bounds(shape), reach)),
                             [&](const Face& face) { return touch(*ball, face, reach); });
}

// Of a disc the square within it, which is beyond doubt its own.
std::vector<Face> sure_faces(const Shape& shape, const Box3d& near, FaceFinder& faces) {
  std::vector<Face> found = faces.near(shape, near);
  if (plain<Disc>(shape) == nullptr) return found;
  for (Face& face : found) {
    const V3d center = (face.corners[0] + face.corners[3]) / 2;
    face.box.makeEmpty();
    for (V3d& corner : face.corners) {
      corner = center + (corner - center) / std::numbers::sqrt2;
      face.box.extendBy(corner);
    }
  }
  return found;
}

// How far rounding may take something in a face off its plane, as far as floats of that size go.
double rounding_across(const Face& face) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    sum += std::abs(face.normal[axis]) *
           float_step(std::max(std::abs(face.box.min[axis]), std::abs(face.box.max[axis])));
  return sum;
}

bool stands_on_ball(const V3d& point, const Ellipsoid& ball, const Box3d& box) {
  const V3d out = point - ball.center;
  const double rounding = rounding_across({{point, point, point, point}, box, out.normalized()});
  const std::optional<double> radius = ball.radius_of_ball(rounding);
  return radius && std::abs(out.length() - *radius) <= rounding;
}

// Whether a pair of faces fits that are near each other along x, from low x to high. Nothing where too many
// are to be compared.
template <typename Fits>
std::optional<bool> any_pair(const std::vector<Face>& of_a, const std::vector<Face>& of_b, double reach,
                             const Fits& fits) {
  std::size_t left = kMostPairs;
  return any_near_pair(of_a, of_b, reach, left, fits);
}

}  // namespace

bool may_coincide(const Shape& a, const Shape& b, double reach, FaceFinder& faces) {
  const Box3d near_a = grown(faces.box_of(a), reach);
  const Box3d box_b = faces.box_of(b);
  if (!near_a.intersects(box_b)) return false;
  if (motion_of(a) != nullptr || motion_of(b) != nullptr) return true;
  if (ellipsoid_of(a) || ellipsoid_of(b))
    return ellipsoid_touches(a, b, reach, faces) || ellipsoid_touches(b, a, reach, faces);
  return any_pair(faces.near(a, grown(box_b, reach)), faces.near(b, near_a), reach,
                  [&](const Face& one, const Face& other) { return coincide(one, other, reach, -reach); })
      .value_or(true);
}

bool lies_on(const Shape& a, const Shape& b, double reach, FaceFinder& faces, Facing facing) {
  if (motion_of(a) != nullptr || motion_of(b) != nullptr) return false;
  const std::optional<Ellipsoid> ball_a = ellipsoid_of(a);
  const std::optional<Ellipsoid> ball_b = ellipsoid_of(b);
  if (ball_a && ball_b) return are_one_ball(*ball_a, *ball_b, reach);
  const std::vector<Face> of_a = sure_faces(a, grown(faces.box_of(b), reach), faces);
  const std::vector<Face> of_b = sure_faces(b, grown(faces.box_of(a), reach), faces);
  const auto fits = [&](const Face& one, const Face& other) {
    return (facing == Facing::any || one.normal.dot(other.normal) > 0) && lies_in(one, other, reach);
  };
  return any_pair(of_a, of_b, reach, fits).value_or(false);
}

bool coats(const Shape& coat, const Shape& body, double tolerance, FaceFinder& faces) {
  if (ellipsoid_of(coat) || ellipsoid_of(body)) return lies_on(coat, body, tolerance, faces);
  if (motion_of(coat) != nullptr || motion_of(body) != nullptr) return false;
  const std::vector<Face> of_coat = sure_faces(coat, faces.box_of(coat), faces);
  const std::vector<Face> of_body = sure_faces(body, faces.box_of(body), faces);
  std::vector<bool> covered(of_coat.size(), false);
  const auto cover = [&](const Face& one, const Face& other) {
    if (one.normal.dot(other.normal) > 0 && lies_in(one, other, tolerance))
      covered[static_cast<std::size_t>(&one - of_coat.data())] = true;
    return false;
  };
  return any_pair(of_coat, of_body, tolerance, cover) && std::ranges::all_of(covered, std::identity());
}

bool lies_on_itself(const Shape& shape, double reach, FaceFinder& faces) {
  const std::vector<Face> all = faces.near(shape, grown(faces.box_of(shape), reach));
  const auto fits = [&](const Face& one, const Face& other) {
    return &one < &other && lies_in(one, other, reach);
  };
  return any_pair(all, all, reach, fits).value_or(false);
}

bool stands_on(const V3d& point, const Shape& shape, FaceFinder& faces) {
  if (motion_of(shape) != nullptr) return false;
  if (const std::optional<Ellipsoid> ball = ellipsoid_of(shape))
    return stands_on_ball(point, *ball, bounds(shape));
  const double most = 2 * float_step(largest_coordinate(faces.box_of(shape)));  // of all its faces
  const std::vector<Face> near = sure_faces(shape, grown(Box3d(point), most), faces);
  return std::ranges::any_of(near, [&](const Face& face) {
    const Face at{{point, point, point, point}, Box3d(point), face.normal};
    return coincide(at, face, rounding_across(face), -most);
  });
}

}  // namespace abbe
