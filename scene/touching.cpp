#include "scene/touching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "scene/coincidence.h"
#include "scene/extent.h"
#include "scene/faces.h"

namespace abbe {
namespace {

using Imath::Box3d;
using Imath::V3d;

// The most faces that are looked at and pairs of them that are compared, which takes tenths of a second at
// most.
constexpr std::size_t kMostCompared = 2'000'000;

// Least cosine between normals of what may touch: less than `TouchingSurfaces` asks for, as rays meet faces
// in floats.
constexpr double kNearlyParallel = TouchingSurfaces::kParallel - 0.001;

// Whether the plane of one face cuts the other, or passes it no further away than that.
bool cuts(const Face& plane, const Face& face, double reach) {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  for (const V3d& corner : face.corners) {
    const double beyond = (corner - plane.corners[0]).dot(plane.normal);
    least = std::min(least, beyond);
    most = std::max(most, beyond);
  }
  return least <= reach && most >= -reach;
}

// Whether a ball and a plane so far from its middle, or two balls, may touch: they cross at a small angle, or
// come so near.
bool may_touch(const Sphere& ball, double distance, double reach) {
  return distance >= kNearlyParallel * ball.radius - reach && distance <= ball.radius + reach;
}
bool may_touch(const Sphere& a, const Sphere& b, double reach) {
  const double apart = (a.center - b.center).length();
  if (apart > a.radius + b.radius + reach || apart < std::abs(a.radius - b.radius) - reach) return false;
  const double cosine =
      (a.radius * a.radius + b.radius * b.radius - apart * apart) / (2 * a.radius * b.radius);
  const double slack = 2 * reach / std::min(a.radius, b.radius);
  return std::abs(cosine) >= kNearlyParallel - slack;
}

class RegionFinder {
 public:
  explicit RegionFinder(const Scene& scene) : scene_(scene) {
    for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
      const Box3d box = bounds(scene.shapes[i].shape);
      const double reach = 4 * scene.touch_distance(V3d(largest_coordinate(box)), i, i);
      shapes_.push_back({i, box, reach, grown(box, reach), {}});
    }
  }

  [[nodiscard]] std::vector<Imath::Box3f> find() {
    const bool all_known = compare_all();
    std::vector<Imath::Box3f> found(shapes_.size());
    for (const Bounded& shape : shapes_) {
      const Box3d& at = all_known ? shape.touched : shape.near;
      if (!at.isEmpty()) found[shape.index] = {Imath::V3f(at.min), Imath::V3f(at.max)};
    }
    return found;
  }

 private:
  struct Bounded {
    std::uint32_t index;
    Box3d box;
    double reach;  // about itself
    Box3d near;
    Box3d touched;
  };

  [[nodiscard]] const Shape& shape_of(const Bounded& of) const { return scene_.shapes[of.index].shape; }

  // In order of x. Whether there were not too many.
  bool compare_all() {
    std::ranges::stable_sort(shapes_, {}, [](const Bounded& shape) { return shape.near.min.x; });
    std::size_t pairs = 0;
    for (auto a = shapes_.begin(); a != shapes_.end(); ++a) {
      add_own(*a);
      for (auto b = a + 1; b != shapes_.end() && b->near.min.x <= a->near.max.x; ++b) {
        if (++pairs > kMostPairs) return false;
        add(*a, *b);
      }
    }
    return true;
  }

  // Whether so much may still be compared; counts it.
  bool may_compare(std::size_t more) {
    const bool may = more <= left_;
    left_ -= std::min(more, left_);
    return may;
  }
  // The faces of a shape that meet a box; nothing where looking at all of them would take too long.
  std::optional<std::vector<Face>> faces_near(const Shape& shape, const Box3d& box) {
    const auto* mesh = plain<Mesh>(shape);
    if (!may_compare(mesh != nullptr ? mesh->triangles.size() : 1)) return std::nullopt;
    return finder_.near(shape, box);
  }

