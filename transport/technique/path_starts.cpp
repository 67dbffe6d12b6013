#include "transport/technique/path_starts.h"

#include <array>
#include <cmath>
#include <numbers>

#include "scene/lights/light.h"
#include "scene/scene_features.h"
#include "scene/shapes/ray.h"
#include "scene/working_range.h"
#include "transport/path/dimensions.h"
#include "transport/path/polarised_paths.h"

namespace abbe {
namespace {

// Ball around the scene's nearby shapes, through which light from infinity is sent.
struct SceneBall {
  Imath::V3f center;
  float radius;
};
SceneBall ball_around(const Scene& scene) {
  const Imath::V3d center = scene.bounds.isEmpty() ? Imath::V3d(0) : scene.bounds.center();
  return {Imath::V3f(center), static_cast<float>(scene_radius(scene.bounds))};
}

// First vertex of a light subpath, its ray and their pdfs.
struct EmittedRay {
  LightVertex from;
  Ray ray;
  EmissionDensity density;
};

EmittedRay emit_from_nearby(const Light& light, std::uint32_t index, const Scene& scene,
                            const std::array<float, 4>& direction_random, const std::array<float, 4>& start,
                            float time) {
  const EmissionPoint from = sample_emission_point(light, scene.shapes, {start[0], start[1]}, time);
  const Imath::V3f wo =
      emission_direction(light, from.normal, {direction_random[0], direction_random[1]}, time);
  const Ray ray = surface_of(light) ? spawn(from.point, from.normal, wo, time) : ray_at(from.point, wo, time);
  return {{index, from.point, from.normal}, ray, emission_density(light, from.normal, wo, 1, time)};
}

// Uniform over the ball's disc as the light views it.
std::optional<EmittedRay> emit_from_infinity(const Light& light, std::uint32_t index, const Scene& scene,
                                             RayCaster& caster, const std::array<float, 4>& direction_random,
                                             const std::array<float, 4>& start, float time) {
  const LightSample from = *sample_light(light, scene.shapes, {}, {start[0], start[1]}, time);
  const SceneBall ball = ball_around(scene);
  const Basis<float> across(from.wi);
  const float phi = 2 * std::numbers::pi_v<float> * direction_random[1];
  const float r = ball.radius * std::sqrt(direction_random[0]);
  const Imath::V3f origin =
      ball.center + across.to_world({r * std::cos(phi), r * std::sin(phi), 2 * ball.radius});
  if (caster.occluded(shadow_ray_along(ray_at(origin, from.wi, time)))) return std::nullopt;
  return EmittedRay{{index, from.wi, Imath::V3f(0), true},
                    ray_at(origin, -from.wi, time),
                    emission_density(light, Imath::V3f(0), -from.wi, ball.radius, time)};
}

// Context for light sampling at a vertex.
LightSampleContext light_context_of(const Scene& scene, const PathVertex& vertex) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->light_context();
  LightSampleContext context{point_of(vertex), std::nullopt};
  if (std::holds_alternative<CameraVertex>(vertex.at)) context.side = normal_of(scene, vertex);
  return context;
}

// Adds the first vertex of a path whose packet, ray and media are set.
PathVertex& first_vertex(RecordedPath& path) {
  constexpr std::size_t kUsually = 8;
  path.vertices.reserve(kUsually);
  PathVertex& vertex = path.vertices.emplace_back();
  vertex.packet = path.packet;
  vertex.media_front = vertex.media_behind = path.media.stack;
  vertex.time = path.ray.time;
  return vertex;
}

// Initial ray of a photon; its power is the light's emission times `factor`, which is 0 if no light is
// emitted.
struct PhotonRay {
  Ray ray;
  float factor = 0;
};

// Random numbers in [0, 1) for the start of a photon.
struct PhotonRandom {
  Imath::V2f guide;  // direction, or point of the target
  Imath::V2f start;  // point of the light, or direction of a sun
  float choice;      // selects guide or emission
  float time;        // fraction of the exposure
};

// Photon of a nearby light, in a direction of its guide: L_e f / (q p_area p_direction), f being the
// `emission_factor` and q the probability of the light.
PhotonRay start_near(const Plan& plan, const PowerLightSampler::SampledLight& pick, const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const GuidedDirection guided =
      plan.guides.photon_guides[pick.light].sample(light, from, u.choice, u.guide, u.time);
  const float factor = emission_factor(light, from.normal, guided.wi, u.time);
  if (!(factor > 0)) return {};
  return {surface_of(light) ? spawn(from.point, from.normal, guided.wi, u.time)
                            : ray_at(from.point, guided.wi, u.time),
          factor / (pick.probability * from.pdf_area * guided.pdf)};
}

// Ray through a point of the target, from outside the target's sphere.
Ray ray_through_target(const PhotonGuide& guide, const GuidedPoint& at, const Imath::V3f& direction,
                       float time) {
  return ray_at(at.point - direction * (2 * guide.half_size()), direction, time);
}

// Photon of a distant light, through a point of the target at the distance d: L_e f |cos_target| / (q p_light
// p_target d^2), f being the `emission_factor`.
PhotonRay start_distant(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                        const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const PhotonGuide& guide = plan.guides.photon_guides[pick.light];
  const EmissionPoint from = sample_emission_point(light, plan.scene.shapes, u.start, u.time);
  const GuidedPoint at = guide.point(u.guide);
  const Imath::V3d to_target = Imath::V3d(at.point) - Imath::V3d(from.point);
  const double distance = to_target.length();
  const Imath::V3f wi(to_target * (1 / distance));
  const Ray ray = ray_through_target(guide, at, wi, u.time);
  const float factor = emission_factor(light, from.normal, wi, u.time);
  if (!(factor > 0)) return {ray};
  if (caster.occluded(shadow_ray_between(
          ray.origin, surface_of(light) ? offset_point(from.point, from.normal, wi) : from.point, u.time)))
    return {ray};
  const float cosines = factor * std::abs(guide.axis().dot(wi));
  const double density = static_cast<double>(pick.probability * from.pdf_area) * static_cast<double>(at.pdf) *
                         distance * distance;
  return {ray, static_cast<float>(static_cast<double>(cosines) / density)};
}

// Photon of a light at infinity, through a point of the target: L_e |cos_target| / (q p_target p_direction).
PhotonRay start_at_infinity(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                            const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  const PhotonGuide& guide = plan.guides.photon_guides[pick.light];
  const LightSample from = *sample_light(light, plan.scene.shapes, {}, u.start, u.time);
  const GuidedPoint at = guide.point(u.guide);
  const Ray ray = ray_through_target(guide, at, -from.wi, u.time);
  if (caster.occluded(shadow_ray_along(ray_at(ray.origin, from.wi, u.time)))) return {ray};
  const float cosine = std::abs(guide.axis().dot(from.wi));
  return {ray, cosine / (pick.probability * at.pdf * from.pdf)};
}

PhotonRay start_ray(const Plan& plan, RayCaster& caster, const PowerLightSampler::SampledLight& pick,
                    const PhotonRandom& u) {
  const Light& light = plan.scene.lights[pick.light];
  if (light.at_infinity()) return start_at_infinity(plan, caster, pick, u);
  return plan.scene.is_distant(light) ? start_distant(plan, caster, pick, u) : start_near(plan, pick, u);
}

}  // namespace

