#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "scene/coincident_shapes.h"
#include "scene/scene.h"
#include "scene/shapes/shape.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace abbe {

struct InstancedScene;
/// An instance of such a scene. It moves if `at->motion` is set. `Geometry` owns the scene.
struct SceneInstance {
  const InstancedScene* of;
  std::shared_ptr<const Placement> at;
};
/// Embree's representation of any shape of the scene.
using AttachedGeometry = Joined<std::variant<TriangleSet>, CurvedShape, std::variant<SceneInstance>>::type;
/// Embree scene with the one geometry of a prototype, in its coordinates; instances of it refer to it.
struct InstancedScene {
  std::shared_ptr<const Prototype> prototype;
  AttachedGeometry geometry;  ///< No instance.
  std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> scene;
};
/// Number of boxes, each around one slice of time, by which Embree represents a moving instance. Embree's own
/// motion blur misses hits in packets whose rays have different times.
inline constexpr unsigned kTimeSlices = 16;

/// The shapes as Embree geometry, in render coordinates [m]. It is immutable; threads may query it
/// concurrently. Embree finds the primitive in float. The shape's own formula then decides in double whether
/// and where the ray hits it, for instances in the coordinates of their prototype. Curved shapes, and
/// triangles so large that floats do not resolve the side at which a ray starts, are intersected in double
/// throughout. Therefore a ray that starts on the correct side of a surface never hits that surface again at
/// its origin. Moving shapes are placed in double at the ray's time.
class Geometry {
 public:
  /// Builds Embree's scene; `shapes` and `materials` need not outlive it. `walls` has one element per shape:
  /// the opaque surfaces near it, by `walls_near_shapes`. Throws Error{resource} if memory is exhausted or
  /// Embree reports an unknown error, and Error{internal} for its other errors.
  Geometry(const std::vector<ShapeInstance>& shapes, const std::vector<Material>& materials,
           std::vector<NearWalls> walls);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  // The functions of `Scene` with these names. `scene` is that of the shapes. `wall_within_rounding` is for
  // hits in the `near_wall_bounds` of their shapes.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const;
  [[nodiscard]] CoincidentHits coincident(const Scene& scene, const Ray& ray, const SurfaceHit& hit) const;
  [[nodiscard]] bool wall_within_rounding(const Scene& scene, const SurfaceHit& hit,
                                          const Imath::V3f& direction, float time) const;
  /// True if the ray hits anything except boundaries of media at t in (0, ray.t_max). The direction may have
  /// any length; t is in its units.
  [[nodiscard]] bool occluded(const BasicRay<double>& ray) const;
  void occluded(std::span<const BasicRay<double>> rays, std::span<std::uint8_t> blocked) const;
  void replay(std::span<const LoggedRay> rays) const;
  [[nodiscard]] std::size_t triangle_count() const;
  /// Memory of Embree and of the shapes' data, in bytes; each prototype counts once.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Failure {
    int code = 0;
    std::string message;
  };

  using ScenePointer = std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)>;

  /// All hits at t in (0, ray.t_max) with geometry that the mask accepts, in no particular order.
  [[nodiscard]] std::vector<SurfaceHit> all_hits(const BasicRay<double>& ray, unsigned mask) const;
  void open_device();
  [[nodiscard]] ScenePointer new_scene();
  void commit(RTCSceneTy* scene);
  void attach(RTCSceneTy* scene, std::uint32_t index, RTCGeometryTy* geometry);
  const InstancedScene* build_prototype(const std::shared_ptr<const Prototype>& prototype);
  void check() const;

  std::vector<AttachedGeometry> attached_;  // by index of the shape
  std::vector<NearWalls> walls_;            // by index of the shape
  std::atomic<std::ptrdiff_t> embree_bytes_{0};
  Failure failure_;
  std::unique_ptr<RTCDeviceTy, void (*)(RTCDeviceTy*)> device_;
  std::unordered_map<const Prototype*, std::unique_ptr<InstancedScene>> prototypes_;
  std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> scene_;
};

}  // namespace abbe