  void add_own(Bounded& of) {
    const Shape& shape = shape_of(of);
    if (plain<Quad>(shape) != nullptr || plain<Disc>(shape) != nullptr) return;
    const auto* ball = std::get_if<Sphere>(&shape);
    if (ball != nullptr && ball->radius > of.reach) return;
    const bool flat = motion_of(shape) == nullptr && has_faces(shape);
    const auto faces = flat ? faces_near(shape, of.near) : std::nullopt;
    if (!faces || !add_faces(of, *faces, of, *faces, [](double cosine) { return cosine < -kNearlyParallel; }))
      of.touched = of.near;
  }

  void add(Bounded& a, Bounded& b) {
    const double reach = std::max(a.reach, b.reach);
    const Box3d both = common(grown(a.box, reach), grown(b.box, reach));
    if (both.isEmpty()) return;
    if (!may_compare(1) || !touch_within(a, b, both, reach)) extend(a, b, both);
  }

  // Adds where they touch within a box. Whether that can be told.
  bool touch_within(Bounded& a, Bounded& b, const Box3d& both, double reach) {
    const Shape& of_a = shape_of(a);
    const Shape& of_b = shape_of(b);
    if (motion_of(of_a) != nullptr || motion_of(of_b) != nullptr) return false;
    const auto* ball_a = std::get_if<Sphere>(&of_a);
    const auto* ball_b = std::get_if<Sphere>(&of_b);
    if (ball_a != nullptr && ball_b != nullptr) return !may_touch(*ball_a, *ball_b, reach);
    if (ball_a == nullptr && !has_faces(of_a)) return false;
    if (ball_b == nullptr && !has_faces(of_b)) return false;
    if (ball_a != nullptr) return add_ball(*ball_a, a, b, both, reach);
    if (ball_b != nullptr) return add_ball(*ball_b, b, a, both, reach);
    const auto faces_a = faces_near(of_a, both);
    const auto faces_b = faces_near(of_b, both);
    return faces_a && faces_b && add_faces(a, *faces_a, b, *faces_b, [](double cosine) {
             return std::abs(cosine) > kNearlyParallel;
           });
  }

  // Where faces are near a ball; false where they are too many.
  bool add_ball(const Sphere& ball, Bounded& of_ball, Bounded& other, const Box3d& both, double reach) {
    const auto faces = faces_near(shape_of(other), both);
    if (!faces) return false;
    for (const Face& face : *faces) {
      const double distance = std::abs((ball.center - face.corners[0]).dot(face.normal));
      if (may_touch(ball, distance, reach)) extend(of_ball, other, common(both, grown(face.box, reach)));
    }
    return true;
  }

  // Where faces of one are near those of the other, their normals at such a cosine; false where they are too
  // many. Both are in order of x.
  template <typename Turned>
  bool add_faces(Bounded& a, const std::vector<Face>& of_a, Bounded& b, const std::vector<Face>& of_b,
                 const Turned& turned) {
    const double reach = std::max(a.reach, b.reach);
    const auto add_pair = [&](const Face& face, const Face& other) {
      if (!turned(face.normal.dot(other.normal))) return false;
      const Box3d both = common(grown(face.box, reach), grown(other.box, reach));
      if (!both.isEmpty() && cuts(face, other, reach) && cuts(other, face, reach)) extend(a, b, both);
      return false;
    };
    return any_near_pair(of_a, of_b, 2 * reach, left_, add_pair).has_value();
  }

  static void extend(Bounded& a, Bounded& b, const Box3d& by) {
    a.touched.extendBy(by);
    b.touched.extendBy(by);
  }

  const Scene& scene_;
  FaceFinder finder_;
  std::vector<Bounded> shapes_;
  std::size_t left_ = kMostCompared;  // to compare
};

}  // namespace

std::vector<Imath::Box3f> touching_regions(const Scene& scene) {
  return RegionFinder(scene).find();
}

}  // namespace abbe
