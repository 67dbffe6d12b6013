#include "transport/path/path_vertex.h"

#include <cmath>
#include <limits>

#include "scene/extent.h"
#include "scene/lights/emission.h"
#include "transport/path/polarised_ends.h"

namespace abbe {
namespace {

// What is asked of a vertex: of which scene, at which wavelengths and time, towards where.
struct Asked {
  const Scene& scene;
  const PathVertex& vertex;
  const Imath::V3f& w;
};

std::optional<CameraDensity> seen(const CameraVertex& at, const Asked& asked) {
  return density(asked.scene.camera, ray_at(at.point, asked.w, asked.vertex.time), asked.vertex.lambda_nm(),
                 at.route);
}

SampledSpectrum sent(const CameraVertex& at, const Asked& asked, TransportMode /*mode*/) {
  const std::optional<CameraDensity> camera = seen(at, asked);
  return camera ? camera->importance * camera->cos_theta : SampledSpectrum();
}

SampledSpectrum sent(const LightVertex& at, const Asked& asked, TransportMode /*mode*/) {
  const Light& light = asked.scene.lights[at.light];
  if (!emits_towards(light, at.normal, asked.w)) return {};
  if (const auto* spot = std::get_if<SpotLight>(&light.kind);
      spot != nullptr && !spot->lights(asked.w, asked.vertex.time))
    return {};
  const float cosine = light.is<AreaLight>() ? std::abs(at.normal.dot(asked.w)) : 1.0F;
  return emission_from(light, -asked.w, asked.vertex.lambda_nm()) * cosine;
}

SampledSpectrum sent(const SurfaceVertex& at, const Asked& asked, TransportMode mode) {
  const SurfaceVertex::Departure sent = at.towards(asked.w, mode);
  return sent.f * std::abs(sent.wi.z);
}

SampledSpectrum sent(const MediumVertex& at, const Asked& asked, TransportMode /*mode*/) {
  return SampledSpectrum(pdf(at.phase, at.from, asked.w));
}

SampledSpectrum drawn(const CameraVertex& at, const Asked& asked, const Imath::V3f& /*before*/) {
  const std::optional<CameraDensity> camera = seen(at, asked);
  return camera ? camera->pdf_direction : SampledSpectrum();
}

SampledSpectrum drawn(const LightVertex& at, const Asked& asked, const Imath::V3f& /*before*/) {
  const EmissionDensity of =
      emission_density(asked.scene.lights[at.light], at.normal, asked.w,
                       static_cast<float>(scene_radius(asked.scene.bounds)), asked.vertex.time);
  return SampledSpectrum(at.at_infinity ? of.pdf_position : of.pdf_direction);
}

SampledSpectrum drawn(const SurfaceVertex& at, const Asked& asked, const Imath::V3f& before) {
  return pdf(at.bsdf, at.frame.to_local(before), at.frame.to_local(asked.w));
}

SampledSpectrum drawn(const MediumVertex& at, const Asked& asked, const Imath::V3f& before) {
  return SampledSpectrum(pdf(at.phase, -before, asked.w));
}

}  // namespace

const Imath::V3f& point_of(const PathVertex& vertex) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->hit.point;
  if (const auto* camera = std::get_if<CameraVertex>(&vertex.at)) return camera->point;
  if (const auto* light = std::get_if<LightVertex>(&vertex.at)) return light->point;
  return std::get<MediumVertex>(vertex.at).point;
}

std::optional<Imath::V3f> normal_of(const Scene& scene, const PathVertex& vertex) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->hit.normal;
  if (const auto* light = std::get_if<LightVertex>(&vertex.at))
    return light->normal.length2() > 0 ? std::optional(light->normal) : std::nullopt;
  if (!std::holds_alternative<CameraVertex>(vertex.at)) return std::nullopt;
  if (is_meter(scene.camera)) return meter_normal(scene.camera, point_of(vertex));
  const CameraTraits camera = traits(scene.camera);
  if (!camera.axis) return std::nullopt;
  return Imath::V3f(direction_at(scene.camera, *camera.axis, vertex.time));
}

Way way_from(const PathVertex& a, const PathVertex& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (b.at_infinity()) return {point_of(b), kInfinity};
  if (a.at_infinity()) return {-point_of(a), kInfinity};
  const Imath::V3d d = Imath::V3d(point_of(b)) - Imath::V3d(point_of(a));
  const double distance = d.length();
  return {Imath::V3f(d * (1 / distance)), distance};
}

bool on_ghost(const PathVertex& vertex) {
  const auto* camera = std::get_if<CameraVertex>(&vertex.at);
  return camera != nullptr && camera->route > 0;
}

SampledSpectrum sent_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                             TransportMode mode) {
  return std::visit([&](const auto& at) { return sent(at, {scene, vertex, w}, mode); }, vertex.at);
}

Polarisation polarisation_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                                  TransportMode mode) {
  if (const auto* light = std::get_if<LightVertex>(&vertex.at))
    return polarisation_of_lamp(scene.lights[light->light], w);
  const CarriedPolarisation& carried = vertex.packet.polarisation;
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at))
    return carried->through(surface->mueller(surface->frame.to_local(w), false),
                            light_travels(-surface->frame.to_world(surface->wo), mode), mode);
  if (const auto* medium = std::get_if<MediumVertex>(&vertex.at))
    return carried->through(mueller(medium->phase, medium->from, w), light_travels(medium->from, mode), mode);
  const auto camera = seen(std::get<CameraVertex>(vertex.at), {scene, vertex, w});
  return polarisation_of_film(scene, -w, vertex.time, camera ? images_of(*camera) : nullptr);
}

SampledSpectrum direction_pdf(const Scene& scene, const PathVertex& vertex, const Imath::V3f& before,
                              const Imath::V3f& w) {
  return std::visit([&](const auto& at) { return drawn(at, {scene, vertex, w}, before); }, vertex.at);
}

float solid_angle_per_area(const Scene& scene, const PathVertex& from, const PathVertex& to) {
  if (to.at_infinity()) return 1;
  const Way way = way_from(from, to);
  const std::optional<Imath::V3f> normal = normal_of(scene, to);
  const double cosine = normal ? std::abs(static_cast<double>(normal->dot(way.direction))) : 1;
  return static_cast<float>(from.at_infinity() ? cosine : cosine / (way.distance * way.distance));
}

}  // namespace abbe
