#include "scene/exact_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "scene/shapes/shape.h"

namespace abbe {
namespace {

// Placement, at time 0 if it moves, of the instance that is being traversed; nullptr in the world.
const Placement* placement_of(const RTCIntersectContext* context) {
  const std::uint32_t instance = context->instID[0];
  if (instance == RTC_INVALID_GEOMETRY_ID) return nullptr;
  return std::get<SceneInstance>(static_cast<const ExactContext*>(context)->attached[instance]).at.get();
}

// The placement at the ray's time.
[[gnu::noinline]] Placement placement_now(const Placement& at, const BasicRay<double>& ray) {
  return placement_at(at, static_cast<double>(ray.time));
}

// Code for moving shapes is out of line, here and below, so that static shapes do not pay for it.
template <typename S>
[[gnu::noinline]] std::optional<ShapeHit<double>> moving_intersection(const S& shape, const Placement& at,
                                                                      const BasicRay<double>& ray) {
  return intersect_placed(shape, placement_now(at, ray), ray, 0.0);
}

// Intersection of a ray with a primitive at t in (0, ray.t_max). For a triangle of a set only t is computed.
template <typename S>
std::optional<ShapeHit<double>> intersection(const S& shape, std::uint32_t /*the one*/, const Placement* at,
                                             const BasicRay<double>& ray) {
  if (at == nullptr) return intersect(shape, ray, 0.0);
  return at->motion ? moving_intersection(shape, *at, ray) : intersect_placed(shape, *at, ray, 0.0);
}

std::optional<ShapeHit<double>> intersection(const TriangleSet& set, std::uint32_t triangle,
                                             const Placement* /*none*/, const BasicRay<double>& ray) {
  const auto& [a, b, c] = set.triangles[triangle];
  const auto t = intersect_triangle(Imath::V3d(set.vertices[a]), Imath::V3d(set.vertices[b]),
                                    Imath::V3d(set.vertices[c]), ray);
  if (!t || !(*t > 0 && *t < ray.t_max)) return std::nullopt;
  return ShapeHit<double>{*t, {}, {}};
}

template <typename S>
Imath::Box3d primitive_bounds(const S& shape, std::uint32_t /*the one*/) {
  return bounds(shape);
}
Imath::Box3d primitive_bounds(const TriangleSet& set, std::uint32_t triangle) {
  Imath::Box3d box;
  for (const std::uint32_t vertex : set.triangles[triangle]) box.extendBy(Imath::V3d(set.vertices[vertex]));
  return box;
}

void set_bounds(const RTCBoundsFunctionArguments* args, const Imath::Box3d& box) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto below = [](double x) { return std::nextafter(static_cast<float>(x), -kInfinity); };
  const auto above = [](double x) { return std::nextafter(static_cast<float>(x), kInfinity); };
  *args->bounds_o = {below(box.min.x), below(box.min.y), below(box.min.z), 0,
                     above(box.max.x), above(box.max.y), above(box.max.z), 0};
}

template <typename S>
void user_bounds(const RTCBoundsFunctionArguments* args) {
  set_bounds(args, primitive_bounds(*static_cast<const S*>(args->geometryUserPtr), args->primID));
}

// Stores a hit of one ray of a packet, or appends it to `all`. For triangles `resolve_hit` decides, because
// it rounds differently. A hit that it rejects must not be stored, since the query would find it again.
template <typename S>
void take_hit(const RTCIntersectFunctionNArguments* args, unsigned i, std::size_t id,
              const ShapeHit<double>& found) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  auto& context = *static_cast<ExactContext*>(args->context);
  if constexpr (!std::is_same_v<S, TriangleSet>) context.curved_hit[id] = found;
  RTCHit candidate{};
  candidate.geomID = args->geomID;
  candidate.primID = args->primID;
  candidate.instID[0] = args->context->instID[0];
  if (context.all != nullptr || std::is_same_v<S, TriangleSet>) {
    const auto decided = resolve_hit(candidate, context, id);
    if (decided && context.all != nullptr) context.all->push_back(*decided);
    if (!decided || context.all != nullptr) return;
  }
  RTCRayN_tfar(ray, args->N, i) = static_cast<float>(found.t);
  rtcCopyHitToHitN(hit, &candidate, args->N, i);
}

template <typename S>
void user_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  const auto& shape = *static_cast<const S*>(args->geometryUserPtr);
  const Placement* at = placement_of(args->context);
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const std::size_t id = RTCRayN_id(ray, args->N, i);
    const auto found = intersection(shape, args->primID, at, context.rays[id]);
    if (found && found->t < static_cast<double>(RTCRayN_tfar(ray, args->N, i)))
      take_hit<S>(args, i, id, *found);
  }
}

