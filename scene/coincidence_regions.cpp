#include "scene/coincidence_regions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "scene/coincidence.h"
#include "scene/faces.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::V3d;

// Maximum number of faces and of pairs that are compared, which takes tenths of a second.
constexpr std::size_t kMaxCompared = 2'000'000;

// Minimum cosine between normals of candidates. It is lower than that of `CoincidentHits`, because rays
// intersect faces in float.
constexpr double kNearlyParallel = CoincidentHits::kParallel - 0.001;

// True if the plane of `plane` cuts `face` or passes within `tolerance` of it.
bool cuts(const Face& plane, const Face& face, double tolerance) {
  double min_distance = std::numeric_limits<double>::infinity();
  double max_distance = -std::numeric_limits<double>::infinity();
  for (const V3d& corner : face.corners) {
    const double distance = (corner - plane.corners[0]).dot(plane.normal);
    min_distance = std::min(min_distance, distance);
    max_distance = std::max(max_distance, distance);
  }
  return min_distance <= tolerance && max_distance >= -tolerance;
}

// True if a sphere and a plane at `distance` from its center, or two spheres, may coincide: they intersect at
// a small angle or come within `tolerance`.
bool nearly_tangent(const Sphere& ball, double distance, double tolerance) {
  return distance >= kNearlyParallel * ball.radius - tolerance && distance <= ball.radius + tolerance;
}
bool nearly_tangent(const Sphere& a, const Sphere& b, double tolerance) {
  const double distance = (a.center - b.center).length();
  if (distance > a.radius + b.radius + tolerance || distance < std::abs(a.radius - b.radius) - tolerance)
    return false;
  const double cosine =
      (a.radius * a.radius + b.radius * b.radius - distance * distance) / (2 * a.radius * b.radius);
  const double slack = 2 * tolerance / std::min(a.radius, b.radius);
  return std::abs(cosine) >= kNearlyParallel - slack;
}