FilmPoint start_from_camera(const Plan& plan, int x, int y, float time, RecordedPath& path,
                            WavelengthImages& images) {
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
  enter_camera_media(plan, path);
  const std::optional<CameraDensity> camera_density =
      start.weight.is_zero() ? std::nullopt : density(scene.camera, start.ray, path.lambda_nm(), start.route);
  if (camera_density) {
    PathVertex& lens_point = first_vertex(path);
    lens_point.at = CameraVertex{start.ray.origin, start.route};
    lens_point.packet.throughput *= 1 / camera_density->pdf_position;
    lens_point.pdf_forward = SampledSpectrum(camera_density->pdf_position);
    path.direction_pdf = camera_density->pdf_direction;
  }
  advance(path.packet, start.weight, start.lane_pdf);
  path.initial_throughput = path.packet.throughput_estimate();
  if (start.images) images = *start.images;
  return {x, y, start.cos_film, start.ray.time, start.images ? &images : nullptr};
}

// The throughput is L_e |cos| / (p_point p_ray). p_point includes the probability of the light. For a light
// at infinity it is the pdf of the direction, and p_ray that of the ray's position.
void start_from_light(const Plan& plan, RayCaster& caster, float time, RecordedPath& path) {
  if (plan.traced_lights.empty()) return;
  const Scene& scene = plan.scene;
  const std::array<float, 4> direction_random = path.sampler.group(kPhotonGuideGroup);
  const std::array<float, 4> start = path.sampler.group(kEmissionGroup);
  const PowerLightSampler::SampledLight pick = plan.traced_lights.pick(start[3]);
  const Light& light = scene.lights[pick.light];
  const std::optional<EmittedRay> emitted =
      light.at_infinity()
          ? emit_from_infinity(light, pick.light, scene, caster, direction_random, start, time)
          : emit_from_nearby(light, pick.light, scene, direction_random, start, time);
  if (!emitted || !(emitted->density.pdf_direction > 0)) return;
  const float pdf_point = pick.probability * (light.at_infinity() ? emitted->density.pdf_direction
                                                                  : emitted->density.pdf_position);
  const float pdf_ray = light.at_infinity() ? emitted->density.pdf_position : emitted->density.pdf_direction;
  path.ray = emitted->ray;
  if (carries_polarisation(scene)) path.packet.polarisation = emitted_polarisation(light, path.ray.direction);
  enter_light_media(plan, pick.light, path);

  PathVertex& origin = first_vertex(path);
  origin.at = emitted->from;
  origin.packet.throughput *= 1 / pdf_point;
  origin.pdf_forward = SampledSpectrum(pdf_point);
  path.direction_pdf = SampledSpectrum(pdf_ray);
  path.packet.throughput *=
      eval_towards(scene, origin, path.ray.direction, TransportMode::power) * (1 / (pdf_point * pdf_ray));
  path.initial_throughput = path.packet.throughput_estimate();
  if (path.packet.throughput.is_zero()) path.vertices.clear();
}

