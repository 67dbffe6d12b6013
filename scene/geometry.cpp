#include "scene/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include <embree3/rtcore.h>

#include "io/error.h"
#include "scene/coincidence.h"
#include "scene/exact_query.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

// One instruction set on all CPUs, so that wider vectors do not change bits.
constexpr const char* kDeviceConfig = "isa=avx2";

RTCGeometry triangle_geometry(RTCDevice device, TriangleSet& set) {
  const std::size_t vertex_count = set.vertices.size();
  set.vertices.emplace_back(0.0F);  // Embree reads 16 bytes at the last vertex
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, set.vertices.data(), 0,
                             sizeof(Imath::V3f), vertex_count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, set.triangles.data(), 0,
                             sizeof(set.triangles[0]), set.triangles.size());
  rtcSetGeometryOccludedFilterFunction(geometry, reject_behind);
  rtcSetGeometryUserData(geometry, &set);
  return geometry;
}

RTCGeometry instance_geometry(RTCDevice device, const SceneInstance& placed) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, placed.of->scene.get());
  const Imath::M44d& m = placed.at->to_world;  // its rows are Embree's columns
  std::array<float, 12> columns{};
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 3; ++i)
      columns.at(static_cast<std::size_t>(3 * row + i)) = static_cast<float>(m[row][i]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  return geometry;
}

// A shape that is intersected in double precision.
RTCGeometry exact_geometry(RTCDevice device, AttachedGeometry& attached) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  set_callbacks(geometry, attached);
  return geometry;
}

RTCGeometry geometry_of(RTCDevice device, AttachedGeometry& attached) {
  if (auto* set = std::get_if<TriangleSet>(&attached)) return triangle_geometry(device, *set);
  const auto* placed = std::get_if<SceneInstance>(&attached);
  return placed != nullptr && !placed->at->motion ? instance_geometry(device, *placed)
                                                  : exact_geometry(device, attached);
}

// The region where Embree may miss a triangle for a ray that starts just in front of it; empty if there is
// none.
Imath::Box3d imprecise_region(const std::array<Imath::V3d, 3>& corners) {
  constexpr double kTimesLarger = 16;
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners) box.extendBy(corner);
  const Imath::V3d size = box.size();
  const double slack = size.length() / kTimesLarger;
  const Imath::V3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  Imath::Box3d part;
  if (std::min({size.x, size.y, size.z}) == 0 || std::abs(corners[0].dot(normal)) > slack) return part;
  for (int axis = 0; axis < 3; ++axis) {
    part.min[axis] = std::max(box.min[axis], -slack);
    part.max[axis] = std::min(box.max[axis], slack);
  }
  return part;
}

bool comes_near(const Shape& shape, const Imath::Box3d& part, FaceFinder& faces) {
  if (!part.intersects(bounds(shape))) return false;
  return motion_of(shape) != nullptr || !has_faces(shape) || !faces.near(shape, part).empty();
}

// True if Embree may miss triangles of `set` for rays that start just in front of them, where another shape
// comes near. `set` represents shape number `shape` of `shapes`. Embree's floats resolve the origin of a ray
// to a fraction of a triangle's size, unless the triangle is parallel to two axes. Near the scene's origin,
// rays start closer to surfaces than that. False for sets of more than 64 triangles. Most of them are so
// small that only a spot around the origin is affected.
bool needs_double_precision(const TriangleSet& set, std::size_t shape,
                            const std::vector<ShapeInstance>& shapes, FaceFinder& faces) {
  constexpr std::size_t kMaxTriangles = 64;
  if (set.triangles.size() > kMaxTriangles) return false;
  return std::ranges::any_of(set.triangles, [&](const auto& triangle) {
    const auto& [a, b, c] = triangle;
    const Imath::Box3d region = imprecise_region(
        {Imath::V3d(set.vertices[a]), Imath::V3d(set.vertices[b]), Imath::V3d(set.vertices[c])});
    if (region.isEmpty()) return false;
    for (std::size_t other = 0; other < shapes.size(); ++other)
      if (other != shape && comes_near(shapes[other].shape, region, faces)) return true;
    return false;
  });
}

// Makes Embree's representation of a shape that is no instance.
struct Attacher {
  bool with_normals;

