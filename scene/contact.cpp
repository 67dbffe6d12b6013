#include "scene/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "materials/interface/fresnel.h"
#include "materials/interface/hemispherical.h"
#include "scene/coincidence.h"
#include "scene/extent.h"
#include "scene/shapes/solid.h"
#include "scene/small_light.h"

namespace abbe {
namespace {

bool is_sheet(const Material& material) {
  return !opaque(material) && !encloses_medium(material);
}

// Shapes of some kind, and the boxes around them.
struct Boxed {
  std::uint32_t shape;
  Imath::Box3d box;
};
template <typename Kind>
std::vector<Boxed> shapes_of(const Scene& scene, const Kind& kind) {
  std::vector<Boxed> found;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    if (kind(material_of(scene, i))) found.push_back({i, bounds(scene.shapes[i].shape)});
  return found;
}

// A lamp that something opaque may hide, and the box around it.
struct BoxedLamp {
  std::uint32_t light;
  Imath::Box3d box;
};

// Opaque surfaces that emit, and points that stand still.
std::vector<BoxedLamp> lamps_of(const Scene& scene) {
  std::vector<BoxedLamp> found;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!emits(light)) continue;
    const auto* emitter = std::get_if<AreaLight>(&light.kind);
    if (emitter != nullptr && opaque(material_of(scene, emitter->shape)))
      found.push_back({i, bounds(scene.shapes[emitter->shape].shape)});
    else if (const Imath::V3f* at = place(light); at && motion_of(light, scene.shapes) == nullptr)
      found.push_back({i, Imath::Box3d(Imath::V3d(*at))});
  }
  return found;
}

// Whether light may be lost of a lamp where it touches a wall whose faces are so turned, or where it, being
// one, touches itself.
bool is_hidden(const Scene& scene, const BoxedLamp& lamp, const Boxed& wall, Facing facing,
               FaceFinder& faces) {
  const Shape& shape = scene.shapes[wall.shape].shape;
  const auto* emitter = std::get_if<AreaLight>(&scene.lights[lamp.light].kind);
  const std::uint32_t own = emitter != nullptr ? emitter->shape : wall.shape;
  const double reach = scene.touch_distance(Imath::V3d(largest_coordinate(lamp.box)), own, wall.shape);
  if (!grown(lamp.box, reach).intersects(wall.box)) return false;
  if (emitter == nullptr) return stands_on(lamp.box.min, shape, faces);
  if (own != wall.shape) return lies_on(scene.shapes[own].shape, shape, reach, faces, facing);
  const auto* mesh = plain<Mesh>(shape);
  return mesh != nullptr && (has_doubled_triangles(*mesh) || lies_on_itself(shape, reach, faces));
}