template <typename S>
void user_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  const auto& shape = *static_cast<const S*>(args->geometryUserPtr);
  const Placement* at = placement_of(args->context);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] != 0 &&
        intersection(shape, args->primID, at, context.rays[RTCRayN_id(args->ray, args->N, i)]))
      RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
}

// Bounding box of one slice of time.
void moving_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& moving = *static_cast<const SceneInstance*>(args->geometryUserPtr);
  set_bounds(args, moving.at->motion->sweep(corners(*moving.of->prototype, *moving.at),
                                            static_cast<double>(args->primID) / kTimeSlices,
                                            static_cast<double>(args->primID + 1) / kTimeSlices));
}

unsigned slice_of(float time) {
  return std::min(static_cast<unsigned>(time * static_cast<float>(kTimeSlices)), kTimeSlices - 1);
}

// The ray in the prototype's scene, for the placement at the ray's time.
RTCRay ray_within(const SceneInstance& moving, const BasicRay<double>& ray, float t_max, unsigned mask,
                  std::size_t id) {
  RTCRay local = embree_ray(to_prototype(placement_now(*moving.at, ray), ray));
  local.tfar = t_max;
  local.mask = mask;
  local.id = static_cast<unsigned>(id);
  return local;
}

// Marks hits as belonging to an instance during its lifetime.
class InstanceScope {
 public:
  InstanceScope(RTCIntersectContext* context, unsigned instance) : context_(context) {
    context_->instID[0] = instance;
  }
  ~InstanceScope() { context_->instID[0] = RTC_INVALID_GEOMETRY_ID; }
  InstanceScope(const InstanceScope&) = delete;
  InstanceScope& operator=(const InstanceScope&) = delete;

 private:
  RTCIntersectContext* context_;
};

void moving_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  const auto& moving = *static_cast<const SceneInstance*>(args->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  const InstanceScope scope(args->context, args->geomID);
  for (unsigned i = 0; i < args->N; ++i) {
    const std::size_t id = RTCRayN_id(rays, args->N, i);
    if (args->valid[i] == 0 || slice_of(context.rays[id].time) != args->primID) continue;
    RTCRayHit query = without_hit(ray_within(moving, context.rays[id], RTCRayN_tfar(rays, args->N, i),
                                             RTCRayN_mask(rays, args->N, i), id));
    rtcIntersect1(moving.of->scene.get(), args->context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    RTCRayN_tfar(rays, args->N, i) = query.ray.tfar;
    rtcCopyHitToHitN(hits, &query.hit, args->N, i);
  }
}

void moving_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  const auto& moving = *static_cast<const SceneInstance*>(args->geometryUserPtr);
  const InstanceScope scope(args->context, args->geomID);
  for (unsigned i = 0; i < args->N; ++i) {
    const std::size_t id = RTCRayN_id(args->ray, args->N, i);
    if (args->valid[i] == 0 || slice_of(context.rays[id].time) != args->primID) continue;
    RTCRay query = ray_within(moving, context.rays[id], RTCRayN_tfar(args->ray, args->N, i),
                              RTCRayN_mask(args->ray, args->N, i), id);
    rtcOccluded1(moving.of->scene.get(), args->context, &query);
    if (query.tfar < 0) RTCRayN_tfar(args->ray, args->N, i) = query.tfar;
  }
}

SurfaceHit surface_hit(const ShapeHit<double>& hit, const BasicRay<double>& ray, std::uint32_t shape,
                       std::uint32_t primitive) {
  return {rounded_back(hit.point, ray.direction), Imath::V3f(hit.normal), static_cast<float>(hit.t), shape,
          primitive};
}

// Distance along the ray, in its units, to the plane of a triangle, of an instance placed `at`. Out of line,
// as is the placement, so that the filter and `resolve_hit` round identically. Otherwise a hit that one
// accepts and the other rejects would be queried forever.
[[gnu::noinline]] double crossing(const TriangleSet& set, std::uint32_t triangle, const Placement* at,
                                  const BasicRay<double>& ray) {
  return plane_crossing(set, triangle, at == nullptr ? ray : to_prototype(*at, ray));
}

// Barycentric coordinate below which a point may need a shift off the edge; generous in all but the smallest
// triangles.
constexpr float kNearEdge = 0.01F;

// Displacement of the point at t that brings it as far from its triangle's edges as rays start from surfaces.
Imath::V3d shift_in_world(const TriangleSet& set, const RTCHit& hit, const Placement* instance,
                          const BasicRay<double>& local, double t, const Imath::V3f& point) {
  const Imath::V3f axis(1, 0, 0);
  const double distance = 0.5 * static_cast<double>((offset_point(point, axis, axis) - point).x);
  Imath::V3d shift = shift_off_edges(set, hit.primID, local.origin + local.direction * t,
                                     distance * local.direction.length());
  if (instance != nullptr) instance->to_world.multDirMatrix(shift, shift);
  return shift;
}