  template <typename S>
  AttachedGeometry operator()(const S& shape) const {
    if constexpr (Triangulated<S>) {
      TriangleSet set = triangles_of(shape);
      if (with_normals) set.normals.reserve(set.triangles.size());
      if (with_normals)
        for (std::size_t i = 0; i < set.triangles.size(); ++i) set.normals.emplace_back(normal_at(shape, i));
      return set;
    } else {
      return shape;
    }
  }
};

BasicRay<double> exact(const Ray& ray) {
  return {Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max), ray.time};
}

}  // namespace

Geometry::Geometry(const std::vector<ShapeInstance>& shapes, const std::vector<Material>& materials,
                   std::vector<NearWalls> walls)
    : walls_(std::move(walls)), device_(nullptr, rtcReleaseDevice), scene_(nullptr, rtcReleaseScene) {
  open_device();
  attached_.reserve(shapes.size());
  for (const ShapeInstance& instance : shapes) {
    if (const auto* placed = std::get_if<PlacedShape>(&instance.shape))
      attached_.emplace_back(SceneInstance{build_prototype(placed->of), placed->at});
    else
      attached_.push_back(visit_plain(Attacher{true}, instance.shape));
  }
  FaceFinder faces;
  scene_ = new_scene();
  for (std::size_t i = 0; i < attached_.size(); ++i) {
    auto* set = std::get_if<TriangleSet>(&attached_[i]);
    RTCGeometryTy* geometry = set != nullptr && needs_double_precision(*set, i, shapes, faces)
                                  ? exact_geometry(device_.get(), attached_[i])
                                  : geometry_of(device_.get(), attached_[i]);
    rtcSetGeometryMask(geometry, is_boundary(materials[shapes[i].material]) ? kBoundary : kOpaque);
    attach(scene_.get(), static_cast<std::uint32_t>(i), geometry);
  }
  commit(scene_.get());
}

Geometry::~Geometry() = default;

void Geometry::open_device() {
  device_.reset(rtcNewDevice(kDeviceConfig));
  if (!device_) {
    failure_ = {rtcGetDeviceError(nullptr), "no device"};
    check();
  }
  rtcSetDeviceErrorFunction(
      device_.get(),
      [](void* failure, RTCError code, const char* text) {
        auto& first = *static_cast<Failure*>(failure);
        if (first.code == RTC_ERROR_NONE) first = {code, text == nullptr ? "" : text};
      },
      &failure_);
  rtcSetDeviceMemoryMonitorFunction(
      device_.get(),
      [](void* total, ssize_t bytes, bool) {
        *static_cast<std::atomic<std::ptrdiff_t>*>(total) += bytes;
        return true;
      },
      &embree_bytes_);
}

Geometry::ScenePointer Geometry::new_scene() {
  ScenePointer scene(rtcNewScene(device_.get()), rtcReleaseScene);
  check();
  rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                           RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void Geometry::commit(RTCSceneTy* scene) {
  rtcCommitScene(scene);
  check();
}

void Geometry::attach(RTCSceneTy* scene, std::uint32_t index, RTCGeometryTy* geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, index);
  rtcReleaseGeometry(geometry);
  check();
}

const InstancedScene* Geometry::build_prototype(const std::shared_ptr<const Prototype>& prototype) {
  std::unique_ptr<InstancedScene>& built = prototypes_[prototype.get()];
  if (built) return built.get();
  built = std::make_unique<InstancedScene>(
      InstancedScene{prototype, std::visit(Attacher{false}, prototype->shape), new_scene()});
  attach(built->scene.get(), 0, geometry_of(device_.get(), built->geometry));
  commit(built->scene.get());
  return built.get();
}

// Embree reports its own internal exceptions, such as a thread that cannot be started, as unknown errors.
// Invalid arguments are our bugs.
void Geometry::check() const {
  if (failure_.code == RTC_ERROR_NONE) return;
  const bool memory = failure_.code == RTC_ERROR_OUT_OF_MEMORY;
  const bool resource = memory || failure_.code == RTC_ERROR_UNKNOWN;
  throw Error(resource ? ErrorCode::resource : ErrorCode::internal, "Embree",
              memory ? "out of memory while building the geometry" : failure_.message);
}

std::optional<SurfaceHit> Geometry::intersect(const Ray& ray) const {
  ExactContext context(attached_);
  context.rays[0] = exact(ray);
  while (true) {
    RTCRayHit query = without_hit(embree_ray(context.rays[0]));
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    if (auto hit = resolve_nearest(query.hit, query.ray.tfar, context, 0)) return hit;
    // The hit is the plane that the ray has just left, by rounding. This is rare, so the query repeats with a
    // test of every candidate in double.
    context.filter = reject_behind;
  }
}