std::optional<PathVertex> sample_light_vertex(const Plan& plan, const PathVertex& vertex,
                                              const std::array<float, 4>& u) {
  if (plan.path_lights.empty()) return std::nullopt;
  const Scene& scene = plan.scene;
  const LightSampleContext context = light_context_of(scene, vertex);
  const LightSampler::Pick pick = plan.path_lights.pick(context, u[0]);
  const Light& light = scene.lights[pick.light];
  const std::optional<LightSample> to = sample_light(light, scene.shapes, context, {u[1], u[2]}, vertex.time);
  if (!to) return std::nullopt;
  const bool at_infinity = light.at_infinity();
  // The vertex is the surface point itself, from which directions and distances are measured, not the offset
  // end of the shadow ray. `connect` offsets both ends.
  const Imath::V3f point = at_infinity ? to->wi : offset_point(to->end, to->normal, to->wi);
  std::optional<PathVertex> light_vertex(std::in_place);
  light_vertex->at = LightVertex{pick.light, point, to->normal, at_infinity};
  light_vertex->packet.wavelengths = vertex.packet.wavelengths;
  light_vertex->packet.hero = vertex.packet.hero;
  light_vertex->time = vertex.time;
  const float per_area = light.is_delta() ? 1 : solid_angle_per_area(scene, vertex, *light_vertex);
  const float pdf = pick.probability * to->pdf * per_area;
  light_vertex->packet.throughput = SampledSpectrum(1 / pdf);
  light_vertex->pdf_forward = SampledSpectrum(pdf);
  return light_vertex;
}

