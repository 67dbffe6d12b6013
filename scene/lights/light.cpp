#include "scene/lights/light.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "io/error.h"
#include "materials/bsdf/warp.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

// Arguments of `sample_light` for one kind of light.
struct SampleRequest {
  const LightSampleContext& context;
  Imath::V2f u;
  float time;
};

std::optional<LightSample> sample_kind(const Light& light, const AreaLight& emitter,
                                       const std::vector<ShapeInstance>& shapes,
                                       const SampleRequest& request) {
  const Imath::V3f& point = request.context.point;
  const auto [at, solid_angle_pdf] =
      sample_area_light_at(request.time, emitter, shapes[emitter.shape].shape, Imath::V3d(point), request.u);
  const Imath::V3d d = Imath::V3d(at.point) - Imath::V3d(point);
  const double distance = d.length();
  const double pdf =
      solid_angle_pdf ? *solid_angle_pdf : density_by_area(emitter, d, distance, Imath::V3d(at.normal));
  const Imath::V3f wi(d * (1 / distance));
  if (!(pdf > 0) || !emits_towards(light, at.normal, -wi)) return std::nullopt;
  return LightSample{wi,
                     static_cast<float>(distance),
                     1,
                     static_cast<float>(pdf),
                     offset_point(at.point, at.normal, -wi),
                     at.normal};
}

// Inverse-square falloff, computed in double because the light may be very close.
std::optional<LightSample> from_point(const Imath::V3f& position, const Imath::V3f& point) {
  const Imath::V3d d = Imath::V3d(position) - Imath::V3d(point);
  const double distance2 = d.length2();
  if (!(distance2 > 0)) return std::nullopt;
  return LightSample{Imath::V3f(d.normalized()), static_cast<float>(std::sqrt(distance2)),
                     static_cast<float>(1 / distance2), 1, position};
}

std::optional<LightSample> sample_kind(const Light&, const PointLight& emitter,
                                       const std::vector<ShapeInstance>&, const SampleRequest& request) {
  return from_point(position_at(emitter, request.time), request.context.point);
}

std::optional<LightSample> sample_kind(const Light&, const SpotLight& emitter,
                                       const std::vector<ShapeInstance>&, const SampleRequest& request) {
  std::optional<LightSample> sample = from_point(position_at(emitter, request.time), request.context.point);
  if (!sample || !emitter.illuminates(-sample->wi, request.time)) return std::nullopt;
  return sample;
}

std::optional<Imath::V3f> sample_direction(const EnvironmentLight& environment,
                                           const SampleRequest& request) {
  if (environment.image) return environment.image->sample(request.u);
  if (!request.context.side) return sample_area(Sphere{{0, 0, 0}, 1}, request.u).normal;
  return Basis<float>(*request.context.side).to_world(cosine_hemisphere(request.u));
}

std::optional<LightSample> sample_kind(const Light&, const EnvironmentLight& environment,
                                       const std::vector<ShapeInstance>&, const SampleRequest& request) {
  const auto wi = sample_direction(environment, request);
  if (!wi) return std::nullopt;
  // The rounded direction may fall into the next texel. Density and radiance then both belong to that texel.
  const float pdf = environment.pdf(request.context, *wi);
  if (!(pdf > 0)) return std::nullopt;
  return LightSample{*wi, kInfinity, 1, pdf, request.context.point};
}

std::optional<LightSample> sample_kind(const Light&, const DirectionalLight& directional,
                                       const std::vector<ShapeInstance>&, const SampleRequest& request) {
  return LightSample{directional.towards, kInfinity, 1, 1, request.context.point};
}

std::optional<LightSample> sample_kind(const Light&, const SunLight& sun, const std::vector<ShapeInstance>&,
                                       const SampleRequest& request) {
  const float phi = 2 * std::numbers::pi_v<float> * request.u.y;
  return LightSample{direction_about(sun.towards, request.u.x * sun.cap, phi), kInfinity, 1,
                     cone_pdf(sun.cap), request.context.point};
}

// Light that arrives from the unit direction `wi`, of a light hit at `hit` with that normal, at some time.
struct LightHit {
  const LightSampleContext& context;
  const Imath::V3f& wi;
  const Imath::V3f& hit;
  const Imath::V3f& normal;
  float time;
};

