#include "scene/extent.h"

#include <utility>
#include <vector>

#include "scene/scene.h"

namespace abbe {
namespace {

double furthest(const Imath::Box3d& box, const Imath::V3d& point) {
  Imath::V3d away;
  for (int i = 0; i < 3; ++i)
    away[i] = std::max(std::abs(box.min[i] - point[i]), std::abs(box.max[i] - point[i]));
  return away.length();
}

}  // namespace

double distance_to(const Imath::Box3d& box, const Imath::V3d& point) {
  Imath::V3d away;
  for (int i = 0; i < 3; ++i) away[i] = std::max({box.min[i] - point[i], point[i] - box.max[i], 0.0});
  return away.length();
}

Extent extent_of(const Camera& camera, std::span<const ShapeInstance> shapes) {
  const Imath::V3d& from = position(camera);
  std::vector<std::pair<double, Imath::Box3d>> by_reach;
  by_reach.reserve(shapes.size());
  for (const ShapeInstance& instance : shapes) {
    const Imath::Box3d box = bounds(instance.shape);
    by_reach.emplace_back(furthest(box, from), box);
  }
  std::sort(by_reach.begin(), by_reach.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const bool meter = is_meter(camera);
  Extent extent;
  double reach = 0;
  double nearest = 0;
  for (const auto& [furthest_point, box] : by_reach) {
    const double scale = !extent.near.isEmpty() ? reach : meter ? box.size().length() : furthest_point;
    if (furthest_point > Extent::kGap * scale) continue;
    if (extent.near.isEmpty()) nearest = furthest_point;
    extent.near.extendBy(box);
    reach = furthest_point;
  }
  const double own_reach = meter ? furthest(bounds(camera), from) : 0;
  extent.far_from = Extent::kGap * std::max(reach, own_reach);
  const bool around_camera = extent.near.isEmpty() || reach > Extent::kGap * nearest;
  extent.origin = around_camera ? from : extent.near.center();
  return extent;
}

}  // namespace abbe
