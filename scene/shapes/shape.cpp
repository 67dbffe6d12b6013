#include "scene/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <utility>

#include "io/error.h"
#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/placed.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {
namespace {

[[noreturn]] void throw_cannot_emit() {
  throw Error(ErrorCode::internal, "instance", "an instance has no area to emit from");
}

// Only meshes are sampled by a table.
SurfacePoint sample_shape(const Mesh& mesh, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  return sample_area(mesh, triangle_cdf, u);
}
template <typename S>
SurfacePoint sample_shape(const S& shape, const std::vector<float>& /*triangle_cdf*/, Imath::V2f u) {
  return sample_area(shape, u);
}

}  // namespace

// A moving shape is rigid, so that its prototype has the same area.
static double area(const PlacedShape& placed) {
  if (!placed.at->motion) throw_cannot_emit();
  return std::visit([](const auto& s) { return area(s); }, placed.of->shape);
}
static SurfacePoint sample_area(const PlacedShape& /*placed*/, Imath::V2f /*u*/) {
  throw_cannot_emit();
}

template <typename S>
concept SampledByArea = std::same_as<S, Mesh> || requires {
  static_cast<SurfacePoint (*)(const S&, Imath::V2f)>(sample_area);
};
// Functions that each shape implements, with exactly these signatures. A plain call would not check them,
// because a shape converts implicitly to the variant, whose function would be found instead.
template <typename S>
concept ShapeModel = SampledByArea<S> && requires {
  static_cast<std::optional<ShapeHit<float>> (*)(const S&, const BasicRay<float>&, float)>(intersect);
  static_cast<std::optional<ShapeHit<double>> (*)(const S&, const BasicRay<double>&, double)>(intersect);
  static_cast<Imath::Box3d (*)(const S&)>(bounds);
  static_cast<double (*)(const S&)>(area);
};
template <typename List>
constexpr bool kAllShapeModels = false;
template <typename... Shapes>
constexpr bool kAllShapeModels<std::variant<Shapes...>> = (ShapeModel<Shapes> && ...);
static_assert(kAllShapeModels<Shape>);

template <typename T>
std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min) {
  return std::visit([&](const auto& s) { return intersect(s, ray, t_min); }, shape);
}
template std::optional<ShapeHit<float>> intersect(const Shape&, const BasicRay<float>&, float);
template std::optional<ShapeHit<double>> intersect(const Shape&, const BasicRay<double>&, double);

std::shared_ptr<const Prototype> make_prototype(PlainShape shape) {
  const Imath::Box3d box = std::visit([](const auto& s) { return bounds(s); }, shape);
  return std::make_shared<const Prototype>(Prototype{std::move(shape), box});
}

Imath::Box3d bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return bounds(s); }, shape);
}

bool may_intersect(const Shape& shape, const Imath::Box3d& box) {
  if (!bounds(shape).intersects(box)) return false;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    Imath::V3d furthest;  // corner relative to the center
    for (int k = 0; k < 3; ++k)
      furthest[k] =
          std::max(std::abs(box.min[k] - sphere->center[k]), std::abs(box.max[k] - sphere->center[k]));
    return furthest.length() >= sphere->radius;
  }
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh == nullptr ||
         std::any_of(mesh->triangles.begin(), mesh->triangles.end(), [&](const auto& corners) {
           Imath::Box3d around;
           for (const std::uint32_t corner : corners) around.extendBy(mesh->vertices[corner]);
           return around.intersects(box);
         });
}

double area(const Shape& shape) {
  return std::visit([](const auto& s) { return area(s); }, shape);
}

SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (placed != nullptr && placed->at->motion)
    return std::visit([&](const auto& s) { return sample_shape(s, triangle_cdf, u); }, placed->of->shape);
  return std::visit([&](const auto& s) { return sample_shape(s, triangle_cdf, u); }, shape);
}

}  // namespace abbe
