#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "scene/scene.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace abbe {

/// What is rendered as triangles, in float as Embree sees them.
struct TriangleSet {
  std::vector<Imath::V3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Imath::V3f> normals;  ///< Per triangle, from the unrounded vertices.
};

/// The shapes in Embree's hands. Embree finds the primitive in float; where it is met, and whether it is met
/// at all rather than left, is then decided in double by the shape's own formula. A ray that starts on the
/// right side of a surface never meets that surface again at once.
class Geometry {
 public:
  /// Throws Error{resource} when there is no memory, Error{internal} when Embree refuses.
  explicit Geometry(const std::vector<ShapeInstance>& shapes);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) const;
  /// Whether anything is met at t in (0, ray.t_max).
  [[nodiscard]] bool occluded(const BasicRay<double>& ray) const;
  /// Every ray through Embree, the answers dropped.
  void replay(std::span<const LoggedRay> rays) const;

  [[nodiscard]] std::size_t triangle_count() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  using Part = std::variant<TriangleSet, Sphere, Disc>;
  struct Failure {
    int code = 0;
    std::string message;
  };

  void build();
  void attach(std::uint32_t index, Part& part);
  void check() const;

  std::vector<Part> parts_;  // by index of the shape
  std::atomic<std::ptrdiff_t> embree_bytes_{0};
  Failure failure_;
  std::unique_ptr<RTCDeviceTy, void (*)(RTCDeviceTy*)> device_;
  std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> scene_;
};

}  // namespace abbe