float pdf_of(const AreaLight& emitter, const std::vector<ShapeInstance>& shapes, const LightHit& at) {
  const Shape& shape = shapes[emitter.shape].shape;
  const Imath::V3d from(at.context.point);
  const Imath::V3d local_point =
      motion_of(shape) == nullptr ? from : from * pose_of(shape, at.time).to_prototype;
  if (const auto height = wide_cone(shape, local_point))
    return static_cast<float>(1 / (2 * std::numbers::pi * *height));
  if (const auto rectangle = wide_rectangle(emitter, local_point))
    return static_cast<float>(1 / rectangle->solid_angle());
  const Imath::V3d d = Imath::V3d(at.hit) - from;
  return static_cast<float>(density_by_area(emitter, d, d.length(), Imath::V3d(at.normal)));
}
float pdf_of(const PointLight&, const std::vector<ShapeInstance>&, const LightHit&) {
  return 0;
}
float pdf_of(const SpotLight&, const std::vector<ShapeInstance>&, const LightHit&) {
  return 0;
}
float pdf_of(const EnvironmentLight& environment, const std::vector<ShapeInstance>&, const LightHit& at) {
  return environment.pdf(at.context, at.wi);
}
float pdf_of(const DirectionalLight&, const std::vector<ShapeInstance>&, const LightHit&) {
  return 0;
}
float pdf_of(const SunLight& sun, const std::vector<ShapeInstance>&, const LightHit& at) {
  return sun.contains(at.wi) ? cone_pdf(sun.cap) : 0.0F;
}

// Etendue of each kind; `across` is the cross-section [m^2] for light from infinity.
double etendue_of(const AreaLight& emitter, double /*across*/) {
  return std::numbers::pi * emitter.area * (emitter.two_sided ? 2 : 1);
}
double etendue_of(const PointLight& /*light*/, double /*across*/) {
  return 4 * std::numbers::pi;
}
double etendue_of(const SpotLight& emitter, double /*across*/) {
  return 2 * std::numbers::pi * static_cast<double>(emitter.cap);
}
double etendue_of(const EnvironmentLight& /*environment*/, double across) {
  return 4 * std::numbers::pi * across;
}
double etendue_of(const DirectionalLight& /*beam*/, double across) {
  return across;
}
double etendue_of(const SunLight& sun, double across) {
  return sun.projected_solid_angle() * across;
}

// Functions that each kind of light implements.
template <typename Kind>
concept LightModel = requires(const Light& light, const Kind& kind, const std::vector<ShapeInstance>& shapes,
                              const SampleRequest& request, const LightHit& at) {
  { sample_kind(light, kind, shapes, request) } -> std::same_as<std::optional<LightSample>>;
  { pdf_of(kind, shapes, at) } -> std::same_as<float>;
  { etendue_of(kind, 1.0) } -> std::same_as<double>;
};
template <typename List>
constexpr bool kAllLightModels = false;
template <typename... Kinds>
constexpr bool kAllLightModels<std::variant<Kinds...>> = (LightModel<Kinds> && ...);
static_assert(kAllLightModels<decltype(Light::kind)>);

}  // namespace

void AreaLight::measure(const Shape& of) {
  area = abbe::area(of);
  triangle_cdf = abbe::triangle_cdf(of);
  if (const auto* quad = plain<Quad>(of))
    flat = std::make_shared<const EmittingQuad>(EmittingQuad{RenderedQuad(*quad), Rectangle::of(*quad)});
}

double SunLight::projected_solid_angle() const {
  const auto height = static_cast<double>(cap);
  return std::numbers::pi * height * (2 - height);
}

const Imath::V3f* light_position(const Light& light) {
  if (const auto* emitter = std::get_if<PointLight>(&light.kind)) return &emitter->position;
  if (const auto* emitter = std::get_if<SpotLight>(&light.kind)) return &emitter->position;
  return nullptr;
}

template <typename Emitter>
static Imath::V3f moved_position(const Emitter& emitter, float time) {
  if (!emitter.motion) return emitter.position;
  return Imath::V3f(Imath::V3d(emitter.position) * emitter.motion->since_opening(static_cast<double>(time)));
}
Imath::V3f position_at(const PointLight& emitter, float time) {
  return moved_position(emitter, time);
}
Imath::V3f position_at(const SpotLight& emitter, float time) {
  return moved_position(emitter, time);
}

Imath::V3f SpotLight::axis_at(float time) const {
  if (!motion) return axis;
  Imath::V3d rotated;
  motion->since_opening(static_cast<double>(time)).multDirMatrix(Imath::V3d(axis), rotated);
  return Imath::V3f(rotated);
}

