#include "transport/path/path_vertex.h"

#include <cmath>
#include <limits>

#include "scene/lights/light.h"
#include "scene/working_range.h"
#include "transport/path/polarised_paths.h"

namespace abbe {
namespace {

// Arguments of an evaluation at a vertex: the scene, the vertex with its wavelengths and time, and the
// outgoing direction.
struct VertexQuery {
  const Scene& scene;
  const PathVertex& vertex;
  const Imath::V3f& w;
};

std::optional<CameraDensity> camera_density(const CameraVertex& at, const VertexQuery& query) {
  return density(query.scene.camera, ray_at(at.point, query.w, query.vertex.time), query.vertex.lambda_nm(),
                 at.route);
}

SampledSpectrum value_towards(const CameraVertex& at, const VertexQuery& query, TransportMode /*mode*/) {
  const std::optional<CameraDensity> camera = camera_density(at, query);
  return camera ? camera->importance * camera->cos_theta : SampledSpectrum();
}

SampledSpectrum value_towards(const LightVertex& at, const VertexQuery& query, TransportMode /*mode*/) {
  const Light& light = query.scene.lights[at.light];
  const float factor = emission_factor(light, at.normal, query.w, query.vertex.time);
  if (!(factor > 0)) return {};
  return emission_from(light, -query.w, query.vertex.lambda_nm()) * factor;
}

SampledSpectrum value_towards(const SurfaceVertex& at, const VertexQuery& query, TransportMode mode) {
  const SurfaceVertex::OutgoingDirection outgoing = at.eval_towards(query.w, mode);
  return outgoing.f * std::abs(outgoing.wi.z);
}

SampledSpectrum value_towards(const MediumVertex& at, const VertexQuery& query, TransportMode /*mode*/) {
  return SampledSpectrum(pdf(at.phase, at.from, query.w));
}

SampledSpectrum pdf_towards(const CameraVertex& at, const VertexQuery& query, const Imath::V3f& /*before*/) {
  const std::optional<CameraDensity> camera = camera_density(at, query);
  return camera ? camera->pdf_direction : SampledSpectrum();
}

SampledSpectrum pdf_towards(const LightVertex& at, const VertexQuery& query, const Imath::V3f& /*before*/) {
  const EmissionDensity of =
      emission_density(query.scene.lights[at.light], at.normal, query.w,
                       static_cast<float>(scene_radius(query.scene.bounds)), query.vertex.time);
  return SampledSpectrum(at.at_infinity ? of.pdf_position : of.pdf_direction);
}

SampledSpectrum pdf_towards(const SurfaceVertex& at, const VertexQuery& query, const Imath::V3f& before) {
  return pdf(at.bsdf, at.frame.to_local(before), at.frame.to_local(query.w));
}

SampledSpectrum pdf_towards(const MediumVertex& at, const VertexQuery& query, const Imath::V3f& before) {
  return SampledSpectrum(pdf(at.phase, -before, query.w));
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
  if (is_probe(scene.camera)) return probe_normal(scene.camera, point_of(vertex));
  const CameraTraits camera = traits(scene.camera);
  if (!camera.axis) return std::nullopt;
  return Imath::V3f(direction_at(scene.camera, *camera.axis, vertex.time));
}

PathSegment segment_between(const PathVertex& a, const PathVertex& b) {
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

SampledSpectrum eval_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                             TransportMode mode) {
  return std::visit([&](const auto& at) { return value_towards(at, {scene, vertex, w}, mode); }, vertex.at);
}

Polarisation polarisation_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                                  TransportMode mode) {
  if (const auto* light = std::get_if<LightVertex>(&vertex.at))
    return emitted_polarisation(scene.lights[light->light], w);
  const CarriedPolarisation& carried = vertex.packet.polarisation;
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at))
    return carried->through(surface->mueller(surface->frame.to_local(w), false),
                            light_travels(-surface->frame.to_world(surface->wo), mode), mode);
  if (const auto* medium = std::get_if<MediumVertex>(&vertex.at))
    return carried->through(mueller(medium->phase, medium->from, w), light_travels(medium->from, mode), mode);
  const auto camera = camera_density(std::get<CameraVertex>(vertex.at), {scene, vertex, w});
  return polarisation_of_film(scene, -w, vertex.time, camera ? images_of(*camera) : nullptr);
}

SampledSpectrum direction_pdf(const Scene& scene, const PathVertex& vertex, const Imath::V3f& before,
                              const Imath::V3f& w) {
  return std::visit([&](const auto& at) { return pdf_towards(at, {scene, vertex, w}, before); }, vertex.at);
}

float solid_angle_per_area(const Scene& scene, const PathVertex& from, const PathVertex& to) {
  if (to.at_infinity()) return 1;
  const PathSegment segment = segment_between(from, to);
  const std::optional<Imath::V3f> normal = normal_of(scene, to);
  const double cosine = normal ? std::abs(static_cast<double>(normal->dot(segment.direction))) : 1;
  return static_cast<float>(from.at_infinity() ? cosine : cosine / (segment.distance * segment.distance));
}

}  // namespace abbe
