#include "scene/lights/area_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/shapes/basic.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

// Area over squared distance below which a rectangle is small. Cosine and distance then vary little, and the
// cheaper sampling by area has the lower error per time.
constexpr double kSmall = 0.5;
// Ratio of height to size below which a rectangle is seen edge-on and the sum of angles cancels.
constexpr double kEdgeOn = 1e-4;

constexpr float kBelowOne = 0x1.fffffep-1F;

// A point on a light, and its density in solid angle unless it was sampled by area.
struct AreaSample {
  SurfacePoint at;
  std::optional<double> pdf = {};
};

// Pdf [1/sr] of a point sampled by area. `d` is the vector from the shaded point to the light, `distance` its
// length.
double density_by_area(const AreaLight& light, const Imath::V3d& d, double distance,
                       const Imath::V3d& normal) {
  const double facing = std::abs(d.dot(normal));
  return facing > 0 ? distance * distance * distance / (facing * light.area) : 0;
}

// 1 - cos of the half angle that a sphere subtends, for a point outside. A point on the sphere, up to
// rounding, is not outside: the whole sphere may lie in front of it.
[[gnu::always_inline]] inline std::optional<double> cone_height(const Sphere& sphere,
                                                                const Imath::V3d& point) {
  const double distance = (point - sphere.center).length();
  const double rounding = 16 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                          std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  if (distance <= sphere.radius + rounding) return std::nullopt;
  const double sine = sphere.radius / distance;
  const double cosine = std::sqrt((distance - sphere.radius) * (distance + sphere.radius)) / distance;
  return sine * sine / (1 + cosine);
}

AreaSample sample_cone(const Sphere& sphere, double height, const Imath::V3d& point, Imath::V2f u) {
  const double descent = static_cast<double>(u.x) * height;  // 1 - cos theta
  const double sine = std::sqrt(descent * (2 - descent));
  const double phi = 2 * std::numbers::pi * static_cast<double>(u.y);
  const Basis<double> axes((sphere.center - point).normalized());
  const Imath::V3d direction = axes.to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - descent});
  const auto hit = intersect(sphere, BasicRay<double>{point, direction}, 0.0);
  // A tangential ray may miss by rounding; then the point on the rim nearest to it is used.
  const Imath::V3d normal =
      hit ? hit->normal
          : (point + direction * (sphere.center - point).dot(direction) - sphere.center).normalized();
  return {{Imath::V3f(sphere.center + normal * sphere.radius), Imath::V3f(normal)},
          1 / (2 * std::numbers::pi * height)};
}

// The solid angle of a rectangular or spherical light, where sampling by solid angle is better than by area.
std::optional<SphericalRectangle> wide_rectangle(const AreaLight& light, const Imath::V3d& point) {
  if (!light.flat || !light.flat->rectangle) return std::nullopt;
  return SphericalRectangle::project(*light.flat->rectangle, point);
}
// Inlined: a returned optional number is stored in parts and loaded as a whole, which stalls.
[[gnu::always_inline]] inline std::optional<double> wide_cone(const Shape& shape, const Imath::V3d& point) {
  const auto* sphere = plain<Sphere>(shape);
  if (sphere == nullptr) return std::nullopt;
  return cone_height(*sphere, point);
}

SurfacePoint sample_area(const AreaLight& light, const Shape& shape, Imath::V2f u) {
  return light.flat ? sample_area(light.flat->quad, u) : sample_area(shape, light.triangle_cdf, u);
}

// Placement of a moving light's shape at some time.
Placement pose_of(const Shape& shape, float time) {
  return placement_at(*std::get<PlacedShape>(shape).at, static_cast<double>(time));
}

// Converts a sampled point of a moving light from its prototype's coordinates to the world.
SurfacePoint to_world(const Placement& placement, const SurfacePoint& at) {
  return {Imath::V3f(Imath::V3d(at.point) * placement.to_world),
          Imath::V3f(normal_to_world(placement, Imath::V3d(at.normal)))};
}

// Samples an area light; for a moving light in its prototype's coordinates.
AreaSample sample_area_light(const AreaLight& light, const Shape& shape, const Imath::V3d& point,
                             Imath::V2f u) {
  if (const auto height = wide_cone(shape, point))
    return sample_cone(*plain<Sphere>(shape), *height, point, u);
  if (const auto rectangle = wide_rectangle(light, point)) {
    const Imath::V2d uv = rectangle->sample(u);
    const RenderedQuad& quad = light.flat->quad;
    return {{Imath::V3f(quad.at(uv.x, uv.y)), quad.normal()}, 1 / rectangle->solid_angle()};
  }
  return {sample_area(light, shape, u)};
}