const Motion* motion_of(const Light& light, const std::vector<ShapeInstance>& shapes) {
  if (const auto* emitter = std::get_if<PointLight>(&light.kind)) return emitter->motion.get();
  if (const auto* emitter = std::get_if<SpotLight>(&light.kind)) return emitter->motion.get();
  const auto* emitter = std::get_if<AreaLight>(&light.kind);
  return emitter != nullptr ? motion_of(shapes[emitter->shape].shape) : nullptr;
}

float EnvironmentLight::pdf(const LightSampleContext& context, const Imath::V3f& wi) const {
  if (image) return image->pdf(wi);
  return context.side ? std::max(0.0F, context.side->dot(wi)) / std::numbers::pi_v<float>
                      : 1 / (4 * std::numbers::pi_v<float>);
}

SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                              const SampledSpectrum& wavelengths_nm) {
  const auto* environment = std::get_if<EnvironmentLight>(&light.kind);
  if (environment == nullptr || !environment->image) return light.emission(wavelengths_nm);
  return environment->image->radiance(wi, wavelengths_nm);
}

std::optional<LightSample> sample_light(const Light& light, const std::vector<ShapeInstance>& shapes,
                                        const LightSampleContext& context, Imath::V2f u, float time) {
  const SampleRequest request{context, u, time};
  return std::visit([&](const auto& kind) { return sample_kind(light, kind, shapes, request); }, light.kind);
}

float light_pdf(const Light& light, const std::vector<ShapeInstance>& shapes,
                const LightSampleContext& context, const Imath::V3f& wi, const Imath::V3f& hit_point,
                const Imath::V3f& hit_normal, float time) {
  if (!emits_towards(light, hit_normal, -wi)) return 0;
  return std::visit(
      [&](const auto& kind) {
        return pdf_of(kind, shapes, {context, wi, hit_point, hit_normal, time});
      },
      light.kind);
}

bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo) {
  const auto* emitter = std::get_if<AreaLight>(&light.kind);
  return emitter == nullptr || emitter->two_sided || normal.dot(wo) > 0;
}

EmissionPoint sample_emission_point(const Light& light, const std::vector<ShapeInstance>& shapes,
                                    Imath::V2f u, float time) {
  if (const auto* emitter = std::get_if<PointLight>(&light.kind))
    return {position_at(*emitter, time), Imath::V3f(0), 1};
  if (const auto* emitter = std::get_if<SpotLight>(&light.kind))
    return {position_at(*emitter, time), Imath::V3f(0), 1};
  const auto* emitter = std::get_if<AreaLight>(&light.kind);
  if (emitter == nullptr)
    throw Error(ErrorCode::internal, "light \"" + light.name + "\"",
                "a light at infinity has no point to emit from");
  const Shape& shape = shapes[emitter->shape].shape;
  SurfacePoint at = sample_area(*emitter, shape, u);
  if (motion_of(shape) != nullptr) at = to_world(pose_of(shape, time), at);
  return {at.point, at.normal, static_cast<float>(1 / emitter->area)};
}

double etendue(const Light& light, double scene_radius_m) {
  const double across = std::numbers::pi * scene_radius_m * scene_radius_m;
  return std::visit([across](const auto& kind) { return etendue_of(kind, across); }, light.kind);
}

ScaledCurve mean_emission(const Light& light) {
  const auto* environment = std::get_if<EnvironmentLight>(&light.kind);
  if (environment == nullptr || !environment->image) return light.emission;
  return environment->image->mean_radiance();
}

Curve power(const Light& light, double scene_radius_m) {
  return scaled(mean_emission(light).curve(), etendue(light, scene_radius_m));
}

std::size_t memory_bytes(const Light& light) {
  std::size_t bytes = sizeof(Light);
  if (light.name.capacity() > std::string().capacity()) bytes += light.name.capacity() + 1;
  if (const auto* environment = std::get_if<EnvironmentLight>(&light.kind); environment && environment->image)
    bytes += environment->image->memory_bytes();
  if (const auto* emitter = std::get_if<AreaLight>(&light.kind))
    bytes += emitter->triangle_cdf.size() * sizeof(float) + (emitter->flat ? sizeof(EmittingQuad) : 0);
  return bytes;
}

}  // namespace abbe
