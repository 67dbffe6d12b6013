#include "scene/shapes/shape.h"

#include <utility>

#include "io/error.h"
#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/placed.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {

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
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return area(*mesh);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return area(*sphere);
  if (const auto* disc = std::get_if<Disc>(&shape)) return area(*disc);
  if (const auto* quad = std::get_if<Quad>(&shape)) return area(*quad);
  throw Error(ErrorCode::internal, "instance", "an instance has no area to emit from");
}

SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return sample_area(*mesh, triangle_cdf, u);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sample_area(*sphere, u);
  if (const auto* disc = std::get_if<Disc>(&shape)) return sample_area(*disc, u);
  if (const auto* quad = std::get_if<Quad>(&shape)) return sample_area(*quad, u);
  throw Error(ErrorCode::internal, "instance", "an instance has no area to emit from");
}

}  // namespace abbe