void Geometry::intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const {
  ExactContext context(attached_);
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i) context.rays[i] = exact(rays[first + i]);
    Packet packet(context, count, ~0U);
    rtcIntersect8(packet.valid.data(), scene_.get(), &context, &packet.query);
    for (std::size_t i = 0; i < count; ++i) {
      std::optional<SurfaceHit>& hit = hits[first + i];
      hit.reset();
      if (packet.query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hit = resolve_nearest(packet.hit(i), packet.t(i), context, i);
      if (!hit) hit = intersect(rays[first + i]);
    }
  }
}

std::vector<SurfaceHit> Geometry::all_hits(const BasicRay<double>& ray, unsigned mask) const {
  std::vector<SurfaceHit> all;
  ExactContext context(attached_);
  context.rays[0] = ray;
  context.all = &all;
  context.filter = collect_hits;
  RTCRayHit query = without_hit(embree_ray(ray));
  query.ray.mask = mask;
  rtcIntersect1(scene_.get(), &context, &query);
  return all;
}

// If surfaces may coincide here, Embree returns all hits on a short segment of the ray around the hit,
// without exactness. The segment starts there, so that its lengths give the separation of surfaces whose
// points have the same rounding.
CoincidentHits Geometry::coincident(const Scene& scene, const Ray& ray, const SurfaceHit& hit) const {
  CoincidentHits result;
  result.at[result.count++] = hit;
  const std::optional<Imath::Box3f>& at = scene.shapes[hit.shape].coincidence_bounds;
  if (at && !at->intersects(hit.point)) return result;
  const Imath::V3d normal(hit.normal);
  const Imath::V3d point(hit.point);
  const Imath::V3d direction(ray.direction);
  const double cosine = std::abs(normal.dot(direction));
  const double search_distance = 2 * scene.coincidence_tolerance(point, hit.shape) / cosine;
  const double start = std::max(0.0, static_cast<double>(hit.t) - search_distance);
  const Imath::V3d origin = Imath::V3d(ray.origin) + direction * start;
  std::vector<SurfaceHit> all =
      all_hits({origin, direction, static_cast<double>(hit.t) + search_distance - start, ray.time}, ~0U);
  const auto sooner = [](const SurfaceHit& a, const SurfaceHit& b) {
    return std::tie(a.t, a.shape) < std::tie(b.t, b.shape);
  };
  std::sort(all.begin(), all.end(), sooner);
  const auto one_side = [](const SurfaceHit& a, const SurfaceHit& b) {
    return a.shape == b.shape && a.normal.dot(b.normal) > 0;
  };
  const auto itself =
      std::ranges::find_if(all, [&](const SurfaceHit& surface) { return one_side(surface, hit); });
  const double at_hit =
      itself != all.end() ? static_cast<double>(itself->t) : static_cast<double>(hit.t) - start;
  for (SurfaceHit& other : all) {
    const double separation = std::abs(static_cast<double>(other.t) - at_hit) * cosine;
    other.t += static_cast<float>(start);
    other.retreat_m = hit.retreat_m;
    const bool parallel = std::abs(normal.dot(Imath::V3d(other.normal))) > CoincidentHits::kParallel;
    if (result.count < CoincidentHits::kMaxHits && parallel &&
        separation <= scene.coincidence_tolerance(point, hit.shape, other.shape) &&
        std::none_of(result.at.begin(), result.at.begin() + static_cast<std::ptrdiff_t>(result.count),
                     [&](const SurfaceHit& surface) { return one_side(surface, other); }))
      result.at[result.count++] = other;
  }
  return result;
}

