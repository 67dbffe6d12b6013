#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/lights/light.h"
#include "scene/scene.h"
#include "scene/shapes/ray.h"
#include "transport/path/truncated_paths.h"

namespace abbe {

/// A straight way that light may be blocked on: between two points that `offset_point` put beside their
/// surfaces, or from such a point to infinity.
[[nodiscard]] inline BasicRay<double> way_between(const Imath::V3f& from, const Imath::V3f& to, float time) {
  const Imath::V3d start(from);
  return {start, Imath::V3d(to) - start, 1.0, time};
}
[[nodiscard]] inline BasicRay<double> way_along(const Ray& ray) {
  return {Imath::V3d(ray.origin), Imath::V3d(ray.direction), static_cast<double>(ray.t_max), ray.time};
}
/// The way of a ray to what it was drawn for.
[[nodiscard]] inline BasicRay<double> way_to(const Ray& ray, const LightSample& light) {
  return std::isfinite(light.distance) ? way_between(ray.origin, light.end, ray.time) : way_along(ray);
}

/// Asks the scene on behalf of one thread, counting, and logging where a log is given.
class RayCaster {
 public:
  explicit RayCaster(const Scene& scene, std::vector<LoggedRay>* log = nullptr) : scene_(scene), log_(log) {}

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  [[nodiscard]] const TruncatedPaths& cut() const { return cut_; }
  /// Counts a path that is cut while it carries `throughput`; see `TruncatedPaths`.
  void count_cut(float throughput) { cut_.count(throughput); }

  /// The nearest hit of a ray, or of each of many, as many as `hits`.
  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) {
    count({&ray, 1});
    return scene_.intersect(ray);
  }
  void intersect(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) {
    count(rays);
    scene_.intersect(rays, hits);
  }
  /// Whether anything but boundaries of matter stands on a way, or on each of many: 1 where it does, else 0.
  [[nodiscard]] bool occluded(const BasicRay<double>& way) {
    std::uint8_t blocked = 0;
    occluded({&way, 1}, {&blocked, 1});
    return blocked != 0;
  }
  void occluded(std::span<const BasicRay<double>> ways, std::span<std::uint8_t> blocked) {
    rays_ += ways.size();
    if (log_ != nullptr)
      for (const BasicRay<double>& way : ways)
        log_->push_back(
            {{Imath::V3f(way.origin), Imath::V3f(way.direction), static_cast<float>(way.t_max), way.time},
             true});
    scene_.occluded(ways, blocked);
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
  TruncatedPaths cut_;
};

}  // namespace abbe
