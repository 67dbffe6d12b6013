#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>

#include "scene/scene_features.h"
#include "transport/path/polarised_ends.h"

namespace abbe {
namespace {

// BSDF of a probe in a world direction, on the side of its normal at any grazing angle. Unlike a scattering
// surface, a probe's plane is exact: the sine of a grazing angle has full precision for a distant light.
SurfaceVertex::OutgoingDirection eval_from_probe(const SurfaceVertex& meter, const Imath::V3f& world) {
  const Imath::V3f wi = meter.frame.to_local(world);
  return {wi, meter.f(world, wi, TransportMode::radiance), wi.z < 0};
}

}  // namespace

PathTracer::PathTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      camera_(traits(plan.scene.camera)),
      caster_(caster),
      response_(film_response_of(plan.scene)),
      directions_(plan.scene.render.sampling.directions),
      weights_(plan.scene.render.sampling),
      carries_polarisation_(carries_polarisation(plan.scene)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      restricts_acceptance_(camera_.probe_acceptance && *camera_.probe_acceptance < 1),
      batch_(plan.scene, caster),
      ghosts_(plan, caster) {}

// The estimate of a film value is a sum over paths x_0 x_1 ... from the film of
//     sum_n w_n [T_n / P_n] L_e(x_n -> x_{n-1}) + sum_n w'_n [T_n / P_n] f cos L_e / p_light.
// T_n is the throughput up to x_n and P_n its pdf. The first sum has the emitter hits, the second next-event
// estimation. `LightWeights` weights both over techniques and wavelengths. The sums over n are stored per
// wavelength in `radiance` and exposed once per path. If a path splits into s independent directions, each
// child has 1/s of the throughput and adds to the same path's sum.
void PathTracer::trace(std::span<const PixelSample> samples, const Deposit& deposit) {
  deposit_ = &deposit;
  for (first_ = 0; first_ < samples.size(); first_ += kBatchSize)
    trace_batch(samples.subspan(first_, std::min<std::size_t>(kBatchSize, samples.size() - first_)));
}

void PathTracer::trace_batch(std::span<const PixelSample> samples) {
  batch_.paths().clear();
  if (measures_polarisation_) stokes_.assign(samples.size(), {});
  start(samples);
  resolve_connections();
  batch_.run(*this);
  for (const CameraPath& path : std::span(batch_.paths()).first(samples.size())) expose(path);
}

// True if photons or `GhostLights` own the emission that the path hit.
bool PathTracer::is_owned_by_other(const CameraPath& path, std::uint32_t light) const {
  if (path.depth == 0) return path.route > 0;
  return path.depth > 0 && path.nee_path_pdf == 0 && !path.owns_caustics && plan_.traced[light];
}

// Pdf with which next-event estimation at the last vertex would have sampled the path's ray to the light.
float PathTracer::nee_pdf(const CameraPath& path, const LightVertex& emitter_hit) const {
  if (path.nee_path_pdf == 0) return 0;
  return plan_.path_lights.probability(emitter_hit.light, path.prev_context) *
         light_pdf(scene_.lights[emitter_hit.light], scene_.shapes, {path.ray.origin, path.prev_context.side},
                   path.ray.direction, emitter_hit.point, emitter_hit.normal, path.ray.time);
}

void PathTracer::on_escape(CameraPath& path) {
  visit_escaped_lights(scene_, path, [&](const LightVertex& light) { add_emission(path, light); });
}

void PathTracer::on_hit(CameraPath& path, const SurfaceHit& hit) {
  if (const auto light = emitter_hit(scene_, hit, path.ray.direction)) add_emission(path, *light);
}

// Adds an emitter hit.
void PathTracer::add_emission(CameraPath& path, const LightVertex& emitter_hit) {
  const std::uint32_t light = emitter_hit.light;
  if (is_owned_by_other(path, light) || (path.seeks_caustic && path.nee_path_pdf > 0)) return;
  const float pdf = nee_pdf(path, emitter_hit);
  const Imath::V3f& towards = path.ray.direction;
  const SampledSpectrum contribution = path.packet.throughput *
                                       emission_from(scene_.lights[light], towards, path.lambda_nm()) *
                                       weights_.emission_weight(pdf_with_guide(path), pdf, path.nee_path_pdf);
  add(path, {light, path.depth}, contribution, path.at.cos_film,
      pointer_to(measured_emission(scene_.lights[light], path.packet, towards)));
}

PathTracer::ChosenLight PathTracer::choose_light(const LightSampleContext& context,
                                                 const std::array<float, 4>& u, float time) const {
  const PowerLightSampler::SampledLight pick = plan_.path_lights.pick(context, u[0]);
  const Light& light = scene_.lights[pick.light];
  ChosenLight chosen{pick.light, light, sample_light(light, scene_.shapes, context, {u[1], u[2]}, time),
                     pick.probability};
  if (chosen.towards) chosen.pdf *= chosen.towards->pdf;
  return chosen;
}

// Queues next-event estimation: w T f |cos| L_e factor with the MIS weight w, which includes 1/pdf. With free
// paths the weight follows after the shadow ray.
void PathTracer::connect(CameraPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  if (!connects() || path.seeks_caustic) return;
  const ChosenLight chosen = choose_light(vertex.light_context(), u, path.ray.time);
  if (!chosen.towards) return;
  const Imath::V3f& world = chosen.towards->wi;
  const auto [wi, f, crosses] =
      path.depth == kProbeDepth ? eval_from_probe(vertex, world) : vertex.eval_towards(world, kMode);
  if (f.is_zero()) return;
  SampledSpectrum contribution =
      f * (path.packet.throughput * emission_from(chosen.light, world, path.lambda_nm()) *
           (std::abs(wi.z) * chosen.towards->factor));
  std::optional<StokesSpectrum> measured;
  if (path.packet.polarisation) measured = measure(path, vertex.mueller(wi, false), chosen.light, world);
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : unguided_pdf(vertex, wi);
  if (path.depth == kProbeDepth && !apply_acceptance(world, vertex.hit.normal, contribution, scattering_pdf))
    return;
  const Ray ray = vertex.spawn_ray(world, path.ray.time);
  const float cos_film = path.depth == kProbeDepth ? wi.z : path.at.cos_film;
  if (batch_.has_free_paths()) {
    MediumState media = path.media;
    if (crosses) media.enter(scene_, vertex.media_behind(scene_, media.stack), path.lambda_nm());
    connect_through_media(path, chosen, contribution, scattering_pdf, ray, media, cos_film, measured);
    return;
  }
  const float weight = weights_.connection_weight(path.packet.lane_pdf * scattering_pdf, chosen.pdf,
                                                  path.packet.lane_pdf.sum());
  if (!std::isfinite(weight)) return;
  if (crosses)
    medium_at(scene_, vertex.media_behind(scene_, path.media.stack), path.lambda_nm())
        .attenuate(contribution, chosen.towards->distance);
  else
    path.media.medium.attenuate(contribution, chosen.towards->distance);
  connections_.push_back({path.index, {chosen.index, path.depth + 1}, contribution * weight, cos_film});
  if (measured) measured_stokes_.push_back(*measured);
  shadow_rays_.push_back(shadow_ray(ray, *chosen.towards));
}

bool PathTracer::continues_after(CameraPath& path, const BsdfSample& event) const {
  if (path.depth == 0) path.owns_caustics = event.delta != camera_.probe_acceptance.has_value();
  return event.delta || !path.seeks_caustic;
}

float PathTracer::survival_weight(CameraPath& path, const SurfaceVertex& vertex,
                                  const BsdfSample& event) const {
  path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
  return path.rr_scale * roulette_throughput(path);
}

// Traces the queued shadow rays and adds the unoccluded connections.
void PathTracer::resolve_connections() {
  occluded_.resize(shadow_rays_.size());
  caster_.occluded(shadow_rays_, occluded_);
  for (std::size_t i = 0; i < shadow_rays_.size(); ++i) {
    if (occluded_[i] != 0 ||
        (!through_media_.empty() && !apply_transmittance(connections_[i], through_media_[i])))
      continue;
    const Connection& connection = connections_[i];
    add(batch_.paths()[connection.path], connection.info, connection.contribution, connection.cos_film,
        measured_stokes_.empty() ? nullptr : &measured_stokes_[i]);
  }
  connections_.clear();
  measured_stokes_.clear();
  through_media_.clear();
  shadow_rays_.clear();
}

}  // namespace abbe