// Queries along the ray up to the hit, because Embree may have exchanged the wall and the surface in front of
// it. Also queries through the hit along three axes, one of which hits any near wall. Parallel walls coincide
// with the surface, or rays start in front of them.
bool Geometry::wall_within_rounding(const Scene& scene, const SurfaceHit& hit, const Imath::V3f& direction,
                                    float time) const {
  const Imath::V3d along(direction);
  const Imath::V3d normal(hit.normal);
  const Imath::V3d point(hit.point);
  const auto start =
      static_cast<double>(hit.coincidence_radius + 1.25F * offset_length(hit.point));  // with rounding
  const auto near = static_cast<double>(hit.coincidence_radius + 2 * offset_length(hit.point));
  const double search_distance = 32 * near;
  const auto wall = [&](const SurfaceHit& surface) { return opaque(material_of(scene, surface.shape)); };
  const auto near_wall = [&](const SurfaceHit& surface) {
    const Imath::V3d facing(surface.normal);
    const bool parallel = std::abs(facing.dot(normal)) > CoincidentHits::kParallel;
    return wall(surface) &&
           std::abs((Imath::V3d(surface.point) - point).dot(facing)) <= (parallel ? start : near);
  };
  const double back = std::min(search_distance / std::abs(normal.dot(along)), static_cast<double>(hit.t) / 2);
  const double plane_tolerance =
      near + scene.coincidence_tolerance(point, hit.shape);  // corners are stored as floats
  const auto plane_comes_near = [&](const Imath::Plane3d& plane) {
    const double at_hit = plane.distanceTo(point);
    const double before = plane.distanceTo(point - along * back);
    return std::abs(at_hit) <= plane_tolerance || at_hit * before <= 0;
  };
  const std::vector<Imath::Plane3d>& planes = walls_[hit.shape].planes;
  if (!planes.empty() && std::ranges::none_of(planes, plane_comes_near)) return false;
  if (std::ranges::any_of(all_hits({point - along * back, along, back, time}, kOpaque), wall)) return true;
  const Basis<double> frame(normal);
  return std::ranges::any_of(std::array{frame.x, frame.y, normal}, [&](const Imath::V3d& axis) {
    return std::ranges::any_of(
        all_hits({point - axis * search_distance, axis, 2 * search_distance, time}, kOpaque), near_wall);
  });
}

bool Geometry::occluded(const BasicRay<double>& ray) const {
  ExactContext context(attached_);
  context.rays[0] = ray;
  RTCRay query = embree_ray(ray);
  query.mask = kOpaque;
  rtcOccluded1(scene_.get(), &context, &query);
  return query.tfar < 0;
}

// Embree 3.13 reports every ray of a packet as occluded at an instance once one of them is. Therefore rays in
// scenes with instances are traced singly.
void Geometry::occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const {
  if (!prototypes_.empty()) {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = occluded(rays[i]) ? 1 : 0;
    return;
  }
  ExactContext context(attached_);
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - first);
    std::copy_n(rays.begin() + static_cast<std::ptrdiff_t>(first), count, context.rays.begin());
    Packet packet(context, count, kOpaque);
    rtcOccluded8(packet.valid.data(), scene_.get(), &context, &packet.query.ray);
    for (std::size_t i = 0; i < count; ++i) blocked[first + i] = packet.query.ray.tfar[i] < 0 ? 1 : 0;
  }
}

void Geometry::replay(std::span<const LoggedRay> rays) const {
  for (const LoggedRay& logged : rays) {
    ExactContext context(attached_);
    context.rays[0] = exact(logged.ray);
    RTCRayHit query = without_hit(embree_ray(context.rays[0]));
    if (logged.shadow)
      rtcOccluded1(scene_.get(), &context, &query.ray);
    else
      rtcIntersect1(scene_.get(), &context, &query);
  }
}

std::size_t Geometry::triangle_count() const {
  std::size_t count = 0;
  for (const AttachedGeometry& attached : attached_) {
    const auto* set = std::get_if<TriangleSet>(&attached);
    if (const auto* instance = std::get_if<SceneInstance>(&attached))
      set = std::get_if<TriangleSet>(&instance->of->geometry);
    if (set != nullptr) count += set->triangles.size();
  }
  return count;
}

std::size_t Geometry::memory_bytes() const {
  std::size_t bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(embree_bytes_, 0)) +
                      attached_.size() * sizeof(AttachedGeometry);
  for (const AttachedGeometry& attached : attached_)
    if (const auto* set = std::get_if<TriangleSet>(&attached)) bytes += memory_bytes_of(*set);
  for (const auto& [prototype, built] : prototypes_) {
    bytes += sizeof(InstancedScene) + sizeof(Prototype);
    if (const auto* mesh = std::get_if<Mesh>(&prototype->shape)) bytes += abbe::memory_bytes(*mesh);
    if (const auto* set = std::get_if<TriangleSet>(&built->geometry)) bytes += memory_bytes_of(*set);
  }
  return bytes;
}

}  // namespace abbe
