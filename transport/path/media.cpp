#include "transport/path/media.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

bool contains_medium(const Scene& scene, std::uint32_t shape) {
  return encloses_medium(scene.materials[scene.shapes[shape].material]);
}

// True if the medium of `a` replaces that of `b` where both shapes overlap. The higher priority wins. Among
// equals the smaller volume wins, which is the inner one if either contains the other; among equal volumes,
// the later shape of the scene. The result does not depend on the order of entry unless one of them encloses
// no volume.
bool displaces(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto priority = [&](std::uint32_t of) { return scene.materials[scene.shapes[of].material].priority; };
  if (priority(a) != priority(b)) return priority(a) > priority(b);
  const double volume_a = scene.shapes[a].volume;
  const double volume_b = scene.shapes[b].volume;
  return volume_a > 0 && volume_b > 0 && std::tuple(volume_b, a) > std::tuple(volume_a, b);
}

// Unit that a ray enters and leaves: a shape that encloses a volume, or all shapes of one material that do
// not, such as the faces of a body.
using Body = std::pair<bool, std::uint32_t>;
Body body_of(const Scene& scene, std::uint32_t shape) {
  const bool closed = scene.shapes[shape].volume > 0;
  return {closed, closed ? shape : scene.shapes[shape].material};
}

// Number of exits minus number of entries of a ray for one body, with the distance and the shape of the last
// exit.
struct Crossings {
  int exits = 0;
  float last_exit = 0;
  std::uint32_t by = 0;
};

// Crossings of each body with a medium by the ray from `from` along the unit vector `direction`.
std::map<Body, Crossings> crossings(const Scene& scene, const Imath::V3f& from, const Imath::V3f& direction,
                                    float time) {
  std::map<Body, Crossings> found;
  Ray ray = ray_at(from, direction, time);
  while (const std::optional<SurfaceHit> hit = scene.intersect(ray)) {
    SurfaceHit last = *hit;
    const CoincidentHits together = scene.coincident(ray, *hit);
    for (const SurfaceHit& other : together.all()) {
      last.coincidence_radius =
          std::max(last.coincidence_radius, std::abs((other.point - last.point).dot(last.normal)));
      if (!contains_medium(scene, other.shape)) continue;
      Crossings& of = found[body_of(scene, other.shape)];
      const bool leaves = other.normal.dot(direction) > 0;
      of.exits += leaves ? 1 : -1;
      if (!leaves) continue;
      of.last_exit = (other.point - from).length();
      of.by = other.shape;
    }
    ray = spawn(last, direction, ray.time);
  }
  return found;
}

}  // namespace

void MediumStack::enter(const Scene& scene, std::uint32_t shape) {
  if (!contains_medium(scene, shape)) return;  // a pane modelled as a single surface
  const auto begin = shapes_.begin();
  if (std::find(begin, begin + static_cast<std::ptrdiff_t>(count_), shape) !=
      begin + static_cast<std::ptrdiff_t>(count_))
    return;
  if (count_ == kMaxShapes)
    throw Error(ErrorCode::resource, scene.shapes[shape].name,
                fmt::format("too many nested shapes with media (allowed at most {}): remove a shape or make "
                            "one a surface without interior",
                            kMaxShapes));
  std::size_t at = count_++;
  for (; at > 0 && displaces(scene, shapes_[at - 1], shape); --at) shapes_[at] = shapes_[at - 1];
  shapes_[at] = shape;
}

void MediumStack::leave(const Scene& scene, std::uint32_t shape) {
  const std::optional<std::uint32_t> entered = entry_of(scene, shape);
  const auto end = shapes_.begin() + static_cast<std::ptrdiff_t>(count_);
  if (entered)
    count_ = static_cast<std::size_t>(std::remove(shapes_.begin(), end, *entered) - shapes_.begin());
}

