#include "scene/coincident_shapes.h"

#include <algorithm>
#include <cmath>
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

// A light that an opaque surface may hide, and its bounding box.
struct BoxedLight {
  std::uint32_t light;
  Imath::Box3d box;
};

// Emitting opaque surfaces, and static point and spot lights.
std::vector<BoxedLight> hidable_lights(const Scene& scene) {
  std::vector<BoxedLight> found;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!emits(light)) continue;
    const auto* emitter = std::get_if<AreaLight>(&light.kind);
    if (emitter != nullptr && opaque(material_of(scene, emitter->shape)))
      found.push_back({i, bounds(scene.shapes[emitter->shape].shape)});
    else if (const Imath::V3f* at = light_position(light); at && motion_of(light, scene.shapes) == nullptr)
      found.push_back({i, Imath::Box3d(Imath::V3d(*at))});
  }
  return found;
}

// True if light may be lost where the light coincides with a wall of that orientation, or, if it is the wall,
// with itself.
bool is_hidden(const Scene& scene, const BoxedLight& light_box, const BoxedShape& wall, Facing facing,
               FaceFinder& faces) {
  const Shape& shape = scene.shapes[wall.shape].shape;
  const auto* emitter = std::get_if<AreaLight>(&scene.lights[light_box.light].kind);
  const std::uint32_t own = emitter != nullptr ? emitter->shape : wall.shape;
  const double tolerance =
      scene.coincidence_tolerance(Imath::V3d(largest_coordinate(light_box.box)), own, wall.shape);
  if (!grown(light_box.box, tolerance).intersects(wall.box)) return false;
  if (emitter == nullptr) return is_on_surface(light_box.box.min, shape, faces);
  if (own != wall.shape) return overlaps(scene.shapes[own].shape, shape, tolerance, faces, facing);
  const auto* mesh = plain<Mesh>(shape);
  return mesh != nullptr && (has_duplicate_triangles(*mesh) || overlaps_itself(shape, tolerance, faces));
}

// True if a light is the outside of a closed body. The test works on a copy, because `make_solid` modifies
// its mesh.
bool is_closed_emitter(const Scene& scene, const BoxedLight& light_box) {
  const auto* emitter = std::get_if<AreaLight>(&scene.lights[light_box.light].kind);
  if (emitter == nullptr || emitter->two_sided) return false;
  const auto* mesh = plain<Mesh>(scene.shapes[emitter->shape].shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  const SolidReport report = make_solid(copy);
  return report.encloses() && !report.repaired();
}

// The first wall on which light is lost. Coincident faces of a closed body and a wall that look at each other
// are invisible and do not count.
std::optional<CoincidentLight> coincidence_of(const Scene& scene, const BoxedLight& light_box,
                                              const std::vector<const BoxedShape*>& walls,
                                              FaceFinder& faces) {
  const auto hiding = [&](Facing facing) {
    return std::ranges::find_if(
        walls, [&](const BoxedShape* wall) { return is_hidden(scene, light_box, *wall, facing, faces); });
  };
  auto wall = hiding(Facing::any);
  if (wall != walls.end() && is_closed_emitter(scene, light_box)) wall = hiding(Facing::same);
  if (wall == walls.end()) return std::nullopt;
  return CoincidentLight{light_box.light, (*wall)->shape};
}

// `IneffectiveCoat::reflectance`: the interface reflects r and transmits 1 - r. The base of reflectance d
// scatters the light; it leaves with the probability 1 - r_i, or returns. Total: r + (1 - r) (1 - r_i) d/(1 -
// d r_i) [Judd1942].
std::optional<double> coated_reflectance(const Material& coat) {
  constexpr double kNm = 550;
  const RefractiveIndex* index = interior_index(coat);
  if (index == nullptr) return std::nullopt;
  const double n = index->n(kNm);
  const double r = fresnel_dielectric(1.0, n).R();
  const double internal_reflectance = diffuse_reflectance_inside(n);
  return r + (1 - r) * (1 - internal_reflectance) * IneffectiveCoat::kBaseReflectance /
                 (1 - IneffectiveCoat::kBaseReflectance * internal_reflectance);
}

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

}  // namespace

std::optional<CoincidentPair> find_coincident_pair(const Scene& scene) {
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
        return CoincidentPair{one.shape, other.shape};
    }
  }
  return std::nullopt;
}

