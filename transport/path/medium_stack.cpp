#include "transport/path/medium_stack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

bool filled(const Scene& scene, std::uint32_t shape) {
  return encloses_medium(scene.materials[scene.shapes[shape].material]);
}

// Whether, where both shapes are, the matter of `a` is there: by priorities; of equals that of the smaller
// volume, which is the one that lies in the other if either does; of equal volumes the later of the scene. So
// it does not depend on which of them a path entered first, but where one encloses no volume by itself.
bool displaces(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto priority = [&](std::uint32_t of) { return scene.materials[scene.shapes[of].material].priority; };
  if (priority(a) != priority(b)) return priority(a) > priority(b);
  const double of_a = scene.shapes[a].volume;
  const double of_b = scene.shapes[b].volume;
  return of_a > 0 && of_b > 0 && std::tuple(of_b, a) > std::tuple(of_a, b);
}

// What a ray leaves and enters as one: a shape that encloses a volume, or else, by material, all those that
// do not, such as the faces of a body.
using Body = std::pair<bool, std::uint32_t>;
Body body_of(const Scene& scene, std::uint32_t shape) {
  const bool closed = scene.shapes[shape].volume > 0;
  return {closed, closed ? shape : scene.shapes[shape].material};
}

// How often more a ray leaves a body than it enters it, and where and by which shape it does so last.
struct Crossings {
  int exits = 0;
  float last_exit = 0;
  std::uint32_t by = 0;
};

std::map<Body, Crossings> crossings(const Scene& scene, const Imath::V3f& from, const Imath::V3f& direction,
                                    float time) {
  std::map<Body, Crossings> found;
  Ray ray = ray_at(from, direction, time);
  while (const std::optional<SurfaceHit> hit = scene.intersect(ray)) {
    SurfaceHit last = *hit;
    const TouchingSurfaces together = scene.touching(ray, *hit);
    for (const SurfaceHit& met : together.all()) {
      last.spread = std::max(last.spread, std::abs((met.point - last.point).dot(last.normal)));
      if (!filled(scene, met.shape)) continue;
      Crossings& of = found[body_of(scene, met.shape)];
      const bool leaves = met.normal.dot(direction) > 0;
      of.exits += leaves ? 1 : -1;
      if (!leaves) continue;
      of.last_exit = (met.point - from).length();
      of.by = met.shape;
    }
    ray = spawn(last, direction, ray.time);
  }
  return found;
}

}  // namespace

void MediumStack::enter(const Scene& scene, std::uint32_t shape) {
  if (!filled(scene, shape)) return;  // a pane modelled as one surface
  const auto begin = shapes_.begin();
  if (std::find(begin, begin + static_cast<std::ptrdiff_t>(count_), shape) !=
      begin + static_cast<std::ptrdiff_t>(count_))
    return;
  if (count_ == kMost)
    throw Error(ErrorCode::resource, scene.shapes[shape].name,
                fmt::format("too many shapes with matter in each other (allowed {})", kMost));
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

MediumStack enclosing(const Scene& scene, const Imath::V3f& point, float time) {
  MediumStack inside;
  if (!scene.needs.matter) return inside;
  const auto ahead = crossings(scene, point, askew_direction<float>(), time);
  const auto behind = crossings(scene, point, -askew_direction<float>(), time);
  std::vector<std::pair<float, std::uint32_t>> around;
  for (const auto& [body, of] : ahead) {
    const auto other = behind.find(body);
    if (of.exits > 0 && other != behind.end() && other->second.exits > 0)
      around.emplace_back(of.last_exit, of.by);
  }
  std::sort(around.rbegin(), around.rend());  // from the outermost
  for (const auto& [exit, shape] : around) inside.cross(scene, shape, true);
  return inside;
}

MediumStack around_camera(const Scene& scene) {
  if (!is_meter(scene.camera)) return enclosing(scene, Imath::V3f(middle(scene.camera)));
  return enclosing(scene, meter_point(scene.camera, {0.5F, 0.5F}));
}

std::optional<MediumStack> around_light(const Scene& scene, const Light& light) {
  if (light.at_infinity() || scene.is_far(light)) return MediumStack();
  const auto around = [&](const std::array<float, 2>& u) {
    const EmissionPoint at = sample_emission_point(light, scene.shapes, {u[0], u[1]}, 0);
    return enclosing(scene, light.is_delta() ? at.point : offset_point(at.point, at.normal, at.normal));
  };
  MediumStack middle = around(kSpreadOverLight.front());
  if (light.is_delta()) return middle;
  for (const std::array<float, 2>& u : kSpreadOverLight) {
    const MediumStack there = around(u);
    if (!std::ranges::equal(there.shapes(), middle.shapes())) return std::nullopt;
  }
  return middle;
}

bool matter_moves(const Scene& scene, const Imath::Box3d& box, bool moves) {
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i].shape;
    const bool meets =
        motion_of(shape) != nullptr ? bounds(shape).intersects(box) : moves && may_meet(shape, box);
    if (meets && filled(scene, i)) return true;
  }
  return false;
}

}  // namespace abbe