// Whether a lamp is the outside of a closed body. A copy is looked at, since what is closed is found where a
// mesh is made solid.
bool is_body(const Scene& scene, const BoxedLamp& lamp) {
  const auto* emitter = std::get_if<AreaLight>(&scene.lights[lamp.light].kind);
  if (emitter == nullptr || emitter->two_sided) return false;
  const auto* mesh = plain<Mesh>(scene.shapes[emitter->shape].shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  const SolidReport report = make_solid(copy);
  return report.encloses() && !report.mended();
}

// The first of the walls that light of a lamp is lost on. Faces that a body and a wall turn to each other are
// seen by nobody.
std::optional<LampContact> contact_of(const Scene& scene, const BoxedLamp& lamp,
                                      const std::vector<const Boxed*>& walls, FaceFinder& faces) {
  const auto hiding = [&](Facing facing) {
    return std::ranges::find_if(
        walls, [&](const Boxed* wall) { return is_hidden(scene, lamp, *wall, facing, faces); });
  };
  auto wall = hiding(Facing::any);
  if (wall != walls.end() && is_body(scene, lamp)) wall = hiding(Facing::same);
  if (wall == walls.end()) return std::nullopt;
  return LampContact{lamp.light, (*wall)->shape};
}

// The reflectance that `LostCoat` has: the interface reflects r and lets 1 - r in; what is scattered below
// with the reflectance d leaves with the probability 1 - r_i, or returns: r + (1 - r) (1 - r_i) d/(1 - d r_i)
// [Judd1942].
std::optional<double> coated_reflectance(const Material& coat) {
  constexpr double kNm = 550;
  const RefractiveIndex* index = interior(coat);
  if (index == nullptr) return std::nullopt;
  const double n = index->n(kNm);
  const double r = fresnel_dielectric(1.0, n).R();
  const double inside = diffuse_reflectance_inside(n);
  return r + (1 - r) * (1 - inside) * LostCoat::kBelow / (1 - LostCoat::kBelow * inside);
}

// True if rays from a film position of a meter start behind a surface of the light that emits towards it:
// they start off the meter by the rounding of its coordinates.
bool starts_behind(const Camera& meter, Imath::V2f film, const Shape& shape, const Light& light) {
  const Imath::V3f start = meter_point(meter, film);
  const Imath::V3f normal = meter_normal(meter, start);
  const double rounding = static_cast<double>(offset_length(start));
  const BasicRay<double> way{Imath::V3d(start) - Imath::V3d(normal) * (2 * rounding), Imath::V3d(normal),
                             2 * rounding};
  const auto hit = intersect(shape, way, 0.0);
  return hit && emits_towards(light, Imath::V3f(hit->normal), -normal);
}

// Finds the walls that are near a shape of that box.
class WallCollector {
 public:
  WallCollector(const Imath::Box3d& box, double reach) : near_(grown(box, reach)), reach_(reach) {}

  [[nodiscard]] const Imath::Box3d& near() const { return near_; }

  void add(const Shape& shape, FaceFinder& faces) {
    if (motion_of(shape) != nullptr || !has_faces(shape)) {
      add_unseen(bounds(shape));
      return;
    }
    for (const Face& face : faces.near(shape, grown(near_, reach_)))
      if (cuts(face)) add_flat(face);
  }
  // What may lie anywhere in a box.
  void add_unseen(const Imath::Box3d& box) {
    at_.extendBy(common(near_, grown(box, reach_)));
    planes_.reset();
  }

  [[nodiscard]] NearWalls found() const {
    if (at_.isEmpty()) return {};
    return {{Imath::V3f(at_.min), Imath::V3f(at_.max)}, planes_.value_or(std::vector<Imath::Plane3d>())};
  }

 private:
  static constexpr std::size_t kMostPlanes = 16;  // with which asking each is quicker than asking Embree

  // Whether the plane of a face comes near.
  [[nodiscard]] bool cuts(const Face& face) const {
    const Imath::V3d half = near_.size() / 2 + Imath::V3d(reach_);
    const Imath::V3d& n = face.normal;
    const double across = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
    return std::abs((near_.center() - face.corners[0]).dot(n)) <= across;
  }
  void add_flat(const Face& face) {
    at_.extendBy(common(near_, grown(face.box, reach_)));
    if (!planes_) return;
    const Imath::Plane3d plane(face.corners[0], face.normal);
    const bool known = std::ranges::any_of(*planes_, [&](const Imath::Plane3d& other) {
      return other.normal == plane.normal && other.distance == plane.distance;
    });
    if (!known && planes_->size() == kMostPlanes)
      planes_.reset();
    else if (!known)
      planes_->push_back(plane);
  }

  Imath::Box3d near_;
  double reach_;
  Imath::Box3d at_;
  std::optional<std::vector<Imath::Plane3d>> planes_{std::in_place};  // nothing where they do not tell
};

}  // namespace

std::optional<Contact> crossed_at_once(const Scene& scene) {
  const std::vector<Boxed> on = shapes_of(scene, [](const Material& material) { return !opaque(material); });
  if (on.empty()) return std::nullopt;
  const double reach = scene.touch_distance();
  const std::vector<Boxed> under = shapes_of(
      scene, [](const Material& material) { return opaque(material) || encloses_medium(material); });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const Boxed& one : on) {
    const bool sheet = is_sheet(material_of(scene, one.shape));
    const Imath::Box3d near = grown(one.box, reach);
    for (const Boxed& other : under) {
      if (!sheet && !opaque(material_of(scene, other.shape))) continue;
      if (++pairs > kMostPairs ||
          (near.intersects(other.box) &&
           may_coincide(scene.shapes[one.shape].shape, scene.shapes[other.shape].shape, reach, faces)))
        return Contact{one.shape, other.shape};
    }
  }
  return std::nullopt;
}