// The hit of the ray with a triangle, of an instance placed `at`; nothing if the ray misses.
std::optional<SurfaceHit> triangle_hit(const TriangleSet& set, const RTCHit& hit,
                                       const SceneInstance* instance, const Placement* at,
                                       const BasicRay<double>& ray) {
  const double t = crossing(set, hit.primID, at, ray);
  if (!(t > 0 && t < ray.t_max)) return std::nullopt;
  Imath::V3d point = ray.origin + ray.direction * t;
  if (std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < kNearEdge)
    point += shift_in_world(set, hit, at, at == nullptr ? ray : to_prototype(*at, ray), t, Imath::V3f(point));
  if (instance == nullptr)
    return SurfaceHit{rounded_back(point, ray.direction), set.normals[hit.primID], static_cast<float>(t),
                      hit.geomID, hit.primID};
  const Imath::V3d normal = triangle_normal(instance->of->prototype->shape, hit.primID);
  return surface_hit({t, point, normal_to_world(*at, normal)}, ray, hit.instID[0], hit.primID);
}

[[gnu::noinline]] std::optional<SurfaceHit> moving_triangle_hit(const TriangleSet& set, const RTCHit& hit,
                                                                const SceneInstance& instance,
                                                                const BasicRay<double>& ray) {
  const Placement now = placement_now(*instance.at, ray);
  return triangle_hit(set, hit, &instance, &now, ray);
}

[[gnu::noinline]] double moving_crossing(const TriangleSet& set, std::uint32_t triangle, const Placement& at,
                                         const BasicRay<double>& ray) {
  const Placement now = placement_now(at, ray);
  return crossing(set, triangle, &now, ray);
}

}  // namespace

void reject_behind(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
  const Placement* at = placement_of(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const BasicRay<double>& ray = context.rays[RTCRayN_id(args->ray, args->N, i)];
    const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
    const double t = at != nullptr && at->motion ? moving_crossing(set, triangle, *at, ray)
                                                 : crossing(set, triangle, at, ray);
    if (!(t > 0 && t < ray.t_max)) args->valid[i] = 0;
  }
}

void collect_hits(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const ExactContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, i);
    if (const auto found = resolve_hit(hit, context, RTCRayN_id(args->ray, args->N, i)))
      context.all->push_back(*found);
    args->valid[i] = 0;
  }
}

void set_callbacks(RTCGeometryTy* geometry, AttachedGeometry& attached) {
  const auto set = [geometry](std::size_t primitives, RTCBoundsFunction bounds,
                              RTCIntersectFunctionN intersect, RTCOccludedFunctionN occluded) {
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
  };
  std::visit(
      [&]<typename S>(S& shape) {
        rtcSetGeometryUserData(geometry, &shape);
        if constexpr (std::is_same_v<S, SceneInstance>)
          set(kTimeSlices, moving_bounds, moving_intersect, moving_occluded);
        else if constexpr (std::is_same_v<S, TriangleSet>)
          set(shape.triangles.size(), user_bounds<S>, user_intersect<S>, user_occluded<S>);
        else
          set(1, user_bounds<S>, user_intersect<S>, user_occluded<S>);
      },
      attached);
}

std::optional<SurfaceHit> resolve_hit(const RTCHit& hit, const ExactContext& context, std::size_t number) {
  const bool placed = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const std::uint32_t shape = placed ? hit.instID[0] : hit.geomID;
  const AttachedGeometry& attached = context.attached[shape];
  const auto* instance = std::get_if<SceneInstance>(&attached);
  const auto* set = instance == nullptr ? std::get_if<TriangleSet>(&attached)
                                        : std::get_if<TriangleSet>(&instance->of->geometry);
  const BasicRay<double>& ray = context.rays[number];
  if (set == nullptr) return surface_hit(context.curved_hit[number], ray, shape, 0);
  const Placement* at = instance == nullptr ? nullptr : instance->at.get();
  return at != nullptr && at->motion ? moving_triangle_hit(*set, hit, *instance, ray)
                                     : triangle_hit(*set, hit, instance, at, ray);
}

std::optional<SurfaceHit> resolve_nearest(const RTCHit& hit, float t, const ExactContext& context,
                                          std::size_t ray) {
  std::optional<SurfaceHit> candidate = resolve_hit(hit, context, ray);
  if (!candidate) return candidate;
  const float earliest_t = std::min(t, candidate->t);
  candidate->retreat_m = candidate->t - earliest_t +
                         std::min(2 * kOffsetSteps * largest_coordinate(candidate->point), 0.5F * earliest_t);
  return candidate;
}

}  // namespace abbe
