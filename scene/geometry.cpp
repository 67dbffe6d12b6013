#include "scene/geometry.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "io/error.h"
#include "scene/embree_query.h"
#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/placed.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {
namespace {

// One instruction set everywhere, so that a CPU with wider vectors gives the same bits.
constexpr const char* kDeviceConfig = "isa=avx2";

// What rays meet; those that ask for shadows leave out the boundaries of matter, which throw none.
constexpr unsigned kOpaque = 1;
constexpr unsigned kBoundary = 2;

// What the callbacks need beyond Embree's float ray, and what they found beyond Embree's float hit.
struct ExactContext : RTCIntersectContext {
  ExactContext(const BasicRay<double>& r, const std::vector<Part>& all)
      : RTCIntersectContext(), ray(r), parts(all) {
    rtcInitIntersectContext(this);
  }
  BasicRay<double> ray;
  const std::vector<Part>& parts;
  ShapeHit<double> nearest{};              // on a sphere or disc
  std::vector<SurfaceHit>* all = nullptr;  // where every hit goes, if they are asked for
};

std::optional<SurfaceHit> decide(const RTCHit& hit, const ExactContext& context);

// The ray is the world's; within an instance, where that stands, else nullptr.
struct Exact {
  const BasicRay<double>& ray;
  const Placement* at;

  explicit Exact(const RTCIntersectContext* context)
      : ray(static_cast<const ExactContext*>(context)->ray), at(nullptr) {
    const std::uint32_t instance = context->instID[0];
    if (instance == RTC_INVALID_GEOMETRY_ID) return;
    at = std::get<PlacedPart>(static_cast<const ExactContext*>(context)->parts[instance]).at.get();
  }
  template <typename S>
  [[nodiscard]] std::optional<ShapeHit<double>> intersection(const S& shape) const {
    return at == nullptr ? intersect(shape, ray, 0.0) : intersect_placed(shape, *at, ray, 0.0);
  }
};

// Rays come one by one, so N is 1 in all callbacks and the N-ray structures are plain ones.
void reject_behind(const RTCFilterFunctionNArguments* args) {
  const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
  const Exact exact(args->context);
  const std::uint32_t triangle = reinterpret_cast<const RTCHit*>(args->hit)->primID;
  const double t =
      plane_crossing(set, triangle, exact.at == nullptr ? exact.ray : to_prototype(*exact.at, exact.ray));
  if (!(t > 0 && t < exact.ray.t_max)) args->valid[0] = 0;
}

void collect(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  if (const auto hit = decide(*reinterpret_cast<const RTCHit*>(args->hit), context))
    context.all->push_back(*hit);
  args->valid[0] = 0;
}

template <typename S>
void user_bounds(const RTCBoundsFunctionArguments* args) {
  const Imath::Box3d box = bounds(*static_cast<const S*>(args->geometryUserPtr));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto below = [](double x) { return std::nextafter(static_cast<float>(x), -kInfinity); };
  const auto above = [](double x) { return std::nextafter(static_cast<float>(x), kInfinity); };
  *args->bounds_o = {below(box.min.x), below(box.min.y), below(box.min.z), 0,
                     above(box.max.x), above(box.max.y), above(box.max.z), 0};
}

template <typename S>
void user_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& [ray, hit] = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto found = Exact(args->context).intersection(*static_cast<const S*>(args->geometryUserPtr));
  if (!found || !(found->t < static_cast<double>(ray.tfar))) return;
  auto& context = *static_cast<ExactContext*>(args->context);
  context.nearest = *found;
  RTCHit met{};
  met.geomID = args->geomID;
  met.primID = args->primID;
  met.instID[0] = args->context->instID[0];
  if (context.all != nullptr) {
    if (const auto one = decide(met, context)) context.all->push_back(*one);
    return;
  }
  ray.tfar = static_cast<float>(found->t);
  hit = met;
}

template <typename S>
void user_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  if (Exact(args->context).intersection(*static_cast<const S*>(args->geometryUserPtr)))
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
}

template <typename S>
PlainPart plain_part(const S& shape) {
  if constexpr (std::is_constructible_v<PlainPart, const S&>)
    return shape;
  else
    return triangles_of(shape);
}

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

template <typename S>
RTCGeometry user_geometry(RTCDevice device, S& shape) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, &shape);
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { user_bounds<S>(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, user_intersect<S>);
  rtcSetGeometryOccludedFunction(geometry, user_occluded<S>);
  return geometry;
}