std::optional<Contact> lost_sheet(const Scene& scene) {
  const std::vector<Boxed> sheets = shapes_of(scene, is_sheet);
  if (sheets.empty()) return std::nullopt;
  const double reach = scene.touch_distance();
  const std::vector<Boxed> under = shapes_of(scene, [](const Material& material) {
    return opaque(material) || is_sheet(material) || interior(material) != nullptr;
  });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const Boxed& sheet : sheets) {
    const Imath::Box3d near = grown(sheet.box, reach);
    std::vector<std::uint32_t> on;
    for (const Boxed& other : under) {
      if (other.shape == sheet.shape || !near.intersects(other.box)) continue;
      if (++pairs > kMostPairs) return std::nullopt;
      if (lies_on(scene.shapes[sheet.shape].shape, scene.shapes[other.shape].shape, reach, faces))
        on.push_back(other.shape);
    }
    const auto hides = [&](std::uint32_t shape) {
      return interior(material_of(scene, shape)) == nullptr ||
             scene.shapes[shape].material != scene.shapes[on.front()].material;
    };
    if (on.size() == 1 || std::any_of(on.begin(), on.end(), hides)) return Contact{sheet.shape, on.front()};
  }
  return std::nullopt;
}

std::optional<LostCoat> lost_coat(const Scene& scene) {
  const std::vector<Boxed> media = shapes_of(scene, encloses_medium);
  if (media.empty()) return std::nullopt;
  const std::vector<Boxed> walls =
      shapes_of(scene, [](const Material& material) { return opaque(material); });
  const double tolerance = scene.touch_distance();
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const Boxed& medium : media)
    for (const Boxed& wall : walls) {
      if (++pairs > kMostPairs) return std::nullopt;
      const bool same_box = medium.box.min.equalWithAbsError(wall.box.min, tolerance) &&
                            medium.box.max.equalWithAbsError(wall.box.max, tolerance);
      if (same_box &&
          coats(scene.shapes[medium.shape].shape, scene.shapes[wall.shape].shape, tolerance, faces))
        return LostCoat{medium.shape, wall.shape, coated_reflectance(material_of(scene, medium.shape))};
    }
  return std::nullopt;
}

std::optional<std::uint32_t> light_on_meter(const Scene& scene) {
  if (!is_meter(scene.camera) || scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const auto* emitter = std::get_if<AreaLight>(&scene.lights[i].kind);
    if (emitter == nullptr || !emits(scene.lights[i])) continue;
    const Shape& shape = scene.shapes[emitter->shape].shape;
    if (motion_of(shape) == nullptr &&
        std::ranges::any_of(kSpreadOverLight, [&](const std::array<float, 2>& u) {
          return starts_behind(scene.camera, {u[0], u[1]}, shape, scene.lights[i]);
        }))
      return i;
  }
  return std::nullopt;
}

std::optional<LampContact> lost_lamp(const Scene& scene) {
  std::vector<BoxedLamp> lamps = lamps_of(scene);
  std::vector<Boxed> walls = shapes_of(scene, [](const Material& material) { return opaque(material); });
  if (lamps.empty() || walls.empty()) return std::nullopt;
  const auto low = [](const auto& boxed) { return boxed.box.min.x; };
  std::ranges::stable_sort(lamps, {}, low);
  std::ranges::stable_sort(walls, {}, low);
  FaceFinder faces;
  std::vector<const Boxed*> beside;  // the walls that meet a lamp along x, and some that begin behind it
  std::size_t pairs = 0;
  auto next = walls.begin();
  for (const BoxedLamp& lamp : lamps) {
    const double reach = scene.touch_distance(Imath::V3d(largest_coordinate(lamp.box)), walls.front().shape);
    for (; next != walls.end() && next->box.min.x <= lamp.box.max.x + reach; ++next) beside.push_back(&*next);
    std::erase_if(beside, [&](const Boxed* wall) { return wall->box.max.x < lamp.box.min.x - reach; });
    pairs += beside.size();
    if (pairs > kMostPairs) return std::nullopt;
    if (const auto contact = contact_of(scene, lamp, beside, faces)) return contact;
  }
  return std::nullopt;
}

std::vector<NearWalls> walls_near_shapes(const Scene& scene) {
  std::vector<NearWalls> found(scene.shapes.size());
  const std::vector<Boxed> crossed =
      shapes_of(scene, [](const Material& material) { return !opaque(material); });
  if (crossed.empty()) return found;
  const std::vector<Boxed> walls =
      shapes_of(scene, [](const Material& material) { return opaque(material); });
  FaceFinder faces;
  std::size_t pairs = 0;
  for (const auto& [shape, box] : crossed) {
    WallCollector near(box, 4 * scene.touch_distance(Imath::V3d(largest_coordinate(box)), shape));
    for (const Boxed& wall : walls) {
      if (++pairs > kMostPairs)
        near.add_unseen(box);
      else if (near.near().intersects(wall.box))
        near.add(scene.shapes[wall.shape].shape, faces);
    }
    found[shape] = near.found();
  }
  return found;
}

}  // namespace abbe
