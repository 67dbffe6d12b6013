#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/lights/light.h"
#include "scene/scene.h"
#include "scene/shapes/ray.h"
#include "sensor/film/film.h"

namespace abbe {

/// Number of paths truncated at the maximum depth while they still carried light, and the sum of their
/// throughputs relative to those at the start. The sum is in fixed point, so that neither threads nor the
/// parts of a render change a bit of it.
struct TruncatedPaths {
  static constexpr int kUnitExponent = -40;  ///< Exponent of the power of two that is the unit of `sum`.
  static constexpr float kMaxThroughput = 0x1p40F;  ///< Larger throughputs are clamped to this.

  std::uint64_t paths = 0;
  Int128 sum = 0;  ///< In units of 2^kUnitExponent.

  /// Counts a path truncated with the throughput `throughput`, unless that is 0, negative or NaN.
  void count(float throughput) {
    if (!(throughput > 0)) return;
    ++paths;
    sum += to_fixed(static_cast<double>(std::min(throughput, kMaxThroughput)), kUnitExponent);
  }
  /// Sum of the relative throughputs.
  [[nodiscard]] double throughput() const { return from_fixed(sum, kUnitExponent); }

  TruncatedPaths& operator+=(const TruncatedPaths& other) {
    paths += other.paths;
    sum += other.sum;
    return *this;
  }
};

/// Shadow ray between two points, both offset from their surfaces by `offset_point`. Its direction is the
/// vector between the points and is not normalised; `t_max` is 1.
[[nodiscard]] inline BasicRay<double> shadow_ray_between(const Imath::V3f& from, const Imath::V3f& to,
                                                         float time) {
  const Imath::V3d start(from);
  return {start, Imath::V3d(to) - start, 1.0, time};
}
/// Shadow ray with origin, direction, length and time of `ray`.
[[nodiscard]] inline BasicRay<double> shadow_ray_along(const Ray& ray) {
  return {Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max), ray.time};
}
/// Shadow ray from a ray's origin to the light sample for which it was drawn; infinite for lights at
/// infinity.
[[nodiscard]] inline BasicRay<double> shadow_ray(const Ray& ray, const LightSample& light) {
  return std::isfinite(light.distance) ? shadow_ray_between(ray.origin, light.end, ray.time)
                                       : shadow_ray_along(ray);
}

/// Access of one thread to the scene's ray queries; counts rays, and appends them to `log` if it is not null.
/// Scene and log must outlive it.
class RayCaster {
 public:
  explicit RayCaster(const Scene& scene, std::vector<LoggedRay>* log = nullptr) : scene_(scene), log_(log) {}

  /// Number of rays cast so far, shadow rays included.
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  /// Paths counted by `count_truncated` so far.
  [[nodiscard]] const TruncatedPaths& truncated() const { return truncated_; }
  /// Counts a path truncated with the throughput `throughput`; see `TruncatedPaths`.
  void count_truncated(float throughput) { truncated_.count(throughput); }

  /// Nearest hit of a ray, or of each of several rays; nothing for a ray that hits nothing. `rays` and `hits`
  /// must have equal sizes.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) {
    count({&ray, 1});
    return scene_.intersect(ray);
  }
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) {
    count(rays);
    scene_.intersect(rays, hits);
  }
  /// True if a shadow ray is occluded by anything but medium boundaries. The overload for several rays writes
  /// 1 (occluded) or 0 for each; both spans must have equal sizes.
  [[nodiscard]] bool occluded(const BasicRay<double>& shadow_ray) {
    std::uint8_t blocked = 0;
    occluded({&shadow_ray, 1}, {&blocked, 1});
    return blocked != 0;
  }
  void occluded(std::span<const BasicRay<double>> shadow_rays, std::span<std::uint8_t> blocked) {
    rays_ += shadow_rays.size();
    if (log_ != nullptr)
      for (const BasicRay<double>& shadow_ray : shadow_rays)
        log_->push_back({{Imath::V3f(shadow_ray.origin), Imath::V3f(shadow_ray.direction),
                          static_cast<float>(shadow_ray.t_max), shadow_ray.time},
                         true});
    scene_.occluded(shadow_rays, blocked);
  }

 private:
  void count(std::span<const Ray> rays) {
    rays_ += rays.size();
    if (log_ != nullptr)
      for (const Ray& ray : rays) log_->push_back({ray, false});
  }

  const Scene& scene_;
  std::vector<LoggedRay>* log_;
  std::uint64_t rays_ = 0;
  TruncatedPaths truncated_;
};

}  // namespace abbe