RTCGeometry geometry_of(RTCDevice device, TriangleSet& set) {
  return triangle_geometry(device, set);
}
RTCGeometry geometry_of(RTCDevice device, Sphere& sphere) {
  return user_geometry(device, sphere);
}
RTCGeometry geometry_of(RTCDevice device, Disc& disc) {
  return user_geometry(device, disc);
}
RTCGeometry geometry_of(RTCDevice device, const PlacedPart& placed) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, placed.of->scene.get());
  const Imath::M44d& m = placed.at->to_world;  // its rows are the columns Embree asks for
  std::array<float, 12> columns{};
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 3; ++i)
      columns.at(static_cast<std::size_t>(3 * row + i)) = static_cast<float>(m[row][i]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  return geometry;
}

SurfaceHit surface_hit(const ShapeHit<double>& hit, std::uint32_t shape, std::uint32_t primitive) {
  return {Imath::V3f(hit.point), Imath::V3f(hit.normal), static_cast<float>(hit.t), shape, primitive};
}

// Of barycentric coordinates: well beyond what points keep off edges, in all but the smallest triangles.
constexpr float kNearEdge = 0.01F;

// How the point at t is to be moved to be as far from the edges of its triangle as rays start from the
// surface.
Imath::V3d shift_in_world(const TriangleSet& set, const RTCHit& hit, const PlacedPart* instance,
                          const BasicRay<double>& local, double t, const Imath::V3f& point) {
  const Imath::V3f axis(1, 0, 0);
  const double distance = 0.5 * static_cast<double>((offset_point(point, axis, axis) - point).x);
  Imath::V3d shift = shift_off_edges(set, hit.primID, local.origin + local.direction * t,
                                     distance * local.direction.length());
  if (instance != nullptr) instance->at->to_world.multDirMatrix(shift, shift);
  return shift;
}

// What Embree found, in double; nothing for the plane of a triangle that the ray does not cross.
std::optional<SurfaceHit> decide(const RTCHit& hit, const ExactContext& context) {
  const bool placed = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const std::uint32_t shape = placed ? hit.instID[0] : hit.geomID;
  const Part& part = context.parts[shape];
  const auto* instance = std::get_if<PlacedPart>(&part);
  const auto* set =
      instance == nullptr ? std::get_if<TriangleSet>(&part) : std::get_if<TriangleSet>(&instance->of->part);
  if (set == nullptr) return surface_hit(context.nearest, shape, 0);
  const BasicRay<double>& ray = context.ray;
  const BasicRay<double> local = instance == nullptr ? ray : to_prototype(*instance->at, ray);
  const double t = plane_crossing(*set, hit.primID, local);
  if (!(t > 0 && t < ray.t_max)) return std::nullopt;
  Imath::V3d point = ray.origin + ray.direction * t;
  if (std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < kNearEdge)
    point += shift_in_world(*set, hit, instance, local, t, Imath::V3f(point));
  if (instance == nullptr)
    return SurfaceHit{Imath::V3f(point), set->normals[hit.primID], static_cast<float>(t), shape, hit.primID};
  const Imath::V3d normal = triangle_normal(instance->of->prototype->shape, hit.primID);
  return surface_hit({t, point, normal_to_world(*instance->at, normal)}, shape, hit.primID);
}

}  // namespace