std::optional<std::uint32_t> MediumStack::entry_of(const Scene& scene, std::uint32_t shape) const {
  std::optional<std::uint32_t> found;
  for (const std::uint32_t one : shapes()) {
    if (one == shape) return shape;
    if (scene.shapes[one].material == scene.shapes[shape].material) found = one;
  }
  return found;
}

MediumStack enclosing_media(const Scene& scene, const Imath::V3f& point, float time) {
  MediumStack media;
  if (!scene.features.encloses_media) return media;
  const auto ahead = crossings(scene, point, askew_direction<float>(), time);
  const auto behind = crossings(scene, point, -askew_direction<float>(), time);
  std::vector<std::pair<float, std::uint32_t>> enclosing_shapes;
  for (const auto& [body, of] : ahead) {
    const auto found = behind.find(body);
    if (of.exits > 0 && found != behind.end() && found->second.exits > 0)
      enclosing_shapes.emplace_back(of.last_exit, of.by);
  }
  std::sort(enclosing_shapes.rbegin(), enclosing_shapes.rend());  // outermost first
  for (const auto& [exit, shape] : enclosing_shapes) media.cross(scene, shape, true);
  return media;
}

MediumStack media_at_camera(const Scene& scene) {
  if (!is_probe(scene.camera)) return enclosing_media(scene, Imath::V3f(center(scene.camera)));
  return enclosing_media(scene, probe_point(scene.camera, {0.5F, 0.5F}));
}

std::optional<MediumStack> media_at_light(const Scene& scene, const Light& light) {
  if (light.at_infinity() || scene.is_distant(light)) return MediumStack();
  const auto media_at_point = [&](const std::array<float, 2>& u) {
    const EmissionPoint at = sample_emission_point(light, scene.shapes, {u[0], u[1]}, 0);
    return enclosing_media(scene, light.is_delta() ? at.point : offset_point(at.point, at.normal, at.normal));
  };
  MediumStack center = media_at_point(kRepresentativePoints.front());
  if (light.is_delta()) return center;
  for (const std::array<float, 2>& u : kRepresentativePoints) {
    const MediumStack there = media_at_point(u);
    if (!std::ranges::equal(there.shapes(), center.shapes())) return std::nullopt;
  }
  return center;
}

bool media_may_change(const Scene& scene, const Imath::Box3d& box, bool moves) {
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i].shape;
    const bool overlaps =
        motion_of(shape) != nullptr ? bounds(shape).intersects(box) : moves && may_intersect(shape, box);
    if (overlaps && contains_medium(scene, i)) return true;
  }
  return false;
}

GridSegment march_grid_along(const PlacedGrid& grid, const Shape& shape, const BasicRay<double>& ray,
                             float distance, float column) {
  const BasicRay<double> described = to_description(shape, ray);
  return grid.march(described.origin, described.direction, distance, column);
}

MediumAt medium_at(const Scene& scene, const MediumStack& stack, const SampledSpectrum& wavelengths_nm) {
  if (stack.empty()) return {};
  const ShapeInstance& innermost = scene.shapes[stack.innermost()];
  const Material& material = scene.materials[innermost.material];
  const RefractiveIndex* index = interior_index(material);
  MediumAt medium;
  if (index != nullptr && index->absorbing()) medium = {true, index->absorption_per_m(wavelengths_nm)};
  const Medium* interior_medium = abbe::medium(material);
  if (interior_medium == nullptr) return medium;
  medium.attenuating = medium.attenuating || interior_medium->absorbs() || interior_medium->scatters();
  if (interior_medium->absorbs())
    medium.extinction_per_m += interior_medium->absorption_per_m(wavelengths_nm);
  if (interior_medium->scatters()) {
    medium.scattering = interior_medium;
    medium.scattering_per_m = interior_medium->scattering_per_m(wavelengths_nm);
    medium.extinction_per_m += medium.scattering_per_m;
  }
  if (interior_medium->grid) {
    medium.grid = &*interior_medium->grid;
    medium.grid_shape = &innermost.shape;
  }
  return medium;
}

}  // namespace abbe