AreaSample sample_area_light_at(float time, const AreaLight& light, const Shape& shape,
                                const Imath::V3d& point, Imath::V2f u) {
  if (motion_of(shape) == nullptr) return sample_area_light(light, shape, point, u);
  const Placement moved = pose_of(shape, time);
  AreaSample sample = sample_area_light(light, shape, point * moved.to_prototype, u);
  sample.at = to_world(moved, sample.at);
  return sample;
}

}  // namespace

std::optional<Rectangle> Rectangle::of(const Quad& quad) {
  const double size_u = quad.edge_u.length();
  const double size_v = quad.edge_v.length();
  if (std::abs(quad.edge_u.dot(quad.edge_v)) > 1e-9 * size_u * size_v) return std::nullopt;
  return Rectangle{quad.corner,
                   quad.corner + (quad.edge_u + quad.edge_v) * 0.5,
                   quad.edge_u / size_u,
                   quad.edge_v / size_v,
                   size_u,
                   size_v};
}

std::optional<SphericalRectangle> SphericalRectangle::project(const Rectangle& rectangle,
                                                              const Imath::V3d& point) {
  const auto& [corner, center, x, y, size_u, size_v] = rectangle;
  const double distance2 = (center - point).length2();
  if (size_u * size_v < kSmall * distance2) return std::nullopt;
  const Imath::V3d to_corner = corner - point;
  SphericalRectangle r;
  r.height_ = std::abs(to_corner.dot(x.cross(y)));
  if (r.height_ < kEdgeOn * std::max({size_u, size_v, std::sqrt(distance2)})) return std::nullopt;
  r.x0_ = to_corner.dot(x);
  r.x1_ = r.x0_ + size_u;
  r.y0_ = to_corner.dot(y);
  r.y1_ = r.y0_ + size_v;
  r.start_ = r.turn_at(r.x0_);
  const Imath::V2d end = r.turn_at(r.x1_);
  const double angle = std::atan2(r.start_.cross(end), r.start_.dot(end));
  r.solid_angle_ = angle < 0 ? angle + 2 * std::numbers::pi : angle;
  return r;
}

// The solid angle between (0, 0) and (x, y) in a plane at height h is atan(x y/(h r)), where r is the
// distance of that corner. The difference for y1 and y0 is the argument of (h r1 + i x y1)(h r0 - i x y0).
// Its magnitude is (x^2 + h^2) sqrt((h^2 + y0^2)(h^2 + y1^2)).
Imath::V2d SphericalRectangle::turn_at(double x) const {
  const double d2 = x * x + height_ * height_;
  const double r0 = std::sqrt(d2 + y0_ * y0_);
  const double r1 = std::sqrt(d2 + y1_ * y1_);
  return {height_ * height_ * r0 * r1 + x * x * y0_ * y1_, x * height_ * (y1_ * r0 - y0_ * r1)};
}

Imath::V2d SphericalRectangle::sample(Imath::V2f u) const {
  // The z components of the normals of the planes through the point and the edges y = y0 and y = y1.
  const double far0 = std::sqrt(height_ * height_ + y0_ * y0_);
  const double far1 = std::sqrt(height_ * height_ + y1_ * y1_);
  const double b0 = -y0_ / far0;
  const double b1 = y1_ / far1;
  // The plane x = const through the point that has the fraction u.x of the solid angle on its left.
  const double angle = static_cast<double>(u.x) * solid_angle_;
  const Imath::V2d turn(std::cos(angle), std::sin(angle));
  const double real = start_.x * turn.x - start_.y * turn.y;
  const double imaginary = start_.x * turn.y + start_.y * turn.x;
  const double magnitude = (x0_ * x0_ + height_ * height_) * far0 * far1;
  const double f = (real * b0 + magnitude * b1) / imaginary;
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0 * b0), f), -1.0, 1.0);
  const double x = std::clamp(c * height_ / std::sqrt(std::max((1 - c) * (1 + c), 1e-300)), x0_, x1_);
  // On that line, equal steps of the sine are equal solid angles.
  const double d2 = x * x + height_ * height_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_);
  const double h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + static_cast<double>(u.y) * (h1 - h0);
  const double y = std::clamp(h * std::sqrt(d2 / std::max((1 - h) * (1 + h), 1e-300)), y0_, y1_);
  return {(x - x0_) / (x1_ - x0_), (y - y0_) / (y1_ - y0_)};
}

