#include "scene/small_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

// Bounding box; for a moving shape at time 0.
Imath::Box3d box_at_opening(const Shape& shape) {
  if (motion_of(shape) == nullptr) return bounds(shape);
  const auto& placed = std::get<PlacedShape>(shape);
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners(*placed.of, *placed.at)) box.extendBy(corner);
  return box;
}

// Distance [m] at time 0 of a shape that encloses the point: the nearest hit of a ray whose opposite ray hits
// the shape too. 0 if there is none.
double enclosing_distance(const Shape& shape, const Imath::V3d& viewpoint) {
  if (!box_at_opening(shape).intersects(viewpoint)) return 0;
  const Basis<double> axes(askew_direction<double>());
  double nearest = std::numeric_limits<double>::infinity();
  for (const Imath::V3d& axis : {axes.x, axes.y, axes.z}) {
    const auto ahead = intersect(shape, BasicRay<double>{viewpoint, axis}, 0.0);
    const auto behind = intersect(shape, BasicRay<double>{viewpoint, -axis}, 0.0);
    if (ahead && behind) nearest = std::min({nearest, ahead->t, behind->t});
  }
  return std::isinf(nearest) ? 0 : nearest;
}

void sort_by_x(std::vector<Viewpoint>& points) {
  std::ranges::sort(points, {}, [](const Viewpoint& viewpoint) { return viewpoint.at.x; });
}

// True if `predicate` holds for a viewpoint at most `max_distance` away along x.
template <typename Predicate>
bool any_near(const std::vector<Viewpoint>& points, double x, double max_distance, Predicate predicate) {
  const auto first =
      std::ranges::lower_bound(points, x - max_distance, {}, [](const Viewpoint& p) { return p.at.x; });
  const auto last =
      std::ranges::upper_bound(points, x + max_distance, {}, [](const Viewpoint& p) { return p.at.x; });
  return std::any_of(first, last, predicate);
}

}  // namespace

bool emits(const Light& light) {
  return light.emission.max() > 0;
}

Viewpoints specular_centers(const Scene& scene) {
  Viewpoints centers;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const Material& material = scene.materials[scene.shapes[i].material];
    const Lobes material_lobes = lobes(material);
    const Medium* contents = medium(material);
    const Viewpoint center{bounds(scene.shapes[i].shape).center(), i};
    if (material_lobes.delta) centers.points.push_back(center);
    if (material_lobes.spread || (contents != nullptr && contents->scatters()))
      centers.scattering.push_back(center);
  }
  sort_by_x(centers.points);
  sort_by_x(centers.scattering);
  return centers;
}

Viewpoints probe_viewpoints(const Scene& scene) {
  std::vector<Viewpoint> points;
  for (const std::array<float, 2>& u : kRepresentativePoints)
    points.push_back({Imath::V3d(probe_point(scene.camera, {u[0], u[1]})), std::nullopt});
  sort_by_x(points);
  return {points, {}};
}

bool subtends_less(const Scene& scene, const Light& light, const Viewpoints& from, double limit_sr) {
  const std::optional<std::uint32_t> own = surface_of(light);
  if (!own) return solid_angle(light) < limit_sr;
  const Shape& shape = scene.shapes[*own].shape;
  const Imath::V3d center = bounds(shape).center();
  const Imath::Box3d box = box_at_opening(shape);
  const double half_size = box.size().length() / 2;
  const double cosine = 1 - limit_sr / (2 * std::numbers::pi);
  const double min_distance = half_size / std::sqrt((1 - cosine) * (1 + cosine));
  const double max_distance = min_distance + bounds(shape).size().length() / 2 - half_size;
  const auto is_other_shape = [&](const Viewpoint& viewpoint) { return viewpoint.shape != *own; };
  const auto distance_to_enclosing = [&](const Viewpoint& viewpoint) {
    return viewpoint.shape ? enclosing_distance(scene.shapes[*viewpoint.shape].shape, box.center()) : 0;
  };
  const auto is_close = [&](const Viewpoint& viewpoint) {
    return is_other_shape(viewpoint) && (viewpoint.at - center).length() <= max_distance &&
           distance_to_enclosing(viewpoint) <= min_distance;
  };
  const auto has_close_scatterer = [&] {
    return any_near(from.scattering, center.x, max_distance, is_close);
  };
  if (std::ranges::none_of(from.points, is_other_shape)) return !has_close_scatterer();
  return !any_near(from.points, center.x, max_distance, [&](const Viewpoint& viewpoint) {
    return is_close(viewpoint) && (distance_to_enclosing(viewpoint) == 0 || has_close_scatterer());
  });
}

}  // namespace abbe
