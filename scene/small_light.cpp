#include "scene/small_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/shapes/placed.h"

namespace abbe {
namespace {

// Of the box around the shape, of one that moves where it is at time 0 [m].
double half_size_of(const Shape& shape) {
  if (motion_of(shape) == nullptr) return bounds(shape).size().length() / 2;
  const auto& placed = std::get<PlacedShape>(shape);
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners(*placed.of, *placed.at)) box.extendBy(corner);
  return box.size().length() / 2;
}

void sort_by_x(std::vector<Viewpoint>& places) {
  std::ranges::sort(places, {}, [](const Viewpoint& place) { return place.at.x; });
}

}  // namespace

bool emits(const Light& light) {
  return light.emission.max() > 0;
}

std::vector<Viewpoint> specular_centers(const Scene& scene) {
  std::vector<Viewpoint> centers;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    if (lobes(scene.materials[scene.shapes[i].material]).delta)
      centers.push_back({bounds(scene.shapes[i].shape).center(), i});
  sort_by_x(centers);
  return centers;
}

std::vector<Viewpoint> places_of_meter(const Scene& scene) {
  std::vector<Viewpoint> places;
  for (const std::array<float, 2>& u : kSpreadOverLight)
    places.push_back({Imath::V3d(meter_point(scene.camera, {u[0], u[1]})), std::nullopt});
  sort_by_x(places);
  return places;
}

bool looks_smaller(const Scene& scene, const Light& light, std::span<const Viewpoint> from, double limit_sr) {
  if (const auto* sun = std::get_if<SunLight>(&light.kind))
    return 2 * std::numbers::pi * static_cast<double>(sun->cap) < limit_sr;
  const auto* emitter = std::get_if<AreaLight>(&light.kind);
  if (emitter == nullptr) return light.is_delta();
  const Shape& shape = scene.shapes[emitter->shape].shape;
  const Imath::Box3d box = bounds(shape);
  const double half_size = half_size_of(shape);
  const double cosine = 1 - limit_sr / (2 * std::numbers::pi);
  const double reach =
      half_size / std::sqrt((1 - cosine) * (1 + cosine)) + box.size().length() / 2 - half_size;
  auto near = std::lower_bound(from.begin(), from.end(), box.center().x - reach,
                               [](const Viewpoint& c, double x) { return c.at.x < x; });
  for (; near != from.end() && near->at.x <= box.center().x + reach; ++near)
    if (near->shape != emitter->shape && (near->at - box.center()).length() <= reach) return false;
  return true;
}

}  // namespace abbe