void AreaLight::measure(const Shapes& shapes) {
  const Shape& of = shapes[shape].shape;
  area = abbe::area(of);
  triangle_cdf = abbe::triangle_cdf(of);
  if (const auto* quad = plain<Quad>(of))
    flat = std::make_shared<const EmittingQuad>(EmittingQuad{RenderedQuad(*quad), Rectangle::of(*quad)});
}

std::optional<LightSample> AreaLight::sample(const LightQuery& query) const {
  const Imath::V3f& point = query.context.point;
  const auto [at, solid_angle_pdf] =
      sample_area_light_at(query.time, *this, query.shapes[shape].shape, Imath::V3d(point), query.u);
  const Imath::V3d d = Imath::V3d(at.point) - Imath::V3d(point);
  const double distance = d.length();
  const double pdf =
      solid_angle_pdf ? *solid_angle_pdf : density_by_area(*this, d, distance, Imath::V3d(at.normal));
  const Imath::V3f wi(d * (1 / distance));
  if (!(pdf > 0) || !emits_towards(at.normal, -wi)) return std::nullopt;
  return LightSample{wi,
                     static_cast<float>(distance),
                     1,
                     static_cast<float>(pdf),
                     offset_point(at.point, at.normal, -wi),
                     at.normal};
}

float AreaLight::pdf(const Shapes& shapes, const LightHit& at) const {
  const Shape& own = shapes[shape].shape;
  const Imath::V3d from(at.context.point);
  const Imath::V3d local_point = motion_of(own) == nullptr ? from : from * pose_of(own, at.time).to_prototype;
  if (const auto height = wide_cone(own, local_point))
    return static_cast<float>(1 / (2 * std::numbers::pi * *height));
  if (const auto rectangle = wide_rectangle(*this, local_point))
    return static_cast<float>(1 / rectangle->solid_angle());
  const Imath::V3d d = Imath::V3d(at.hit) - from;
  return static_cast<float>(density_by_area(*this, d, d.length(), Imath::V3d(at.normal)));
}

EmissionPoint AreaLight::sample_emission_point(const Shapes& shapes, Imath::V2f u, float time) const {
  const Shape& own = shapes[shape].shape;
  SurfacePoint at = sample_area(*this, own, u);
  if (motion_of(own) != nullptr) at = to_world(pose_of(own, time), at);
  return {at.point, at.normal, static_cast<float>(1 / area)};
}

Imath::V3f AreaLight::emission_direction(const Imath::V3f& normal, Imath::V2f u, float /*time*/) const {
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  const bool flip = two_sided && u.x >= 0.5F;
  const float v = two_sided ? std::min(2 * (u.x - (flip ? 0.5F : 0.0F)), kBelowOne) : u.x;
  return direction_about(flip ? -normal : normal, 1 - std::sqrt(1 - v), phi);
}

EmissionDensity AreaLight::emission_density(const EmissionQuery& query) const {
  const float cos_theta = query.normal.dot(query.wo);
  const float pdf = two_sided ? std::abs(cos_theta) / (2 * std::numbers::pi_v<float>)
                              : std::max(0.0F, cos_theta) / std::numbers::pi_v<float>;
  return {static_cast<float>(1 / area), pdf};
}

LightBounds AreaLight::bounds(const Shapes& shapes, double emission) const {
  const Shape& own = shapes[shape].shape;
  const OuterSide side = outer_side(own);
  const EmissionCone normals =
      side.normals && !two_sided
          ? EmissionCone{side.normals->axis, side.normals->spread, std::numbers::pi / 2}
          : kEverywhere;
  const Imath::Box3d own_box = box(shapes);
  const auto* sphere = std::get_if<Sphere>(&own);
  const double radius = sphere != nullptr ? sphere->radius : own_box.size().length() / 2;
  // Irradiance is at most pi times radiance.
  const double nearest = std::sqrt(side.projected_area / std::numbers::pi);
  const double intensity = emission * side.projected_area;
  return {own_box, radius, nearest, normals, intensity, intensity};
}

Imath::Box3d AreaLight::box(const Shapes& shapes) const {
  return abbe::bounds(shapes[shape].shape);
}

const Motion* AreaLight::motion_in(const Shapes& shapes) const {
  return motion_of(shapes[shape].shape);
}

}  // namespace abbe
