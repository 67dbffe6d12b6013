#include "scene/shapes/shape.h"

#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/sphere.h"

namespace abbe {

template <typename T>
std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min) {
  return std::visit([&](const auto& s) { return intersect(s, ray, t_min); }, shape);
}
template std::optional<ShapeHit<float>> intersect(const Shape&, const BasicRay<float>&, float);
template std::optional<ShapeHit<double>> intersect(const Shape&, const BasicRay<double>&, double);

double area(const Shape& shape) {
  return std::visit([](const auto& s) { return area(s); }, shape);
}

Imath::Box3d bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return bounds(s); }, shape);
}

SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return sample_area(*mesh, triangle_cdf, u);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sample_area(*sphere, u);
  if (const auto* disc = std::get_if<Disc>(&shape)) return sample_area(*disc, u);
  return sample_area(std::get<Quad>(shape), u);
}

}  // namespace abbe
