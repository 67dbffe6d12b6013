#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Medium stack: the shapes with a medium that contain a point of a path, by their indices in
/// `Scene::shapes`. The current medium is that of the last shape; an empty stack is air. The shapes are in
/// the order of
/// - ascending priority;
/// - at equal priority, descending volume;
/// - at equal volume, ascending index.
///
/// A shape without a volume of its own, such as one face of a body, is ordered by entry among shapes of equal
/// priority. It comes later in the list than those entered before it, so its medium becomes the current one
/// unless a shape of higher priority contains the point.
class MediumStack {
 public:
  /// Maximum number of shapes.
  static constexpr std::size_t kMaxShapes = 16;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Index of the shape whose medium is the current one. The stack must not be empty.
  [[nodiscard]] std::uint32_t innermost() const { return shapes_[count_ - 1]; }
  /// Indices of all shapes, the innermost last. Valid while the stack is not changed.
  [[nodiscard]] std::span<const std::uint32_t> shapes() const { return {shapes_.data(), count_}; }

  /// Records that the path crosses the surface of `shape`, entering or leaving it. Leaving removes
  /// `entry_of(scene, shape)`. Nothing changes if the path is on that side already, as with a surface that is
  /// not closed, or if the shape has no medium. Throws Error{resource} if the stack has `kMaxShapes` shapes
  /// already.
  void cross(const Scene& scene, std::uint32_t shape, bool entering) {
    if (entering)
      enter(scene, shape);
    else
      leave(scene, shape);
  }

  /// Shape of the stack by which the body of `shape` was entered: `shape` itself if it is in the stack,
  /// otherwise the innermost shape of its material, because a body may consist of several shapes. Nothing if
  /// there is none.
  [[nodiscard]] std::optional<std::uint32_t> entry_of(const Scene& scene, std::uint32_t shape) const;

 private:
  void enter(const Scene& scene, std::uint32_t shape);
  void leave(const Scene& scene, std::uint32_t shape);

  std::array<std::uint32_t, kMaxShapes> shapes_{};
  std::size_t count_ = 0;
};

/// Medium stack of a point at a time (fraction of the exposure), found with a ray from the point and its
/// opposite. A shape contains the point if both rays leave it more often than they enter it. All shapes of
/// one material that enclose no volume count together, represented by the one that the first ray leaves last.
/// Throws Error{resource} if more than `MediumStack::kMaxShapes` shapes contain the point.
[[nodiscard]] MediumStack enclosing_media(const Scene& scene, const Imath::V3f& point, float time = 0);
/// Medium stack at the center of the camera's lens or of its probe, at time 0. Throws as `enclosing_media`.
[[nodiscard]] MediumStack media_at_camera(const Scene& scene);
/// Medium stack at the center of a light, at time 0; empty for a distant light and a light at infinity.
/// Returns nothing for an area light whose corners are in other media than its center. Throws as
/// `enclosing_media`.
[[nodiscard]] std::optional<MediumStack> media_at_light(const Scene& scene, const Light& light);
/// True if the media of points in a world-space box [m] may depend on time, or on the position within the
/// box. Set `moves` if the points themselves move or are spread over the box. Conservative: true also for
/// some boxes in which nothing changes.
[[nodiscard]] bool media_may_change(const Scene& scene, const Imath::Box3d& box, bool moves);

/// `PlacedGrid::march` along a world-space ray through the shape that contains the grid, at the ray's time.
/// `distance` [m] and `column` [m] may be infinite.
[[nodiscard]] GridSegment march_grid_along(const PlacedGrid& grid, const Shape& shape,
                                           const BasicRay<double>& ray, float distance, float column);

/// Medium of a path segment, at the path's wavelengths.
struct MediumAt {
  bool attenuating = false;               ///< False if the medium neither absorbs nor scatters.
  SampledSpectrum extinction_per_m;       ///< Absorption plus scattering; 0 if not `attenuating`.
  const Medium* scattering = nullptr;     ///< Scattering medium; nullptr if none.
  SampledSpectrum scattering_per_m = {};  ///< Valid if `scattering` is set.
  const PlacedGrid* grid = nullptr;   ///< Multiplies both coefficients; only in media without an interface.
  const Shape* grid_shape = nullptr;  ///< Shape that contains the grid and moves with it.

  /// Multiplies `throughput` by the transmittance over a distance [m], which may be infinite. With a grid,
  /// `distance` is the integral of its density along the segment [m].
  void attenuate(SampledSpectrum& throughput, float distance) const {
    if (attenuating) throughput *= transmittance(extinction_per_m, distance);
  }
  /// Distance [m] along a ray at which the density integral equals `column` [m], limited to `distance` [m].
  /// Without a grid the density is 1.
  [[nodiscard]] GridSegment march(const Ray& ray, float distance, float column) const {
    if (grid != nullptr) {
      BasicRay<double> exact{Imath::V3d(ray.origin), Imath::V3d(ray.direction)};
      exact.time = ray.time;
      return march_grid_along(*grid, *grid_shape, exact, distance, column);
    }
    const bool reached = column < distance;
    return {reached ? column : distance, reached ? column : distance, reached};
  }
};

/// Medium of the innermost shape of the stack; for an empty stack air, which does not attenuate.
[[nodiscard]] MediumAt medium_at(const Scene& scene, const MediumStack& stack,
                                 const SampledSpectrum& wavelengths_nm);

/// Media around a point of a path: the shapes that contain it, and the current medium at the path's
/// wavelengths.
struct MediumState {
  MediumStack stack;
  MediumAt medium;

  /// Replaces the stack by `new_stack` and sets the medium at the path's wavelengths.
  void enter(const Scene& scene, const MediumStack& new_stack, const SampledSpectrum& wavelengths_nm) {
    stack = new_stack;
    medium = medium_at(scene, stack, wavelengths_nm);
  }
};

}  // namespace abbe
