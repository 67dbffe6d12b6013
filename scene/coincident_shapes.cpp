#include "scene/coincident_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "materials/interface/fresnel.h"
#include "scene/coincidence.h"
#include "scene/shapes/solid.h"
#include "scene/small_light.h"
#include "scene/working_range.h"

namespace abbe {
namespace {

bool is_sheet(const Material& material) {
  return !opaque(material) && !encloses_medium(material);
}

// A shape and its bounding box.
struct BoxedShape {
  std::uint32_t shape;
  Imath::Box3d box;
};
template <typename Predicate>
std::vector<BoxedShape> shapes_of(const Scene& scene, const Predicate& predicate) {
  std::vector<BoxedShape> found;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    if (predicate(material_of(scene, i))) found.push_back({i, bounds(scene.shapes[i].shape)});
  return found;
}

// True if the outside of a closed body emits and its inside does not. The test works on a copy, because
// `make_solid` modifies its mesh.
bool is_closed_emitter(const Scene& scene, std::uint32_t shape) {
  const ShapeInstance& instance = scene.shapes[shape];
  if (two_sided(scene.lights[static_cast<std::size_t>(instance.light)])) return false;
  const auto* mesh = plain<Mesh>(instance.shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  const SolidReport report = make_solid(copy);
  return report.encloses() && !report.repaired();
}

bool is_emitter(const Scene& scene, std::uint32_t shape) {
  const std::int32_t light = scene.shapes[shape].light;
  return light >= 0 && emits(scene.lights[static_cast<std::size_t>(light)]) &&
         opaque(material_of(scene, shape));
}

// Finds what rays hit instead of a shape among others near it.
class HidingFinder {
 public:
  explicit HidingFinder(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] std::vector<std::uint32_t> hiding(const BoxedShape& one,
                                                  const std::vector<const BoxedShape*>& others) {
    const Material& material = material_of(scene_, one.shape);
    if (is_sheet(material)) return hiding_sheet(one, others);
    if (encloses_medium(material))
      return selected(others, [&](const BoxedShape& other) { return is_coated(other, one); });
    const auto hides = [&](Facing facing) {
      return selected(others, [&](const BoxedShape& other) {
        return opaque(material_of(scene_, other.shape)) && coincides(one, other, facing);
      });
    };
    // Coincident faces of a closed body and a wall that look at each other are invisible.
    std::vector<std::uint32_t> found = hides(Facing::any);
    return found.empty() || !is_closed_emitter(scene_, one.shape) ? found : hides(Facing::same);
  }

 private:
  template <typename Predicate>
  static std::vector<std::uint32_t> selected(const std::vector<const BoxedShape*>& from,
                                             const Predicate& predicate) {
    std::vector<std::uint32_t> found;
    for (const BoxedShape* shape : from)
      if (predicate(*shape)) found.push_back(shape->shape);
    return found;
  }
  // A sheet between two bodies of one material is not hidden.
  std::vector<std::uint32_t> hiding_sheet(const BoxedShape& sheet,
                                          const std::vector<const BoxedShape*>& others) {
    std::vector<std::uint32_t> on = selected(others, [&](const BoxedShape& other) {
      const Material& material = material_of(scene_, other.shape);
      return (opaque(material) || is_sheet(material) || interior_index(material) != nullptr) &&
             coincides(sheet, other, Facing::any);
    });
    const auto differs = [&](std::uint32_t shape) {
      return interior_index(material_of(scene_, shape)) == nullptr ||
             scene_.shapes[shape].material != scene_.shapes[on.front()].material;
    };
    if (on.size() > 1 && std::ranges::none_of(on, differs)) on.clear();
    return on;
  }
  bool coincides(const BoxedShape& one, const BoxedShape& other, Facing facing) {
    const double tolerance = tolerance_of(one, other);
    return grown(one.box, tolerance).intersects(other.box) &&
           overlaps(scene_.shapes[one.shape].shape, scene_.shapes[other.shape].shape, tolerance, faces_,
                    facing);
  }
  bool is_coated(const BoxedShape& body, const BoxedShape& coat) {
    const double tolerance = tolerance_of(coat, body);
    return opaque(material_of(scene_, body.shape)) &&
           coat.box.min.equalWithAbsError(body.box.min, tolerance) &&
           coat.box.max.equalWithAbsError(body.box.max, tolerance) &&
           coats(scene_.shapes[coat.shape].shape, scene_.shapes[body.shape].shape, tolerance, faces_);
  }
  [[nodiscard]] double tolerance_of(const BoxedShape& one, const BoxedShape& other) const {
    return scene_.coincidence_tolerance(Imath::V3d(largest_coordinate(one.box)), one.shape, other.shape);
  }

  const Scene& scene_;
  FaceFinder faces_;
};

// True if rays from a film position of a probe start behind a surface that emits towards the probe. The rays
// start off the probe by the rounding of its coordinates.
bool starts_behind(const Camera& meter, Imath::V2f film, const Shape& shape, const Light& light) {
  const Imath::V3f start = probe_point(meter, film);
  const Imath::V3f normal = probe_normal(meter, start);
  const double rounding = static_cast<double>(offset_length(start));
  const BasicRay<double> ray{Imath::V3d(start) - Imath::V3d(normal) * (2 * rounding), Imath::V3d(normal),
                             2 * rounding};
  const auto hit = intersect(shape, ray, 0.0);
  return hit && emits_towards(light, Imath::V3f(hit->normal), -normal);
}

// Collects the walls near a shape with that box.
class WallCollector {
 public:
  WallCollector(const Imath::Box3d& box, double tolerance)
      : near_(grown(box, tolerance)), tolerance_(tolerance) {}

  [[nodiscard]] const Imath::Box3d& near() const { return near_; }

  void add(const Shape& shape, FaceFinder& faces) {
    if (motion_of(shape) != nullptr || !has_faces(shape)) {
      add_box(bounds(shape));
      return;
    }
    for (const Face& face : faces.near(shape, grown(near_, tolerance_)))
      if (cuts(face)) add_face(face);
  }
  // Adds a wall that may lie anywhere in a box.
  void add_box(const Imath::Box3d& box) {
    bounds_.extendBy(common(near_, grown(box, tolerance_)));
    planes_.reset();
  }

  [[nodiscard]] NearWalls found() const {
    if (bounds_.isEmpty()) return {};
    return {{Imath::V3f(bounds_.min), Imath::V3f(bounds_.max)},
            planes_.value_or(std::vector<Imath::Plane3d>())};
  }

 private:
  static constexpr std::size_t kMaxPlanes = 16;  // above, an Embree query is faster than testing planes

  // True if the plane of a face comes near the shape.
  [[nodiscard]] bool cuts(const Face& face) const {
    const Imath::V3d half = near_.size() / 2 + Imath::V3d(tolerance_);
    const Imath::V3d& n = face.normal;
    const double across = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
    return std::abs((near_.center() - face.corners[0]).dot(n)) <= across;
  }
  void add_face(const Face& face) {
    bounds_.extendBy(common(near_, grown(face.box, tolerance_)));
    if (!planes_) return;
    const Imath::Plane3d plane(face.corners[0], face.normal);
    const bool known = std::ranges::any_of(*planes_, [&](const Imath::Plane3d& other) {
      return other.normal == plane.normal && other.distance == plane.distance;
    });
    if (!known && planes_->size() == kMaxPlanes)
      planes_.reset();
    else if (!known)
      planes_->push_back(plane);
  }

  Imath::Box3d near_;
  double tolerance_;
  Imath::Box3d bounds_;
  // nothing if planes do not describe the walls
  std::optional<std::vector<Imath::Plane3d>> planes_{std::in_place};
};

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

// The ball of a sphere in render coordinates; an instance may be an ellipsoid.
std::optional<Ball> unplaced_ball(const Shape& shape) {
  return std::holds_alternative<PlacedShape>(shape) ? std::nullopt : ball_of(shape);
}

// True if a sphere and a plane at `distance` from its center, or two spheres, may coincide: they intersect at
// a small angle or come within `tolerance`.
bool nearly_tangent(const Ball& ball, double distance, double tolerance) {
  return distance >= kNearlyParallel * ball.radius - tolerance && distance <= ball.radius + tolerance;
}
bool nearly_tangent(const Ball& a, const Ball& b, double tolerance) {
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
    const std::optional<Ball> ball_a = unplaced_ball(of_a);
    const std::optional<Ball> ball_b = unplaced_ball(of_b);
    if (ball_a && ball_b) return !nearly_tangent(*ball_a, *ball_b, tolerance);
    if (!ball_a && !has_faces(of_a)) return false;
    if (!ball_b && !has_faces(of_b)) return false;
    if (ball_a) return add_ball(*ball_a, a, b, both, tolerance);
    if (ball_b) return add_ball(*ball_b, b, a, both, tolerance);
    const auto faces_a = faces_near(of_a, both);
    const auto faces_b = faces_near(of_b, both);
    return faces_a && faces_b && add_faces(a, *faces_a, b, *faces_b, [](double cosine) {
             return std::abs(cosine) > kNearlyParallel;
           });
  }

  // Adds the region where faces are near a sphere; false if there are too many.
  bool add_ball(const Ball& ball, ShapeRegion& of_ball, ShapeRegion& other, const Box3d& both,
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

std::optional<std::uint32_t> find_coincident_shape(const Scene& scene) {
  const std::vector<BoxedShape> on =
      shapes_of(scene, [](const Material& material) { return !opaque(material); });
  if (on.empty()) return std::nullopt;
  const double tolerance = scene.coincidence_tolerance();
  const std::vector<BoxedShape> partners = shapes_of(
      scene, [](const Material& material) { return opaque(material) || encloses_medium(material); });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const BoxedShape& one : on) {
    const bool sheet = is_sheet(material_of(scene, one.shape));
    const Imath::Box3d near = grown(one.box, tolerance);
    for (const BoxedShape& other : partners) {
      if (!sheet && !opaque(material_of(scene, other.shape))) continue;
      if (++pairs > kMaxPairs ||
          (near.intersects(other.box) &&
           may_coincide(scene.shapes[one.shape].shape, scene.shapes[other.shape].shape, tolerance, faces)))
        return one.shape;
    }
  }
  return std::nullopt;
}

std::optional<std::uint32_t> find_light_on_probe(const Scene& scene) {
  if (!is_probe(scene.camera) || scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const std::optional<std::uint32_t> surface = surface_of(scene.lights[i]);
    if (!surface || !emits(scene.lights[i])) continue;
    const Shape& shape = scene.shapes[*surface].shape;
    if (motion_of(shape) == nullptr &&
        std::ranges::any_of(kRepresentativePoints, [&](const std::array<float, 2>& u) {
          return starts_behind(scene.camera, {u[0], u[1]}, shape, scene.lights[i]);
        }))
      return i;
  }
  return std::nullopt;
}

std::optional<LostSurfaces> find_lost_surfaces(const Scene& scene) {
  std::vector<BoxedShape> all = shapes_of(scene, [](const Material& /*any*/) { return true; });
  std::ranges::stable_sort(all, {}, [](const BoxedShape& shape) { return shape.box.min.x; });
  HidingFinder finder(scene);
  std::set<std::pair<std::uint32_t, std::uint32_t>> lost;
  std::vector<const BoxedShape*>
      // shapes that overlap the present one along x, and some that begin behind it
      nearby;
  std::size_t pairs = 0;
  auto next = all.begin();
  for (const BoxedShape& one : all) {
    if (opaque(material_of(scene, one.shape)) && !is_emitter(scene, one.shape)) continue;
    const double tolerance = scene.coincidence_tolerance(Imath::V3d(largest_coordinate(one.box)), one.shape);
    for (; next != all.end() && next->box.min.x <= one.box.max.x + tolerance; ++next)
      nearby.push_back(&*next);
    std::erase_if(nearby,
                  [&](const BoxedShape* other) { return other->box.max.x < one.box.min.x - tolerance; });
    pairs += nearby.size();
    if (pairs > kMaxPairs) return std::nullopt;
    std::vector<const BoxedShape*> others = nearby;
    std::erase(others, &one);
    for (const std::uint32_t on : finder.hiding(one, others)) lost.insert(std::minmax(one.shape, on));
  }
  if (lost.empty()) return std::nullopt;
  return LostSurfaces{lost.begin()->first, lost.begin()->second, lost.size() - 1};
}

std::vector<NearWalls> walls_near_shapes(const Scene& scene) {
  std::vector<NearWalls> found(scene.shapes.size());
  const std::vector<BoxedShape> crossed =
      shapes_of(scene, [](const Material& material) { return !opaque(material); });
  if (crossed.empty()) return found;
  const std::vector<BoxedShape> walls =
      shapes_of(scene, [](const Material& material) { return opaque(material); });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const auto& [shape, box] : crossed) {
    WallCollector near(box, 4 * scene.coincidence_tolerance(Imath::V3d(largest_coordinate(box)), shape));
    for (const BoxedShape& wall : walls) {
      if (++pairs > kMaxPairs)
        near.add_box(box);
      else if (near.near().intersects(wall.box))
        near.add(scene.shapes[wall.shape].shape, faces);
    }
    found[shape] = near.found();
  }
  return found;
}

std::vector<Imath::Box3f> coincidence_regions(const Scene& scene) {
  return RegionFinder(scene).compute();
}

}  // namespace abbe
