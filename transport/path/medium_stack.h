#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"

namespace abbe {

/// Medium stack: the closed shapes with a medium that contain a point of a path, ordered by priority. Among
/// equals the order is from the largest volume to the smallest, then that of the scene. A shape that encloses
/// no volume by itself, such as a face of a body, ranks above equals entered before it. The current medium is
/// that of the last shape; an empty stack is air.
class MediumStack {
 public:
  /// Maximum number of shapes.
  static constexpr std::size_t kMaxShapes = 16;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Shape whose medium is the current one. The stack must not be empty.
  [[nodiscard]] std::uint32_t innermost() const { return shapes_[count_ - 1]; }
  [[nodiscard]] std::span<const std::uint32_t> shapes() const { return {shapes_.data(), count_}; }

  /// Records that the path crosses the surface of `shape`, entering or leaving it. Nothing changes if the
  /// path is on that side already, as with a surface that is not closed. Throws Error{resource} for
  /// more than `kMaxShapes` shapes.
  void cross(const Scene& scene, std::uint32_t shape, bool entering) {
    if (entering)
      enter(scene, shape);
    else
      leave(scene, shape);
  }

  /// Shape by which the body of `shape` was entered: `shape` itself, otherwise the innermost shape of its
  /// material, because a body may consist of several shapes. Nothing if there is none.
  [[nodiscard]] std::optional<std::uint32_t> entry_of(const Scene& scene, std::uint32_t shape) const;

 private:
  void enter(const Scene& scene, std::uint32_t shape);
  void leave(const Scene& scene, std::uint32_t shape);

  std::array<std::uint32_t, kMaxShapes> shapes_{};
  std::size_t count_ = 0;
};

/// Medium stack of a point at a time, found with a ray from the point and its opposite. A shape contains the
/// point if both rays leave it more often than they enter it. All shapes of one material that enclose no
/// volume count together, represented by the one that the ray leaves last.
[[nodiscard]] MediumStack enclosing_media(const Scene& scene, const Imath::V3f& point, float time = 0);
/// Medium stack of the scene's camera (its lens, or the center of its probe) or of a light, at time 0. A
/// distant light and a light at infinity are outside all shapes. Returns nothing for a light whose corners
/// are in other media than its center.
[[nodiscard]] MediumStack media_at_camera(const Scene& scene);
[[nodiscard]] std::optional<MediumStack> media_at_light(const Scene& scene, const Light& light);
/// True if the media of points in the box may depend on time, or on the position within the box. Set `moves`
/// if the points themselves move or are spread over the box.
[[nodiscard]] bool media_may_change(const Scene& scene, const Imath::Box3d& box, bool moves);

}  // namespace abbe
