#include "scene/shapes/shape.h"

#include <concepts>
#include <utility>

#include "io/error.h"
#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/placed.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {
namespace {

[[noreturn]] void refuse_to_emit() {
  throw Error(ErrorCode::internal, "instance", "an instance has no area to emit from");
}
double area(const PlacedShape& /*placed*/) {
  refuse_to_emit();
}
SurfacePoint sample_area(const PlacedShape& /*placed*/, Imath::V2f /*u*/) {
  refuse_to_emit();
}

// Of all shapes, meshes alone are drawn from by a table.
SurfacePoint sample_shape(const Mesh& mesh, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  return sample_area(mesh, triangle_cdf, u);
}
template <typename S>
SurfacePoint sample_shape(const S& shape, const std::vector<float>& /*triangle_cdf*/, Imath::V2f u) {
  return sample_area(shape, u);
}

// What each shape answers.
template <typename S>
concept ShapeModel = requires(const S& shape, const BasicRay<float>& ray, const BasicRay<double>& exact,
                              const std::vector<float>& cdf, Imath::V2f u) {
  { intersect(shape, ray, 0.0F) } -> std::same_as<std::optional<ShapeHit<float>>>;
  { intersect(shape, exact, 0.0) } -> std::same_as<std::optional<ShapeHit<double>>>;
  { bounds(shape) } -> std::same_as<Imath::Box3d>;
  { area(shape) } -> std::same_as<double>;
  { sample_shape(shape, cdf, u) } -> std::same_as<SurfacePoint>;
};
template <typename List>
constexpr bool kAllShapeModels = false;
template <typename... Shapes>
constexpr bool kAllShapeModels<std::variant<Shapes...>> = (ShapeModel<Shapes> && ...);
static_assert(kAllShapeModels<Shape>);

}  // namespace

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

double area(const Shape& shape) {
  return std::visit([](const auto& s) { return area(s); }, shape);
}

SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  return std::visit([&](const auto& s) { return sample_shape(s, triangle_cdf, u); }, shape);
}

}  // namespace abbe
