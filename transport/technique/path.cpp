#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>

#include "scene/polarisation_need.h"
#include "transport/path/polarised_ends.h"

namespace abbe {
namespace {

// Response of a meter to a direction of the world, on the side of its normal however grazing it is. Unlike
// that of a scattering surface, the plane of a meter is exact, and the sine of a grazing angle keeps its
// digits if the light is distant.
SurfaceVertex::Departure towards_from_meter(const SurfaceVertex& meter, const Imath::V3f& world) {
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
      narrow_(camera_.meter_acceptance && *camera_.meter_acceptance < 1),
      walks_(plan.scene, caster),
      ghosts_(plan, caster) {}

// The estimate of a pixel's film value is, over its paths x_0 x_1 ... from the film,
//     sum_n w_n [T_n / P_n] L_e(x_n -> x_{n-1}) + sum_n w'_n [T_n / P_n] f cos L_e / p_light,
// T_n being the throughput up to x_n and P_n its density: light met by scattering, and light connected to,
// each weighed by `LightWeights` over both ways and all lanes. The sums over n are kept in `found`, one value
// per lane, and exposed at the end of a path at once. Where a path goes on in s parts, by s independent
// directions from one vertex, each has 1/s of the throughput, and what they find is found by the path.
void PathTracer::trace(std::span<const PixelSample> samples, const Deposit& deposit) {
  deposit_ = &deposit;
  for (first_ = 0; first_ < samples.size(); first_ += kPathsTogether)
    trace_together(samples.subspan(first_, std::min<std::size_t>(kPathsTogether, samples.size() - first_)));
}

void PathTracer::trace_together(std::span<const PixelSample> samples) {
  walks_.paths().clear();
  if (measures_polarisation_) found_.assign(samples.size(), {});
  start(samples);
  resolve_connections();
  walks_.run(*this);
  for (const CameraPath& path : std::span(walks_.paths()).first(samples.size())) expose(path);
}

// Whether photons, or connections of the lens, bring what a light that the path has met sends along it.
bool PathTracer::owned_by_others(const CameraPath& path, std::uint32_t light) const {
  if (path.events == 0) return path.route > 0;
  return path.events > 0 && path.connected == 0 && !path.owns_caustics && plan_.traced[light];
}

// With which a connection from its last vertex would have drawn the path's ray to the light.
float PathTracer::connection_pdf(const CameraPath& path, const LightVertex& met) const {
  if (path.connected == 0) return 0;
  return plan_.path_lights.probability(met.light, path.last) *
         light_pdf(scene_.lights[met.light], scene_.shapes, {path.ray.origin, path.last.side},
                   path.ray.direction, met.point, met.normal, path.ray.time);
}

void PathTracer::escape(CameraPath& path) {
  find_background(scene_, path, [&](const LightVertex& light) { add_met(path, light); });
}

void PathTracer::meet(CameraPath& path, const SurfaceHit& hit) {
  if (const auto light = light_met(scene_, hit, path.ray.direction)) add_met(path, *light);
}

// Light that the path has come to by itself.
void PathTracer::add_met(CameraPath& path, const LightVertex& met) {
  const std::uint32_t light = met.light;
  if (owned_by_others(path, light) || (path.seeks_caustic && path.connected > 0)) return;
  const float pdf = connection_pdf(path, met);
  const Imath::V3f& towards = path.ray.direction;
  const SampledSpectrum contribution = path.packet.throughput *
                                       emission_from(scene_.lights[light], towards, path.lambda_nm()) *
                                       weights_.of_met(pdf_with_guide(path), pdf, path.connected);
  add(path, {light, path.events}, contribution, path.at.cos_film,
      pointer_to(seen_of(scene_.lights[light], path.packet, towards)));
}

PathTracer::ChosenLight PathTracer::choose_light(const LightSampleContext& place,
                                                 const std::array<float, 4>& u, float time) const {
  const PowerLightSampler::SampledLight pick = plan_.path_lights.pick(place, u[0]);
  const Light& light = scene_.lights[pick.light];
  ChosenLight chosen{pick.light, light, sample_light(light, scene_.shapes, place, {u[1], u[2]}, time),
                     pick.probability};
  if (chosen.towards) chosen.pdf *= chosen.towards->pdf;
  return chosen;
}

void PathTracer::connect(CameraPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  if (!connects() || path.seeks_caustic) return;
  const ChosenLight chosen = choose_light(vertex.place(), u, path.ray.time);
  if (!chosen.towards) return;
  const Imath::V3f& world = chosen.towards->wi;
  const auto [wi, f, crosses] =
      path.events == kMeterEvent ? towards_from_meter(vertex, world) : vertex.towards(world, kMode);
  if (f.is_zero()) return;
  SampledSpectrum contribution =
      f * (path.packet.throughput * emission_from(chosen.light, world, path.lambda_nm()) *
           (std::abs(wi.z) * chosen.towards->factor));
  std::optional<StokesSpectrum> seen;
  if (path.packet.polarisation) seen = measured(path, vertex.mueller(wi, false), chosen.light, world);
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : unguided_pdf(vertex, wi);
  if (path.events == kMeterEvent && !accepted(world, vertex.hit.normal, contribution, scattering_pdf)) return;
  const Ray ray = vertex.leave(world, path.ray.time);
  const float cos_film = path.events == kMeterEvent ? wi.z : path.at.cos_film;
  if (walks_.has_free_paths()) {
    Surroundings around = path.around;
    if (crosses) around.enter(scene_, vertex.behind(scene_, around.inside), path.lambda_nm());
    connect_through_matter(path, chosen, contribution, scattering_pdf, ray, around, cos_film, seen);
    return;
  }
  const float weight =
      weights_.of_connection(path.packet.lane_pdf * scattering_pdf, chosen.pdf, path.packet.lane_pdf.sum());
  if (!std::isfinite(weight)) return;
  if (crosses)
    medium_at(scene_, vertex.behind(scene_, path.around.inside), path.lambda_nm())
        .attenuate(contribution, chosen.towards->distance);
  else
    path.around.medium.attenuate(contribution, chosen.towards->distance);
  connections_.push_back({path.path, {chosen.index, path.events + 1}, contribution * weight, cos_film});
  if (seen) seen_.push_back(*seen);
  ways_.push_back(way_to(ray, *chosen.towards));
}

bool PathTracer::follows(CameraPath& path, const BsdfSample& event) const {
  if (path.events == 0) path.owns_caustics = event.delta != camera_.meter_acceptance.has_value();
  return event.delta || !path.seeks_caustic;
}

float PathTracer::kept(CameraPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const {
  path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
  return path.going_on * roulette_throughput(path);
}

void PathTracer::resolve_connections() {
  blocked_.resize(ways_.size());
  caster_.occluded(ways_, blocked_);
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (blocked_[i] != 0 || (!through_.empty() && !pass_matter(connections_[i], through_[i]))) continue;
    const Connection& connection = connections_[i];
    add(walks_.paths()[connection.path], connection.of, connection.contribution, connection.cos_film,
        seen_.empty() ? nullptr : &seen_[i]);
  }
  connections_.clear();
  seen_.clear();
  through_.clear();
  ways_.clear();
}

}  // namespace abbe
