#include "transport/technique/subpaths.h"

#include <cmath>

#include "scene/extent.h"
#include "scene/lights/emission.h"
#include "scene/polarisation_need.h"
#include "scene/shapes/basis.h"
#include "transport/path/dimensions.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_matter.h"

namespace abbe {
namespace {

// A ball around what is near, which light from infinity is sent through.
struct Ball {
  Imath::V3f center;
  float radius;
};
Ball ball_around(const Scene& scene) {
  const Imath::V3d center = scene.bounds.isEmpty() ? Imath::V3d(0) : scene.bounds.center();
  return {Imath::V3f(center), static_cast<float>(scene_radius(scene.bounds))};
}

// The first vertex of a path from a light, and its ray.
struct Departure {
  LightVertex from;
  Ray ray;
  EmissionDensity density;
};

Departure leave_near(const Light& light, std::uint32_t index, const Scene& scene,
                     const std::array<float, 4>& aim, const std::array<float, 4>& start, float time) {
  const EmissionPoint from = sample_emission_point(light, scene.shapes, {start[0], start[1]}, time);
  const Imath::V3f wo = emission_direction(light, from.normal, {aim[0], aim[1]}, time);
  const Ray ray =
      light.is<AreaLight>() ? spawn(from.point, from.normal, wo, time) : ray_at(from.point, wo, time);
  return {{index, from.point, from.normal}, ray, emission_density(light, from.normal, wo, 1, time)};
}

// Uniformly over the disc that the ball shows it.
std::optional<Departure> leave_infinity(const Light& light, std::uint32_t index, const Scene& scene,
                                        RayCaster& caster, const std::array<float, 4>& aim,
                                        const std::array<float, 4>& start, float time) {
  const LightSample from = *sample_light(light, scene.shapes, {}, {start[0], start[1]}, time);
  const Ball ball = ball_around(scene);
  const Basis<float> across(from.wi);
  const float phi = 2 * std::numbers::pi_v<float> * aim[1];
  const float r = ball.radius * std::sqrt(aim[0]);
  const Imath::V3f origin =
      ball.center + across.to_world({r * std::cos(phi), r * std::sin(phi), 2 * ball.radius});
  if (caster.occluded(way_along(ray_at(origin, from.wi, time)))) return std::nullopt;
  return Departure{{index, from.wi, Imath::V3f(0), true},
                   ray_at(origin, -from.wi, time),
                   emission_density(light, Imath::V3f(0), -from.wi, ball.radius, time)};
}

// Where light arrives at a vertex, to be chosen for it.
LightSampleContext place_of(const Scene& scene, const PathVertex& vertex) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->place();
  LightSampleContext place{point_of(vertex), std::nullopt};
  if (std::holds_alternative<CameraVertex>(vertex.at)) place.side = normal_of(scene, vertex);
  return place;
}

// Of a path that has its packet, ray and surroundings.
PathVertex& first_vertex(RecordedPath& path) {
  constexpr std::size_t kUsually = 8;
  path.vertices.reserve(kUsually);
  PathVertex& vertex = path.vertices.emplace_back();
  vertex.packet = path.packet;
  vertex.inside = vertex.beyond = path.around.inside;
  vertex.time = path.ray.time;
  return vertex;
}

}  // namespace

FilmPoint start_from_camera(const Plan& plan, int x, int y, float time, RecordedPath& path,
                            LaneImages& images) {
  const Scene& scene = plan.scene;
  const std::array<float, 4> film = path.sampler.group(kFilmGroup);
  const std::array<float, 4> lens = path.sampler.group(kLensGroup);
  const CameraRay start =
      sample_ray(scene.camera, {static_cast<float>(x) + film[0], static_cast<float>(y) + film[1]},
                 {lens[0], lens[1]}, path.lambda_nm(), path.packet.hero, time);
  path.ray = start.ray;
  if (carries_polarisation(scene))
    path.packet.polarisation = polarisation_of_film(
        scene, light_travels(path.ray.direction, TransportMode::radiance), time, images_of(start));
  enter_camera_matter(plan, path);
  const std::optional<CameraDensity> of =
      start.weight.is_zero() ? std::nullopt : density(scene.camera, start.ray, path.lambda_nm(), start.route);
  if (of) {
    PathVertex& lens_point = first_vertex(path);
    lens_point.at = CameraVertex{start.ray.origin, start.route};
    lens_point.packet.throughput *= 1 / of->pdf_position;
    lens_point.pdf_forward = SampledSpectrum(of->pdf_position);
    path.direction_pdf = of->pdf_direction;
  }
  advance(path.packet, start.weight, start.lane_pdf);
  path.carried_at_start = path.packet.carried();
  if (start.images) images = *start.images;
  return {x, y, start.cos_film, start.ray.time, start.images ? &images : nullptr};
}