Geometry::Geometry(const std::vector<ShapeInstance>& shapes, const std::vector<Material>& materials)
    : device_(nullptr, rtcReleaseDevice), scene_(nullptr, rtcReleaseScene) {
  open_device();
  parts_.reserve(shapes.size());
  for (const ShapeInstance& instance : shapes) {
    if (const auto* mesh = std::get_if<Mesh>(&instance.shape)) parts_.emplace_back(with_normals(*mesh));
    if (const auto* quad = std::get_if<Quad>(&instance.shape)) parts_.emplace_back(with_normals(*quad));
    if (const auto* sphere = std::get_if<Sphere>(&instance.shape)) parts_.emplace_back(*sphere);
    if (const auto* disc = std::get_if<Disc>(&instance.shape)) parts_.emplace_back(*disc);
    if (const auto* placed = std::get_if<PlacedShape>(&instance.shape))
      parts_.emplace_back(PlacedPart{build_prototype(placed->of), placed->at});
  }
  scene_ = new_scene();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    RTCGeometryTy* geometry =
        std::visit([this](auto& part) { return geometry_of(device_.get(), part); }, parts_[i]);
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

const PrototypePart* Geometry::build_prototype(const std::shared_ptr<const Prototype>& prototype) {
  std::unique_ptr<PrototypePart>& built = prototypes_[prototype.get()];
  if (built) return built.get();
  built = std::make_unique<PrototypePart>(PrototypePart{
      prototype, std::visit([](const auto& shape) { return plain_part(shape); }, prototype->shape),
      new_scene()});
  attach(built->scene.get(), 0,
         std::visit([this](auto& part) { return geometry_of(device_.get(), part); }, built->part));
  commit(built->scene.get());
  return built.get();
}

// What Embree calls unknown is an exception of its own within, such as a thread that could not be started;
// what it calls invalid is a fault of ours.
void Geometry::check() const {
  if (failure_.code == RTC_ERROR_NONE) return;
  const bool memory = failure_.code == RTC_ERROR_OUT_OF_MEMORY;
  const bool resource = memory || failure_.code == RTC_ERROR_UNKNOWN;
  throw Error(resource ? ErrorCode::resource : ErrorCode::internal, "Embree",
              memory ? "out of memory while building the geometry" : failure_.message);
}

std::optional<SurfaceHit> Geometry::intersect(const Ray& ray) const {
  const BasicRay<double> exact{Imath::V3d(ray.origin), Imath::V3d(ray.direction),
                               static_cast<double>(ray.t_max)};
  ExactContext context(exact, parts_);
  while (true) {
    RTCRayHit query = embree_query(exact);
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    if (auto hit = decide(query.hit, context)) return hit;
    // The plane the ray has just left, mistaken by rounding: rare enough to ask again with every candidate
    // looked at in double.
    context.filter = reject_behind;
  }
}

// Embree is asked for all it meets on a stretch of the ray around the hit, on which it need not be exact.
TouchingSurfaces Geometry::touching(const Scene& scene, const Ray& ray, const SurfaceHit& hit) const {
  TouchingSurfaces found;
  found.at[found.count++] = hit;
  const Imath::V3d normal(hit.normal);
  const Imath::V3d point(hit.point);
  const Imath::V3d direction(ray.direction);
  const double reach = 2 * scene.touch_distance(point, hit.shape) / std::abs(normal.dot(direction));
  const double start = std::max(0.0, static_cast<double>(hit.t) - reach);
  const Imath::V3d origin = Imath::V3d(ray.origin) + direction * start;
  std::vector<SurfaceHit> all;
  ExactContext context({origin, direction, static_cast<double>(hit.t) + reach - start}, parts_);
  context.all = &all;
  context.filter = collect;
  RTCRayHit query = embree_query(context.ray);
  rtcIntersect1(scene_.get(), &context, &query);
  const auto sooner = [](const SurfaceHit& a, const SurfaceHit& b) {
    return std::tie(a.t, a.shape) < std::tie(b.t, b.shape);
  };
  std::sort(all.begin(), all.end(), sooner);
  for (SurfaceHit& other : all) {
    other.t += static_cast<float>(start);
    const auto same = [&](const SurfaceHit& met) {
      return met.shape == other.shape && (met.normal.dot(other.normal) > 0);
    };
    const bool parallel = std::abs(normal.dot(Imath::V3d(other.normal))) > TouchingSurfaces::kParallel;
    const double apart = std::abs((Imath::V3d(other.point) - point).dot(normal));
    if (found.count < TouchingSurfaces::kMost && parallel &&
        apart <= scene.touch_distance(point, hit.shape, other.shape) &&
        std::none_of(found.at.begin(), found.at.begin() + static_cast<std::ptrdiff_t>(found.count), same))
      found.at[found.count++] = other;
  }
  return found;
}

bool Geometry::occluded(const BasicRay<double>& ray) const {
  ExactContext context(ray, parts_);
  RTCRay query = embree_ray(ray);
  query.mask = kOpaque;
  rtcOccluded1(scene_.get(), &context, &query);
  return query.tfar < 0;
}

void Geometry::replay(std::span<const LoggedRay> rays) const {
  for (const LoggedRay& logged : rays) {
    const Ray& ray = logged.ray;
    ExactContext context({Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max)},
                         parts_);
    RTCRayHit query = embree_query(context.ray);
    if (logged.shadow)
      rtcOccluded1(scene_.get(), &context, &query.ray);
    else
      rtcIntersect1(scene_.get(), &context, &query);
  }
}

std::size_t Geometry::triangle_count() const {
  std::size_t count = 0;
  for (const Part& part : parts_) {
    const auto* set = std::get_if<TriangleSet>(&part);
    if (const auto* instance = std::get_if<PlacedPart>(&part))
      set = std::get_if<TriangleSet>(&instance->of->part);
    if (set != nullptr) count += set->triangles.size();
  }
  return count;
}

std::size_t Geometry::memory_bytes() const {
  std::size_t bytes =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(embree_bytes_, 0)) + parts_.size() * sizeof(Part);
  for (const Part& part : parts_)
    if (const auto* set = std::get_if<TriangleSet>(&part)) bytes += memory_bytes_of(*set);
  for (const auto& [prototype, built] : prototypes_) {
    bytes += sizeof(PrototypePart) + sizeof(Prototype);
    if (const auto* mesh = std::get_if<Mesh>(&prototype->shape)) bytes += abbe::memory_bytes(*mesh);
    if (const auto* set = std::get_if<TriangleSet>(&built->part)) bytes += memory_bytes_of(*set);
  }
  return bytes;
}

}  // namespace abbe
