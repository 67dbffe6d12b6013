#include "scene/shapes/shape.h"

#include <cmath>

#include "io/error.h"

namespace abbe {
namespace {

void require_surface(const Shape& shape) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (placed != nullptr && !placed->at->motion)
    throw Error(ErrorCode::internal, "instance", "an instance has no area to emit from");
}

// The placement of an instance at that time.
const Placement& current_placement(const PlacedShape& placed, float time, std::optional<Placement>& moved) {
  if (!placed.at->motion) return *placed.at;
  return moved.emplace(placement_at(*placed.at, static_cast<double>(time)));
}

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

// An instance is tested by its bounding box alone.
bool may_intersect(const Shape& shape, const Imath::Box3d& box) {
  if (!bounds(shape).intersects(box)) return false;
  return std::visit([&](const auto& s) { return may_intersect(s, box); }, shape);
}

// A moving shape is rigid, so that its prototype has the same area.
double area(const Shape& shape) {
  require_surface(shape);
  return visit_plain([](const auto& s) { return area(s); }, shape);
}

SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf, Imath::V2f u) {
  require_surface(shape);
  return visit_plain(
      [&]<typename S>(const S& s) {
        if constexpr (std::is_same_v<S, Mesh>)
          return sample_area(s, triangle_cdf, u);
        else
          return sample_area(s, u);
      },
      shape);
}

std::vector<float> triangle_cdf(const Shape& shape) {
  const auto* mesh = plain<Mesh>(shape);
  return mesh != nullptr ? triangle_cdf(*mesh) : std::vector<float>();
}

OuterSide outer_side(const Shape& shape) {
  if (std::holds_alternative<PlacedShape>(shape)) return {area(shape), std::nullopt};
  return visit_plain([](const auto& s) { return outer_side(s); }, shape);
}

Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle) {
  return std::visit(
      [triangle]<typename S>(const S& s) -> Imath::V3d {
        if constexpr (Triangulated<S>)
          return normal_at(s, triangle);
        else
          throw Error(ErrorCode::internal, "shape", "a curved shape has no triangles");
      },
      shape);
}

Outline outline(const Shape& shape, const DrawingPlane& plane) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  const Imath::M44d to_world = placed != nullptr ? placed->at->to_world : Imath::M44d();
  return visit_plain([&](const auto& s) { return outline(s, to_world, plane); }, shape);
}

std::optional<Imath::V3d> interpolated_normal(const Shape& shape, const Imath::V3d& point,
                                              std::size_t triangle, const Imath::V3d& geometric, float time) {
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr || mesh->normals.empty()) return std::nullopt;
  const auto* placed = std::get_if<PlacedShape>(&shape);
  std::optional<Placement> moved;
  const Placement* now = placed != nullptr ? &current_placement(*placed, time, moved) : nullptr;
  const auto& [a, b, c] = mesh->triangles[triangle];
  const Imath::V3d& origin = mesh->vertices[a];
  const PlaneCoordinates weights((now ? point * now->to_prototype : point) - origin,
                                 mesh->vertices[b] - origin, mesh->vertices[c] - origin);
  const auto& [at_a, at_b, at_c] = mesh->normals[triangle];
  Imath::V3d normal = Imath::V3d(at_a) * (1 - weights.first - weights.second) +
                      Imath::V3d(at_b) * weights.first + Imath::V3d(at_c) * weights.second;
  if (now) normal = normal_to_world(*now, normal);
  normal.normalize();
  const double side = normal.dot(geometric);
  if (side == 0) return geometric;  // the interpolated normals cancel
  return side < 0 ? -normal : normal;
}

SurfaceCoordinates coordinates(const Shape& shape, const Imath::V3d& point, std::size_t triangle,
                               float time) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  std::optional<Placement> moved;
  const Placement* now = placed != nullptr ? &current_placement(*placed, time, moved) : nullptr;
  const Imath::V3d inside = now != nullptr ? point * now->to_prototype : point;
  SurfaceCoordinates at =
      visit_plain([&](const auto& s) { return coordinates_on(s, inside, triangle); }, shape);
  if (now != nullptr)
    for (Imath::V3d* tangent : {&at.dp_du, &at.dp_dv}) *tangent = moved_direction(*tangent, now->to_world);
  return at;
}

}  // namespace abbe
