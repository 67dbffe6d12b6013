#include "scene/contact.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "scene/coincidence.h"
#include "scene/extent.h"

namespace abbe {
namespace {

const Material& material_of(const Scene& scene, std::uint32_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

bool is_sheet(const Material& material) {
  return !opaque(material) && !encloses_medium(material);
}

// Shapes of some kind, and the boxes around them.
struct Boxed {
  std::uint32_t shape;
  Imath::Box3d box;
};
template <typename Kind>
std::vector<Boxed> shapes_of(const Scene& scene, const Kind& kind) {
  std::vector<Boxed> found;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    if (kind(material_of(scene, i))) found.push_back({i, bounds(scene.shapes[i].shape)});
  return found;
}

}  // namespace

std::optional<Contact> crossed_at_once(const Scene& scene) {
  const std::vector<Boxed> on = shapes_of(scene, [](const Material& material) { return !opaque(material); });
  if (on.empty()) return std::nullopt;
  const double reach = scene.touch_distance();
  const std::vector<Boxed> under = shapes_of(
      scene, [](const Material& material) { return opaque(material) || encloses_medium(material); });
  std::size_t pairs = 0;
  for (const Boxed& one : on) {
    const bool sheet = is_sheet(material_of(scene, one.shape));
    const Imath::Box3d near = grown(one.box, reach);
    for (const Boxed& other : under) {
      if (!sheet && !opaque(material_of(scene, other.shape))) continue;
      if (++pairs > kMostPairs ||
          (near.intersects(other.box) &&
           may_coincide(scene.shapes[one.shape].shape, scene.shapes[other.shape].shape, reach)))
        return Contact{one.shape, other.shape};
    }
  }
  return std::nullopt;
}

std::optional<Contact> lost_sheet(const Scene& scene) {
  const std::vector<Boxed> sheets = shapes_of(scene, is_sheet);
  if (sheets.empty()) return std::nullopt;
  const double reach = scene.touch_distance();
  const std::vector<Boxed> under = shapes_of(scene, [](const Material& material) {
    return opaque(material) || is_sheet(material) || interior(material) != nullptr;
  });
  std::size_t pairs = 0;
  for (const Boxed& sheet : sheets) {
    const Imath::Box3d near = grown(sheet.box, reach);
    std::vector<std::uint32_t> on;
    for (const Boxed& other : under) {
      if (other.shape == sheet.shape || !near.intersects(other.box)) continue;
      if (++pairs > kMostPairs) return std::nullopt;
      if (lies_on(scene.shapes[sheet.shape].shape, scene.shapes[other.shape].shape, reach))
        on.push_back(other.shape);
    }
    const auto hides = [&](std::uint32_t shape) {
      return interior(material_of(scene, shape)) == nullptr ||
             scene.shapes[shape].material != scene.shapes[on.front()].material;
    };
    if (on.size() == 1 || std::any_of(on.begin(), on.end(), hides)) return Contact{sheet.shape, on.front()};
  }
  return std::nullopt;
}

}  // namespace abbe
