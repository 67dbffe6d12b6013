#include "scene/small_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/shapes/basis.h"
#include "scene/shapes/placed.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

// Around the shape, of one that moves where it is at time 0.
Imath::Box3d box_at_opening(const Shape& shape) {
  if (motion_of(shape) == nullptr) return bounds(shape);
  const auto& placed = std::get<PlacedShape>(shape);
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners(*placed.of, *placed.at)) box.extendBy(corner);
  return box;
}

// How far away the shape is that stands around a place at time 0 [m]: the nearest of what rays meet there
// whose opposites meet it too; 0 where none do.
double distance_around(const Shape& shape, const Imath::V3d& place) {
  if (!box_at_opening(shape).intersects(place)) return 0;
  const Basis<double> axes(askew_direction<double>());
  double nearest = std::numeric_limits<double>::infinity();
  for (const Imath::V3d& axis : {axes.x, axes.y, axes.z}) {
    const auto ahead = intersect(shape, BasicRay<double>{place, axis}, 0.0);
    const auto behind = intersect(shape, BasicRay<double>{place, -axis}, 0.0);
    if (ahead && behind) nearest = std::min({nearest, ahead->t, behind->t});
  }
  return std::isinf(nearest) ? 0 : nearest;
}

void sort_by_x(std::vector<Viewpoint>& places) {
  std::ranges::sort(places, {}, [](const Viewpoint& place) { return place.at.x; });
}

// Whether that holds of one of the places whose x is no further than `reach` from this one.
template <typename Holds>
bool any_near(const std::vector<Viewpoint>& places, double x, double reach, Holds holds) {
  const auto first =
      std::ranges::lower_bound(places, x - reach, {}, [](const Viewpoint& p) { return p.at.x; });
  const auto last =
      std::ranges::upper_bound(places, x + reach, {}, [](const Viewpoint& p) { return p.at.x; });
  return std::any_of(first, last, holds);
}

}  // namespace

bool emits(const Light& light) {
  return light.emission.max() > 0;
}

Viewpoints specular_centers(const Scene& scene) {
  Viewpoints centers;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Material& material = scene.materials[scene.shapes[i].material];
    const Lobes sent = lobes(material);
    const Medium* filling = medium(material);
    const Viewpoint center{bounds(scene.shapes[i].shape).center(), i};
    if (sent.delta) centers.places.push_back(center);
    if (sent.spread || (filling != nullptr && filling->scatters())) centers.scattering.push_back(center);
  }
  sort_by_x(centers.places);
  sort_by_x(centers.scattering);
  return centers;
}

Viewpoints places_of_meter(const Scene& scene) {
  std::vector<Viewpoint> places;
  for (const std::array<float, 2>& u : kSpreadOverLight)
    places.push_back({Imath::V3d(meter_point(scene.camera, {u[0], u[1]})), std::nullopt});
  sort_by_x(places);
  return {places, {}};
}

bool looks_smaller(const Scene& scene, const Light& light, const Viewpoints& from, double limit_sr) {
  if (const auto* sun = std::get_if<SunLight>(&light.kind))
    return 2 * std::numbers::pi * static_cast<double>(sun->cap) < limit_sr;
  const auto* emitter = std::get_if<AreaLight>(&light.kind);
  if (emitter == nullptr) return light.is_delta();
  const Shape& shape = scene.shapes[emitter->shape].shape;
  const Imath::V3d center = bounds(shape).center();
  const Imath::Box3d box = box_at_opening(shape);
  const double half_size = box.size().length() / 2;
  const double cosine = 1 - limit_sr / (2 * std::numbers::pi);
  const double far_enough = half_size / std::sqrt((1 - cosine) * (1 + cosine));
  const double reach = far_enough + bounds(shape).size().length() / 2 - half_size;
  const auto elsewhere = [&](const Viewpoint& place) { return place.shape != emitter->shape; };
  const auto around = [&](const Viewpoint& place) {
    return place.shape ? distance_around(scene.shapes[*place.shape].shape, box.center()) : 0;
  };
  const auto close = [&](const Viewpoint& place) {
    return elsewhere(place) && (place.at - center).length() <= reach && around(place) <= far_enough;
  };
  const auto lights_what_is_close = [&] { return any_near(from.scattering, center.x, reach, close); };
  if (std::ranges::none_of(from.places, elsewhere)) return !lights_what_is_close();
  return !any_near(from.places, center.x, reach, [&](const Viewpoint& place) {
    return close(place) && (around(place) == 0 || lights_what_is_close());
  });
}

}  // namespace abbe