class RegionFinder {
 public:
  explicit RegionFinder(const Scene& scene) : scene_(scene) {
    for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
      const Box3d box = bounds(scene.shapes[i].shape);
      const double tolerance = 4 * scene.coincidence_tolerance(V3d(largest_coordinate(box)), i, i);
      shapes_.push_back({i, box, tolerance, grown(box, tolerance), {}});
    }
  }

  [[nodiscard]] std::vector<Imath::Box3f> compute() {
    const bool all_known = compare_all();
    std::vector<Imath::Box3f> found(shapes_.size());
    for (const ShapeRegion& shape : shapes_) {
      const Box3d& at = all_known ? shape.region : shape.near;
      if (!at.isEmpty()) found[shape.index] = {Imath::V3f(at.min), Imath::V3f(at.max)};
    }
    return found;
  }

 private:
  struct ShapeRegion {
    std::uint32_t index;
    Box3d box;
    double tolerance;  // around this shape
    Box3d near;
    Box3d region;
  };

  [[nodiscard]] const Shape& shape_of(const ShapeRegion& of) const { return scene_.shapes[of.index].shape; }

  // Compares all shapes in order of x; false if there are too many pairs.
  bool compare_all() {
    std::ranges::stable_sort(shapes_, {}, [](const ShapeRegion& shape) { return shape.near.min.x; });
    std::size_t pairs = 0;
    for (auto a = shapes_.begin(); a != shapes_.end(); ++a) {
      add_self(*a);
      for (auto b = a + 1; b != shapes_.end() && b->near.min.x <= a->near.max.x; ++b) {
        if (++pairs > kMaxPairs) return false;
        add(*a, *b);
      }
    }
    return true;
  }

  // Takes `more` comparisons from the budget; false if it is exhausted.
  bool spend(std::size_t more) {
    const bool may = more <= budget_;
    budget_ -= std::min(more, budget_);
    return may;
  }
  // Faces of a shape that intersect a box; nothing if examining them would take too long.
  std::optional<std::vector<Face>> faces_near(const Shape& shape, const Box3d& box) {
    const auto* mesh = plain<Mesh>(shape);
    if (!spend(mesh != nullptr ? mesh->triangles.size() : 1)) return std::nullopt;
    return finder_.near(shape, box);
  }

  void add_self(ShapeRegion& of) {
    const Shape& shape = shape_of(of);
    if (is_flat(shape)) return;
    if (!std::holds_alternative<PlacedShape>(shape) &&
        visit_plain([](const auto& s) { return thickness(s); }, shape) > of.tolerance)
      return;
    const bool flat = motion_of(shape) == nullptr && has_faces(shape);
    const auto faces = flat ? faces_near(shape, of.near) : std::nullopt;
    if (!faces || !add_faces(of, *faces, of, *faces, [](double cosine) { return cosine < -kNearlyParallel; }))
      of.region = of.near;
  }

  void add(ShapeRegion& a, ShapeRegion& b) {
    const double tolerance = std::max(a.tolerance, b.tolerance);
    const Box3d both = common(grown(a.box, tolerance), grown(b.box, tolerance));
    if (both.isEmpty()) return;
    if (!spend(1) || !add_within(a, b, both, tolerance)) extend(a, b, both);
  }

  // Adds the region within a box where both coincide; false if that cannot be determined.
  bool add_within(ShapeRegion& a, ShapeRegion& b, const Box3d& both, double tolerance) {
    const Shape& of_a = shape_of(a);
    const Shape& of_b = shape_of(b);
    if (motion_of(of_a) != nullptr || motion_of(of_b) != nullptr) return false;
    const auto* ball_a = std::get_if<Sphere>(&of_a);
    const auto* ball_b = std::get_if<Sphere>(&of_b);
    if (ball_a != nullptr && ball_b != nullptr) return !nearly_tangent(*ball_a, *ball_b, tolerance);
    if (ball_a == nullptr && !has_faces(of_a)) return false;
    if (ball_b == nullptr && !has_faces(of_b)) return false;
    if (ball_a != nullptr) return add_ball(*ball_a, a, b, both, tolerance);
    if (ball_b != nullptr) return add_ball(*ball_b, b, a, both, tolerance);
    const auto faces_a = faces_near(of_a, both);
    const auto faces_b = faces_near(of_b, both);
    return faces_a && faces_b && add_faces(a, *faces_a, b, *faces_b, [](double cosine) {
             return std::abs(cosine) > kNearlyParallel;
           });
  }

  // Adds the region where faces are near a sphere; false if there are too many.
  bool add_ball(const Sphere& ball, ShapeRegion& of_ball, ShapeRegion& other, const Box3d& both,
                double tolerance) {
    const auto faces = faces_near(shape_of(other), both);
    if (!faces) return false;
    for (const Face& face : *faces) {
      const double distance = std::abs((ball.center - face.corners[0]).dot(face.normal));
      if (nearly_tangent(ball, distance, tolerance))
        extend(of_ball, other, common(both, grown(face.box, tolerance)));
    }
    return true;
  }

  // Adds the region where faces of one shape are near those of the other and `condition` accepts the cosine
  // of their normals. False if there are too many. Both lists are in order of x.
  template <typename Condition>
  bool add_faces(ShapeRegion& a, const std::vector<Face>& of_a, ShapeRegion& b, const std::vector<Face>& of_b,
                 const Condition& condition) {
    const double tolerance = std::max(a.tolerance, b.tolerance);
    const auto add_pair = [&](const Face& face, const Face& other) {
      if (!condition(face.normal.dot(other.normal))) return false;
      const Box3d both = common(grown(face.box, tolerance), grown(other.box, tolerance));
      if (!both.isEmpty() && cuts(face, other, tolerance) && cuts(other, face, tolerance)) extend(a, b, both);
      return false;
    };
    return any_near_pair(of_a, of_b, 2 * tolerance, budget_, add_pair).has_value();
  }

  static void extend(ShapeRegion& a, ShapeRegion& b, const Box3d& by) {
    a.region.extendBy(by);
    b.region.extendBy(by);
  }

  const Scene& scene_;
  FaceFinder finder_;
  std::vector<ShapeRegion> shapes_;
  std::size_t budget_ = kMaxCompared;  // comparisons left
};

}  // namespace

std::vector<Imath::Box3f> coincidence_regions(const Scene& scene) {
  return RegionFinder(scene).compute();
}

}  // namespace abbe