std::optional<CoincidentPair> find_hidden_sheet(const Scene& scene) {
  const std::vector<BoxedShape> sheets = shapes_of(scene, is_sheet);
  if (sheets.empty()) return std::nullopt;
  const double tolerance = scene.coincidence_tolerance();
  const std::vector<BoxedShape> partners = shapes_of(scene, [](const Material& material) {
    return opaque(material) || is_sheet(material) || interior_index(material) != nullptr;
  });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const BoxedShape& sheet : sheets) {
    const Imath::Box3d near = grown(sheet.box, tolerance);
    std::vector<std::uint32_t> on;
    for (const BoxedShape& other : partners) {
      if (other.shape == sheet.shape || !near.intersects(other.box)) continue;
      if (++pairs > kMaxPairs) return std::nullopt;
      if (overlaps(scene.shapes[sheet.shape].shape, scene.shapes[other.shape].shape, tolerance, faces))
        on.push_back(other.shape);
    }
    const auto hides = [&](std::uint32_t shape) {
      return interior_index(material_of(scene, shape)) == nullptr ||
             scene.shapes[shape].material != scene.shapes[on.front()].material;
    };
    if (on.size() == 1 || std::any_of(on.begin(), on.end(), hides))
      return CoincidentPair{sheet.shape, on.front()};
  }
  return std::nullopt;
}

std::optional<IneffectiveCoat> find_ineffective_coat(const Scene& scene) {
  const std::vector<BoxedShape> media = shapes_of(scene, encloses_medium);
  if (media.empty()) return std::nullopt;
  const std::vector<BoxedShape> walls =
      shapes_of(scene, [](const Material& material) { return opaque(material); });
  const double tolerance = scene.coincidence_tolerance();
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const BoxedShape& medium : media)
    for (const BoxedShape& wall : walls) {
      if (++pairs > kMaxPairs) return std::nullopt;
      const bool same_box = medium.box.min.equalWithAbsError(wall.box.min, tolerance) &&
                            medium.box.max.equalWithAbsError(wall.box.max, tolerance);
      if (same_box &&
          coats(scene.shapes[medium.shape].shape, scene.shapes[wall.shape].shape, tolerance, faces))
        return IneffectiveCoat{medium.shape, wall.shape,
                               coated_reflectance(material_of(scene, medium.shape))};
    }
  return std::nullopt;
}

std::optional<std::uint32_t> find_light_on_probe(const Scene& scene) {
  if (!is_probe(scene.camera) || scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const auto* emitter = std::get_if<AreaLight>(&scene.lights[i].kind);
    if (emitter == nullptr || !emits(scene.lights[i])) continue;
    const Shape& shape = scene.shapes[emitter->shape].shape;
    if (motion_of(shape) == nullptr &&
        std::ranges::any_of(kRepresentativePoints, [&](const std::array<float, 2>& u) {
          return starts_behind(scene.camera, {u[0], u[1]}, shape, scene.lights[i]);
        }))
      return i;
  }
  return std::nullopt;
}

std::optional<CoincidentLight> find_hidden_light(const Scene& scene) {
  std::vector<BoxedLight> light_boxes = hidable_lights(scene);
  std::vector<BoxedShape> walls = shapes_of(scene, [](const Material& material) { return opaque(material); });
  if (light_boxes.empty() || walls.empty()) return std::nullopt;
  const auto min_x = [](const auto& boxed) { return boxed.box.min.x; };
  std::ranges::stable_sort(light_boxes, {}, min_x);
  std::ranges::stable_sort(walls, {}, min_x);
  FaceFinder faces;
  std::vector<const BoxedShape*>
      // walls that overlap a light along x, and some that begin behind it
      nearby_walls;
  std::size_t pairs = 0;
  auto next = walls.begin();
  for (const BoxedLight& light_box : light_boxes) {
    const double tolerance =
        scene.coincidence_tolerance(Imath::V3d(largest_coordinate(light_box.box)), walls.front().shape);
    for (; next != walls.end() && next->box.min.x <= light_box.box.max.x + tolerance; ++next)
      nearby_walls.push_back(&*next);
    std::erase_if(nearby_walls,
                  [&](const BoxedShape* wall) { return wall->box.max.x < light_box.box.min.x - tolerance; });
    pairs += nearby_walls.size();
    if (pairs > kMaxPairs) return std::nullopt;
    if (const auto contact = coincidence_of(scene, light_box, nearby_walls, faces)) return contact;
  }
  return std::nullopt;
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

}  // namespace abbe
