#include "scene/geometry.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/error.h"
#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {
namespace {

// One instruction set everywhere, so that a CPU with wider vectors gives the same bits.
constexpr const char* kDeviceConfig = "isa=avx2";

// What the callbacks need beyond Embree's float ray, and what they found beyond Embree's float hit.
struct ExactContext : RTCIntersectContext {
  explicit ExactContext(const BasicRay<double>& r) : RTCIntersectContext(), ray(r) {
    rtcInitIntersectContext(this);
  }
  BasicRay<double> ray;
  ShapeHit<double> nearest{};  // on a sphere or disc
};
const BasicRay<double>& exact_ray(const RTCIntersectContext* context) {
  return static_cast<const ExactContext*>(context)->ray;
}

RTCRay embree_ray(const BasicRay<double>& ray) {
  RTCRay r{};
  r.org_x = static_cast<float>(ray.origin.x);
  r.org_y = static_cast<float>(ray.origin.y);
  r.org_z = static_cast<float>(ray.origin.z);
  r.dir_x = static_cast<float>(ray.direction.x);
  r.dir_y = static_cast<float>(ray.direction.y);
  r.dir_z = static_cast<float>(ray.direction.z);
  r.tfar = static_cast<float>(ray.t_max);
  r.mask = ~0U;
  return r;
}

// Where the ray crosses the plane of a triangle; NaN or infinite when it does not.
double plane_crossing(const TriangleSet& set, std::uint32_t triangle, const BasicRay<double>& ray) {
  const auto& [a, b, c] = set.triangles[triangle];
  const Imath::V3d origin(set.vertices[a]);
  const Imath::V3d normal =
      (Imath::V3d(set.vertices[b]) - origin).cross(Imath::V3d(set.vertices[c]) - origin);
  return (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
}

// Rays come one by one, so N is 1 in all callbacks and the N-ray structures are plain ones.
void reject_behind(const RTCFilterFunctionNArguments* args) {
  const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
  const BasicRay<double>& ray = exact_ray(args->context);
  const double t = plane_crossing(set, reinterpret_cast<const RTCHit*>(args->hit)->primID, ray);
  if (!(t > 0 && t < ray.t_max)) args->valid[0] = 0;
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
  const auto found = intersect(*static_cast<const S*>(args->geometryUserPtr), exact_ray(args->context), 0.0);
  if (!found || !(found->t < static_cast<double>(ray.tfar))) return;
  ray.tfar = static_cast<float>(found->t);
  static_cast<ExactContext*>(args->context)->nearest = *found;
  hit.geomID = args->geomID;
  hit.primID = args->primID;
}

template <typename S>
void user_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  if (intersect(*static_cast<const S*>(args->geometryUserPtr), exact_ray(args->context), 0.0))
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
}

TriangleSet triangles_of(const Mesh& mesh) {
  TriangleSet set;
  for (const Imath::V3d& vertex : mesh.vertices) set.vertices.emplace_back(vertex);
  set.triangles = mesh.triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    set.normals.emplace_back(area_vector(mesh, i).normalized());
  return set;
}

TriangleSet triangles_of(const Quad& quad) {
  const std::array<Imath::V3f, 4> c = corners(quad);
  const Imath::V3f normal(normal_of(quad));
  return {{c.begin(), c.end()}, {kQuadTriangles.begin(), kQuadTriangles.end()}, {normal, normal}};
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

SurfaceHit surface_hit(const ShapeHit<double>& hit, std::uint32_t shape) {
  return {Imath::V3f(hit.point), Imath::V3f(hit.normal), static_cast<float>(hit.t), shape};
}

}  // namespace

Geometry::Geometry(const std::vector<ShapeInstance>& shapes)
    : device_(nullptr, rtcReleaseDevice), scene_(nullptr, rtcReleaseScene) {
  parts_.reserve(shapes.size());
  for (const ShapeInstance& instance : shapes) {
    if (const auto* mesh = std::get_if<Mesh>(&instance.shape)) parts_.emplace_back(triangles_of(*mesh));
    if (const auto* quad = std::get_if<Quad>(&instance.shape)) parts_.emplace_back(triangles_of(*quad));
    if (const auto* sphere = std::get_if<Sphere>(&instance.shape)) parts_.emplace_back(*sphere);
    if (const auto* disc = std::get_if<Disc>(&instance.shape)) parts_.emplace_back(*disc);
  }
  build();
}

Geometry::~Geometry() = default;

void Geometry::build() {
  device_.reset(rtcNewDevice(kDeviceConfig));
  if (!device_)
    throw Error(ErrorCode::internal, "Embree",
                "no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
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
  scene_.reset(rtcNewScene(device_.get()));
  check();
  rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                            RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  for (std::size_t i = 0; i < parts_.size(); ++i) attach(static_cast<std::uint32_t>(i), parts_[i]);
  rtcCommitScene(scene_.get());
  check();
}

void Geometry::attach(std::uint32_t index, Part& part) {
  RTCGeometry geometry = nullptr;
  if (auto* set = std::get_if<TriangleSet>(&part)) geometry = triangle_geometry(device_.get(), *set);
  if (auto* sphere = std::get_if<Sphere>(&part)) geometry = user_geometry(device_.get(), *sphere);
  if (auto* disc = std::get_if<Disc>(&part)) geometry = user_geometry(device_.get(), *disc);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, index);
  rtcReleaseGeometry(geometry);
  check();
}

void Geometry::check() const {
  if (failure_.code == RTC_ERROR_NONE) return;
  const bool memory = failure_.code == RTC_ERROR_OUT_OF_MEMORY;
  throw Error(memory ? ErrorCode::resource : ErrorCode::internal, "Embree",
              memory ? "out of memory while building the geometry" : failure_.message);
}

std::optional<SurfaceHit> Geometry::intersect(const Ray& ray) const {
  const BasicRay<double> exact{Imath::V3d(ray.origin), Imath::V3d(ray.direction),
                               static_cast<double>(ray.t_max)};
  ExactContext context(exact);
  while (true) {
    RTCRayHit query{embree_ray(exact), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    const std::uint32_t shape = query.hit.geomID;
    if (shape == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const auto* set = std::get_if<TriangleSet>(&parts_[shape]);
    if (set == nullptr) return surface_hit(context.nearest, shape);
    const double t = plane_crossing(*set, query.hit.primID, exact);
    if (t > 0 && t < exact.t_max)
      return SurfaceHit{Imath::V3f(exact.origin + exact.direction * t), set->normals[query.hit.primID],
                        static_cast<float>(t), shape};
    // The plane the ray has just left, mistaken by rounding: rare enough to ask again with every candidate
    // looked at in double.
    context.filter = reject_behind;
  }
}

bool Geometry::occluded(const BasicRay<double>& ray) const {
  ExactContext context(ray);
  RTCRay query = embree_ray(ray);
  rtcOccluded1(scene_.get(), &context, &query);
  return query.tfar < 0;
}

void Geometry::replay(std::span<const LoggedRay> rays) const {
  for (const LoggedRay& logged : rays) {
    const Ray& ray = logged.ray;
    ExactContext context({Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max)});
    RTCRayHit query{embree_ray(context.ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    if (logged.shadow)
      rtcOccluded1(scene_.get(), &context, &query.ray);
    else
      rtcIntersect1(scene_.get(), &context, &query);
  }
}

std::size_t Geometry::triangle_count() const {
  std::size_t count = 0;
  for (const Part& part : parts_)
    if (const auto* set = std::get_if<TriangleSet>(&part)) count += set->triangles.size();
  return count;
}

std::size_t Geometry::memory_bytes() const {
  std::size_t bytes =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(embree_bytes_, 0)) + parts_.size() * sizeof(Part);
  for (const Part& part : parts_)
    if (const auto* set = std::get_if<TriangleSet>(&part))
      bytes += (set->vertices.size() + set->normals.size()) * sizeof(Imath::V3f) +
               set->triangles.size() * sizeof(set->triangles[0]);
  return bytes;
}

}  // namespace abbe
