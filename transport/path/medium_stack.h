#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"

namespace abbe {

/// The closed shapes filled with matter that a point of a path lies in, in order of priority, among equals
/// from the largest volume to the smallest, and of equal ones in the scene's order. A shape that encloses no
/// volume by itself, as a face of a body does not, is above the equals entered before it. What is around the
/// point is the last one's matter, or air where there is none.
class MediumStack {
 public:
  /// The most shapes held.
  static constexpr std::size_t kMost = 16;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// The shape whose matter is around the point; not of an empty stack, which is air.
  [[nodiscard]] std::uint32_t innermost() const { return shapes_[count_ - 1]; }
  [[nodiscard]] std::span<const std::uint32_t> shapes() const { return {shapes_.data(), count_}; }

  /// The path crosses the surface of `shape`, which it comes to be inside of or leaves. Where it is already,
  /// as through a surface that is not closed, nothing changes. Throws Error{resource} for more than `kMost`.
  void cross(const Scene& scene, std::uint32_t shape, bool entering) {
    if (entering)
      enter(scene, shape);
    else
      leave(scene, shape);
  }

  /// The shape by which the body of `shape` was entered: itself, else the innermost one of its material,
  /// since a body may be made of several shapes, such as its faces. Nothing where there is none.
  [[nodiscard]] std::optional<std::uint32_t> entry_of(const Scene& scene, std::uint32_t shape) const;

 private:
  void enter(const Scene& scene, std::uint32_t shape);
  void leave(const Scene& scene, std::uint32_t shape);

  std::array<std::uint32_t, kMost> shapes_{};
  std::size_t count_ = 0;
};

/// Finds the shapes around a point in the scene at some time, along a ray from there and its opposite: a
/// shape encloses the point if both leave it more often than they enter, and so do all shapes of a material
/// together that enclose no volume by themselves, of which the one that the ray leaves last stands for all.
[[nodiscard]] MediumStack enclosing(const Scene& scene, const Imath::V3f& point, float time = 0);
/// Finds the shapes around a scene's camera, its lens or the middle of its meter, and around a light, at time
/// 0. A light that is far, or at infinity, stands outside of them all; nothing is told of a lamp whose
/// corners stand in other matter than its middle.
[[nodiscard]] MediumStack around_camera(const Scene& scene);
[[nodiscard]] std::optional<MediumStack> around_light(const Scene& scene, const Light& light);
/// Whether it may depend on time in which matter what stands in the box is, which itself moves or not; or, of
/// what counts as moving because it is extended, on where.
[[nodiscard]] bool matter_moves(const Scene& scene, const Imath::Box3d& box, bool moves);

}  // namespace abbe
