#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "scene/contact.h"
#include "scene/scene.h"
#include "scene/shapes/triangles.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace abbe {

/// What Embree holds of a shape that stands by itself.
using PlainGeometry = std::variant<TriangleSet, Sphere, Disc>;
/// A prototype in Embree's hands: a scene of one geometry, which its instances refer to.
struct InstancedScene {
  std::shared_ptr<const Prototype> prototype;
  PlainGeometry geometry;
  std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> scene;
};
struct SceneInstance {
  const InstancedScene* of;
  std::shared_ptr<const Placement> at;
};
/// How many boxes one that moves is in Embree's hands, each around all of a slice of time: Embree's own
/// motion blur misses hits of packets whose rays have different times.
inline constexpr unsigned kTimeSlices = 16;
using AttachedGeometry = std::variant<TriangleSet, Sphere, Disc, SceneInstance>;

/// The shapes in Embree's hands. Embree finds the primitive in float; where it is met, and whether it is met
/// at all rather than left, is then decided in double by the shape's own formula, for instances in the
/// coordinates of their prototype. Curved shapes, and triangles so large that floats do not tell from which
/// side a ray starts, are found in double as well. A ray that starts on the right side of a surface never
/// meets that surface again at once. What moves is asked where it stands at the ray's time, in double.
class Geometry {
 public:
  /// Takes the walls near each shape. Throws Error{resource} when there is no memory, Error{internal} when
  /// Embree refuses.
  Geometry(const std::vector<ShapeInstance>& shapes, const std::vector<Material>& materials,
           std::vector<NearWalls> walls);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// Finds the nearest hit of each of the rays, as many as `hits`, as if each were alone.
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const;
  /// What `Scene::touching` tells, of the scene whose shapes these are.
  [[nodiscard]] TouchingSurfaces touching(const Scene& scene, const Ray& ray, const SurfaceHit& hit) const;
  /// What `Scene::hides_beyond` tells, of the scene whose shapes these are.
  [[nodiscard]] bool wall_within_rounding(const Scene& scene, const SurfaceHit& hit,
                                          const Imath::V3f& direction, float time) const;
  /// Whether anything but a boundary of matter is met at t in (0, ray.t_max).
  [[nodiscard]] bool occluded(const BasicRay<double>& ray) const;
  /// Tells of each of the rays, as many as `blocked`, whether something is met: 1 or 0.
  void occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const;
  /// Every ray through Embree, the answers dropped.
  void replay(std::span<const LoggedRay> rays) const;

  /// Number of triangles, those of every instance counted.
  [[nodiscard]] std::size_t triangle_count() const;
  /// Bytes held, of a prototype once, however many instances it has.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Failure {
    int code = 0;
    std::string message;
  };

  using ScenePointer = std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)>;

  /// All that is met at t in (0, ray.t_max) of those geometries.
  [[nodiscard]] std::vector<SurfaceHit> all_met(const BasicRay<double>& ray, unsigned mask) const;
  void open_device();
  [[nodiscard]] ScenePointer new_scene();
  void commit(RTCSceneTy* scene);
  void attach(RTCSceneTy* scene, std::uint32_t index, RTCGeometryTy* geometry);
  const InstancedScene* build_prototype(const std::shared_ptr<const Prototype>& prototype);
  void check() const;

  std::vector<AttachedGeometry> attached_;  // by index of the shape
  std::vector<NearWalls> walls_;            // likewise
  std::atomic<std::ptrdiff_t> embree_bytes_{0};
  Failure failure_;
  std::unique_ptr<RTCDeviceTy, void (*)(RTCDeviceTy*)> device_;
  std::unordered_map<const Prototype*, std::unique_ptr<InstancedScene>> prototypes_;
  std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> scene_;
};

}  // namespace abbe