void start_from_light(const Plan& plan, RayCaster& caster, float time, RecordedPath& path) {
  if (plan.traced_lights.empty()) return;
  const Scene& scene = plan.scene;
  const std::array<float, 4> aim = path.sampler.group(kAimGroup);
  const std::array<float, 4> start = path.sampler.group(kEmissionGroup);
  const PowerLightSampler::SampledLight pick = plan.traced_lights.pick(start[3]);
  const Light& light = scene.lights[pick.light];
  const std::optional<Departure> departure =
      light.at_infinity() ? leave_infinity(light, pick.light, scene, caster, aim, start, time)
                          : leave_near(light, pick.light, scene, aim, start, time);
  if (!departure || !(departure->density.pdf_direction > 0)) return;
  const float pdf_point = pick.probability * (light.at_infinity() ? departure->density.pdf_direction
                                                                  : departure->density.pdf_position);
  const float pdf_way =
      light.at_infinity() ? departure->density.pdf_position : departure->density.pdf_direction;
  path.ray = departure->ray;
  if (carries_polarisation(scene)) path.packet.polarisation = polarisation_of_lamp(light, path.ray.direction);
  enter_light_matter(plan, pick.light, path);

  PathVertex& origin = first_vertex(path);
  origin.at = departure->from;
  origin.packet.throughput *= 1 / pdf_point;
  origin.pdf_forward = SampledSpectrum(pdf_point);
  path.direction_pdf = SampledSpectrum(pdf_way);
  path.packet.throughput *=
      sent_towards(scene, origin, path.ray.direction, TransportMode::power) * (1 / (pdf_point * pdf_way));
  path.carried_at_start = path.packet.carried();
  if (path.packet.throughput.is_zero()) path.vertices.clear();
}

std::optional<PathVertex> light_for(const Plan& plan, const PathVertex& vertex,
                                    const std::array<float, 4>& u) {
  if (plan.path_lights.empty()) return std::nullopt;
  const Scene& scene = plan.scene;
  const LightSampleContext place = place_of(scene, vertex);
  const LightSampler::Pick pick = plan.path_lights.pick(place, u[0]);
  const Light& light = scene.lights[pick.light];
  const std::optional<LightSample> to = sample_light(light, scene.shapes, place, {u[1], u[2]}, vertex.time);
  if (!to) return std::nullopt;
  const bool far = light.at_infinity();
  // The vertex is the point of the surface itself, from which directions and distances are measured, not the
  // end of the shadow ray beside it: `connect` moves both of its ends off their surfaces.
  const Imath::V3f point = far ? to->wi : offset_point(to->end, to->normal, to->wi);
  std::optional<PathVertex> drawn(std::in_place);
  drawn->at = LightVertex{pick.light, point, to->normal, far};
  drawn->packet.wavelengths = vertex.packet.wavelengths;
  drawn->packet.hero = vertex.packet.hero;
  drawn->time = vertex.time;
  const float per_area = light.is_delta() ? 1 : solid_angle_per_area(scene, vertex, *drawn);
  const float pdf = pick.probability * to->pdf * per_area;
  drawn->packet.throughput = SampledSpectrum(1 / pdf);
  drawn->pdf_forward = SampledSpectrum(pdf);
  return drawn;
}

EndDensities end_densities(const Plan& plan, const PathVertex& lit, const PathVertex& light) {
  const Scene& scene = plan.scene;
  const auto& at = std::get<LightVertex>(light.at);
  const Light& emitter = scene.lights[at.light];
  EndDensities ends;
  const Way way = way_from(light, lit);
  if (!plan.traced_lights.empty()) {
    const Ball ball = ball_around(scene);
    const EmissionDensity of = emission_density(emitter, at.normal, way.direction, ball.radius, lit.time);
    const float chosen = plan.traced_lights.probability(at.light);
    const bool within = (point_of(lit) - ball.center).length2() <= ball.radius * ball.radius;
    ends.light_start = chosen * (at.at_infinity ? of.pdf_direction : of.pdf_position);
    ends.emission = at.at_infinity ? (within ? of.pdf_position : 0) : of.pdf_direction;
  }
  const LightSampleContext place = place_of(scene, lit);
  if (!plan.path_lights.empty()) {
    const float chosen = plan.path_lights.probability(at.light, place);
    ends.light_connection = emitter.is_delta() ? chosen
                                               : chosen *
                                                     light_pdf(emitter, scene.shapes, place, -way.direction,
                                                               at.point, at.normal, lit.time) *
                                                     solid_angle_per_area(scene, lit, light);
  }
  return ends;
}

}  // namespace abbe
