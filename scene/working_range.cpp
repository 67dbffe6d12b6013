#include "scene/working_range.h"

#include <utility>
#include <vector>

#include "scene/scene.h"

namespace abbe {
namespace {

double max_distance_to(const Imath::Box3d& box, const Imath::V3d& point) {
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

WorkingRange working_range_of(const Camera& camera, std::span<const ShapeInstance> shapes) {
  const Imath::V3d& from = position(camera);
  std::vector<std::pair<double, Imath::Box3d>> by_distance;
  by_distance.reserve(shapes.size());
  for (const ShapeInstance& instance : shapes) {
    const Imath::Box3d box = bounds(instance.shape);
    by_distance.emplace_back(max_distance_to(box, from), box);
  }
  std::sort(by_distance.begin(), by_distance.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  const bool probe = is_probe(camera);
  WorkingRange range;
  double max_distance = 0;
  double nearest = 0;
  for (const auto& [furthest_point, box] : by_distance) {
    const double scale = !range.near.isEmpty() ? max_distance : probe ? box.size().length() : furthest_point;
    if (furthest_point > WorkingRange::kGap * scale) continue;
    if (range.near.isEmpty()) nearest = furthest_point;
    range.near.extendBy(box);
    max_distance = furthest_point;
  }
  const double own_distance = probe ? max_distance_to(bounds(camera), from) : 0;
  range.far_threshold = WorkingRange::kGap * std::max(max_distance, own_distance);
  const bool around_camera = range.near.isEmpty() || max_distance > WorkingRange::kGap * nearest;
  range.origin = around_camera ? from : range.near.center();
  return range;
}

}  // namespace abbe
