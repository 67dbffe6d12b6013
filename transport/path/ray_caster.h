#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "scene/shapes/ray.h"
#include "transport/path/cut.h"

namespace abbe {

/// Asks the scene on behalf of one thread, counting, and logging where a log is given.
class RayCaster {
 public:
  explicit RayCaster(const Scene& scene, std::vector<LoggedRay>* log = nullptr) : scene_(scene), log_(log) {}

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  [[nodiscard]] const Cut& cut() const { return cut_; }
  /// Of a path that is cut; see `Cut`.
  void count_cut(float throughput) { cut_.count(throughput); }

  [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray) {
    ++rays_;
    if (log_ != nullptr) log_->push_back({ray, false});
    return scene_.intersect(ray);
  }
  /// Whether anything stands between two points that `offset_point` put beside their surfaces.
  [[nodiscard]] bool occluded(const Imath::V3f& from, const Imath::V3f& to) {
    count_shadow({from, to - from, 1});
    return scene_.occluded(from, to);
  }
  [[nodiscard]] bool occluded(const Ray& ray) {
    count_shadow(ray);
    return scene_.occluded(ray);
  }

 private:
  void count_shadow(const Ray& ray) {
    ++rays_;
    if (log_ != nullptr) log_->push_back({ray, true});
  }

  const Scene& scene_;
  std::vector<LoggedRay>* log_;
  std::uint64_t rays_ = 0;
  Cut cut_;
};

}  // namespace abbe