EndDensities end_densities(const Plan& plan, const PathVertex& illuminated, const PathVertex& light) {
  const Scene& scene = plan.scene;
  const auto& at = std::get<LightVertex>(light.at);
  const Light& emitter = scene.lights[at.light];
  EndDensities ends;
  const PathSegment segment = segment_between(light, illuminated);
  if (!plan.traced_lights.empty()) {
    const SceneBall ball = ball_around(scene);
    const EmissionDensity density =
        emission_density(emitter, at.normal, segment.direction, ball.radius, illuminated.time);
    const float probability = plan.traced_lights.probability(at.light);
    const bool within = (point_of(illuminated) - ball.center).length2() <= ball.radius * ball.radius;
    ends.light_start = probability * (at.at_infinity ? density.pdf_direction : density.pdf_position);
    ends.emission = at.at_infinity ? (within ? density.pdf_position : 0) : density.pdf_direction;
  }
  const LightSampleContext context = light_context_of(scene, illuminated);
  if (!plan.path_lights.empty()) {
    const float probability = plan.path_lights.probability(at.light, context);
    ends.light_connection = emitter.is_delta()
                                ? probability
                                : probability *
                                      light_pdf(emitter, scene.shapes, context, -segment.direction, at.point,
                                                at.normal, illuminated.time) *
                                      solid_angle_per_area(scene, illuminated, light);
  }
  return ends;
}

void enter_camera_media(const Plan& plan, PathState& path) {
  if (plan.camera_media_vary)
    path.media.enter(plan.scene, enclosing_media(plan.scene, path.ray.origin, path.ray.time),
                     path.lambda_nm());
  else if (!plan.camera_media.empty())
    path.media.enter(plan.scene, plan.camera_media, path.lambda_nm());
}

MediumStack camera_media(const Plan& plan, const Imath::V3f& lens_point, float time) {
  return plan.camera_media_vary ? enclosing_media(plan.scene, lens_point, time) : plan.camera_media;
}

void enter_light_media(const Plan& plan, std::uint32_t light, PathState& path) {
  if (!plan.light_media_vary.empty() && plan.light_media_vary[light])
    path.media.enter(plan.scene, enclosing_media(plan.scene, path.ray.origin, path.ray.time),
                     path.lambda_nm());
  else if (const MediumStack& stack = plan.light_media[light]; !stack.empty())
    path.media.enter(plan.scene, stack, path.lambda_nm());
}

PhotonStart start_photon(const Plan& plan, RayCaster& caster, PathState& photon) {
  const std::array<float, 4> a = photon.sampler.group(kPhotonGuideGroup);
  const std::array<float, 4> b = photon.sampler.group(kEmissionGroup);
  const PowerLightSampler::SampledLight pick = plan.traced_lights.pick(b[3]);
  const PhotonRay start = start_ray(plan, caster, pick, {{a[0], a[1]}, {b[0], b[1]}, b[2], a[kTimeIndex]});
  PhotonStart result{pick.light, start.ray.origin, start.ray.direction};
  if (!(start.factor > 0)) {
    photon.packet.throughput = SampledSpectrum();
    return result;
  }
  photon.packet = draw_packet(plan.guides.photon_wavelengths, a[2]);
  if (carries_polarisation(plan.scene))
    photon.packet.polarisation = emitted_polarisation(plan.scene.lights[pick.light], start.ray.direction);
  photon.packet.throughput = plan.scene.lights[pick.light].emission(photon.lambda_nm()) * start.factor;
  photon.ray = start.ray;
  enter_light_media(plan, pick.light, photon);
  return result;
}

}  // namespace abbe
