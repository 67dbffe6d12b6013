#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "materials/bsdf/warp.h"
#include "scene/scene_features.h"
#include "transport/path/free_path.h"
#include "transport/path/polarised_paths.h"
#include "transport/technique/path_starts.h"

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
  return path.rr_scale * path.roulette_throughput();
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

// Starts of paths at the film, a dispersing lens, or a probe.

// Rays through a lens that disperses wavelengths are traced several at once.
void PathTracer::start(std::span<const PixelSample> samples) {
  if (camera_.displaces_wavelengths) return start_batch(samples);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    CameraPath& path = batch_.paths().emplace_back(samples[i].sampler, i);
    const auto [film, lens, wavelengths_nm, hero, time] = draw_camera_sample(samples[i], path);
    if (start(samples[i], sample_ray(scene_.camera, film, lens, wavelengths_nm, hero, time), path))
      batch_.active().push_back(i);
  }
}

void PathTracer::start_batch(std::span<const PixelSample> samples) {
  std::vector<CameraPath>& paths = batch_.paths();
  camera_samples_.clear();
  rays_.resize(samples.size());
  images_.resize(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    camera_samples_.push_back(draw_camera_sample(samples[i], paths.emplace_back(samples[i].sampler, i)));
  sample_rays(scene_.camera, camera_samples_, rays_);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (start(samples[i], rays_[i], paths[i])) batch_.active().push_back(i);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, paths[i].packet.wavelengths, first_ + i, *deposit_, layer_sink_);
  }
}

CameraSample PathTracer::draw_camera_sample(const PixelSample& sample, CameraPath& path) const {
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens =
      camera_.depth_of_field ? sample.sampler.group(kLensGroup) : std::array<float, 4>{};
  path.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  return {{static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
          {lens[0], lens[1]},
          path.lambda_nm(),
          path.packet.hero,
          scene_.shutter.sample(sample.y, film[kTimeIndex])};
}

bool PathTracer::start(const PixelSample& sample, const CameraRay& ray, CameraPath& path) {
  path.ray = ray.ray;
  path.route = ray.route;
  if (carries_polarisation_)
    path.packet.polarisation =
        polarisation_of_film(scene_, light_travels(path.ray.direction, kMode), ray.ray.time, images_of(ray));
  path.at = {sample.x, sample.y, ray.cos_film, ray.ray.time};
  path.scale = ray.weight * static_cast<float>(scene_.exposure_s * scene_.shutter.mean());
  enter_camera_media(plan_, path);
  if (camera_.displaces_wavelengths && !displace_wavelengths(ray, path)) return false;
  if (!camera_.probe_acceptance) return true;
  const Imath::V3f normal = probe_normal(scene_.camera, path.ray.origin);
  path.depth = kProbeDepth;
  // The camera's ray starts offset from the probe already, and rays that leave a surface are offset again.
  const Imath::V3f point = offset_point(path.ray.origin, normal, -normal);
  const bool active = batch_.scatter_at(*this, path, SurfaceVertex::at_probe(point, normal));
  path.at.cos_film = path.ray.direction.dot(normal);
  return active;
}

// Each wavelength has its own film position. Weights are balanced over the wavelengths' pdfs of the ray and
// its time. Returns false if the shutter is closed for all of them.
[[gnu::noinline]] bool PathTracer::displace_wavelengths(const CameraRay& ray, CameraPath& path) {
  if (ray.weight.is_zero()) return false;
  images_[path.index] = *ray.images;
  path.at.images = &images_[path.index];
  const SampledSpectrum openings = relative_shutter_weights(scene_.shutter, path.at);
  path.scale *= openings;
  path.packet.lane_pdf = ray.lane_pdf * openings;
  path.eta_scale = path.packet.lane_pdf.max();
  return !openings.is_zero();
}

[[gnu::noinline]] BsdfSample PathTracer::sample_probe_direction(const Imath::V2f& u) const {
  const float acceptance = *camera_.probe_acceptance;
  const Imath::V3f wi = cosine_cone(u, acceptance);
  return BsdfSample{.wi = wi, .weight = SampledSpectrum(1.0F), .pdf = wi.z / disc_area(acceptance)};
}

// A probe with an acceptance cone responds like a white surface to light from its hemisphere: the cosine over
// pi sin^2. `sample_probe_direction` samples the cosine, so the pdf is the same.
bool PathTracer::apply_acceptance(const Imath::V3f& direction, const Imath::V3f& normal,
                                  SampledSpectrum& contribution, SampledSpectrum& pdf) const {
  const float acceptance = *camera_.probe_acceptance;
  if (!within_acceptance(acceptance, normal, direction)) return false;
  if (!restricts_acceptance_) return true;
  contribution *= 1 / (acceptance * acceptance);
  if (!pdf.is_zero()) pdf = SampledSpectrum(normal.dot(direction) / disc_area(acceptance));
  return true;
}

// The caustic guide.
//
// A direction w is sampled by two techniques: scattering, with the pdf s(w), and with the probability q a
// second path, whose direction has the guide's pdf g(w). Emitter hits that follow w by specular events alone
// are balanced over both [Veach1997, eq. 9.8], each counted as often as it is sampled:
//     w_s = s / (s + q g),   w_g = q g / (s + q g).
// Scattering alone samples all other light, and the guide does not change it: no weight exceeds that of
// scattering, whatever q is. A one-sample mixture, which replaces scattering with the probability q,
// multiplies weights by up to 1/(1 - q) at each event. In a room of albedo a the second moment of a path, the
// sum over n of (a^2/(1 - q))^n, then diverges for q > 1 - a^2.
//
// q is the guide's probability times the throughput T of the path, at most 1. Light of the paths added at a
// vertex of throughput T has a variance in proportion to T^2/q and a cost in proportion to q. q is therefore
// best in proportion to T, as `kCameraRouletteScale` derives for roulette.

// Photons own light from specular surfaces of traced lights. Exceptions are light that a camera receives
// through specular surfaces, and light that a surface or medium scatters to a probe.
void PathTracer::prepare_scatter(CameraPath& path, const SurfaceVertex& vertex) const {
  path.caustics = {};
  if (path.seeks_caustic || (restricts_acceptance_ && path.depth == kProbeDepth)) return;
  const bool includes_traced = path.owns_caustics || (camera_.probe_acceptance && path.depth == 0);
  const CausticGuide& guide =
      includes_traced ? plan_.guides.caustics_through_specular : plan_.guides.path_caustics;
  if (guide.empty() || !scatters(vertex.bsdf)) return;
  path.caustics = guide.at(vertex.hit.point).scaled(std::min(1.0F, path.roulette_throughput()));
}

std::optional<float> PathTracer::adds_path(const CameraPath& path) const {
  if (path.caustics.empty()) return std::nullopt;
  const float q = path.caustics.probability();
  const float u = path.sampler.group(guide_group(path.depth))[3];
  return u < q ? std::optional(u / q) : std::nullopt;
}

// Roulette uses the throughput that BSDF sampling would have had: the guide's pdf lowers the throughput of a
// path, but not its importance.
std::optional<BsdfSample> PathTracer::scatter_added(CameraPath& path, const SurfaceVertex& vertex) const {
  const std::array<float, 4> u = path.sampler.group(guide_group(path.depth));
  const Imath::V3f& point = vertex.hit.point;
  const Imath::V3f world = path.caustics.sample(point, u[2], {u[0], u[1]});
  const auto [wi, f, crosses] = vertex.eval_towards(world, kMode);
  if (f.is_zero()) return std::nullopt;
  const SampledSpectrum scattering_pdf = unguided_pdf(vertex, wi);
  const SampledSpectrum combined = path.caustics.combined_pdf(scattering_pdf, point, world);
  BsdfSample event;
  event.wi = wi;
  event.transmitted = crosses;
  event.pdf = combined[path.packet.hero];
  if (!(event.pdf > 0)) return std::nullopt;
  event.weight = f * (std::abs(wi.z) / event.pdf);
  event.lane_pdf = combined * (1 / event.pdf);
  path.eta_scale *= combined.max() / scattering_pdf.max();
  if (path.depth == 0) path.owns_caustics = camera_.probe_acceptance.has_value();
  path.seeks_caustic = true;
  path.guided.lobes = {};
  path.spare_u.reset();
  path.sampler = path.sampler.branch(static_cast<std::uint32_t>(path.depth - kProbeDepth));
  if (path.depth == kProbeDepth) path.at.cos_film = wi.z;
  return event;
}

// Pdf of a path up to an emitter hit, per wavelength, relative to that of its throughput. It includes the
// guide's pdf if only specular events follow a vertex where the guide has lobes.
SampledSpectrum PathTracer::pdf_with_guide(const CameraPath& path) const {
  const GuidedScattering& last = path.guided;
  if (path.nee_path_pdf > 0 || last.lobes.empty()) return path.packet.lane_pdf;
  const SampledSpectrum combined = last.lobes.combined_pdf(last.pdf, last.point, last.direction);
  return path.packet.lane_pdf *
         SampledSpectrum::map(combined, last.pdf, [](float combined_pdf, float scattering) {
           return scattering > 0 ? combined_pdf / scattering : 1;
         });
}

// Scattering media: connections from a vertex in a medium, along segments, and through media.

// Pdf with which `connect_equiangular` would have sampled that distance along the segment for the light.
float PathTracer::equiangular_pdf(const MediumSegment& segment, float distance, std::uint32_t light) const {
  const float pick_probability = plan_.equiangular_lights.probability(light);
  if (!(pick_probability > 0)) return 0;
  const auto distribution = Equiangular::along(segment.ray, segment.length, scene_.lights[light]);
  return distribution ? pick_probability * distribution->pdf(distance) : 0;
}

// The contribution at the distance t in a medium with the extinction s_k and scattering s'_k is
//     w sum_j [T_j / P_hero] s'_j e^(-s_j t) f_phase L_e / (q p),
// with the probability q of the light and the pdf p of t. It is balanced with scattering there, of pdf s_k
// e^(-s_k t), followed by next-event estimation.
void PathTracer::connect_equiangular(CameraPath& path, const MediumSegment& segment, const Imath::V2f& u) {
  if (path.seeks_caustic) return;
  const PowerLightSampler::SampledLight pick = plan_.equiangular_lights.pick(u.x);
  const Light& light = scene_.lights[pick.light];
  const auto distribution = Equiangular::along(segment.ray, segment.length, light);
  if (!distribution) return;
  const float t = distribution->sample(u.y);
  const Imath::V3f point = point_along(segment.ray, t, segment.length, segment.end_normal);
  const std::optional<LightSample> towards =
      sample_light(light, scene_.shapes, {point}, {0, 0}, path.ray.time);
  if (!towards) return;
  const MediumAt& medium = path.media.medium;
  SampledSpectrum transmittance(1.0F);
  medium.attenuate(transmittance, t);
  const Imath::V3f& wi = towards->wi;
  SampledSpectrum contribution = path.packet.throughput * transmittance * medium.scattering_per_m *
                                 emission_from(light, wi, path.lambda_nm()) *
                                 (pdf(medium.scattering->phase, segment.ray.direction, wi) * towards->factor);
  std::optional<StokesSpectrum> measured;
  if (path.packet.polarisation)
    measured = measure(path, mueller(medium.scattering->phase, segment.ray.direction, wi), light, wi);
  const float nee_pdf_after_scattering =
      (path.packet.lane_pdf * transmittance * medium.extinction_per_m).sum() / path.packet.lane_pdf.sum() *
      plan_.path_lights.probability(pick.light, {point}) * towards->pdf;
  connect_through_media(
      path, {pick.light, light, towards, pick.probability * distribution->pdf(t) + nee_pdf_after_scattering},
      contribution, SampledSpectrum(0.0F), ray_at(point, wi, path.ray.time), path.media, path.at.cos_film,
      measured);
}

void PathTracer::connect_in_medium(CameraPath& path, const PhaseFunction& phase,
                                   const std::array<float, 4>& u) {
  if (!connects()) return;
  ChosenLight chosen = choose_light({path.ray.origin, std::nullopt}, u, path.ray.time);
  if (!chosen.towards) return;
  if (connects_equiangular() && path.segment.length > 0)
    chosen.pdf +=
        equiangular_pdf(path.segment, (path.ray.origin - path.segment.ray.origin).length(), chosen.index) *
        path.segment.path_pdf / path.packet.lane_pdf.sum();
  const Imath::V3f& wi = chosen.towards->wi;
  const SampledSpectrum phase_pdf(pdf(phase, path.ray.direction, wi));
  const SampledSpectrum contribution =
      phase_pdf *
      (path.packet.throughput * emission_from(chosen.light, wi, path.lambda_nm()) * chosen.towards->factor);
  std::optional<StokesSpectrum> measured;
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : phase_pdf;
  if (path.packet.polarisation) {
    const Polarisation rows = path.packet.polarisation->through(
        mueller(phase, path.ray.direction, wi), light_travels(path.ray.direction, kMode), kMode);
    measured = rows.of(emitted_polarisation(chosen.light, -wi), -wi);
    scattering_pdf *= rows.of_unpolarised().i;  // sampled with the polarised pdf
  }
  connect_through_media(path, chosen, contribution, scattering_pdf,
                        ray_at(path.ray.origin, wi, path.ray.time), path.media, path.at.cos_film, measured);
}

// Queues a connection through media. `scattering_pdf` is the pdf with which scattering samples the direction
// of `ray`. Transmittance and weight are applied after the shadow rays of the step are traced.
[[gnu::noinline]] void PathTracer::connect_through_media(const CameraPath& path, const ChosenLight& chosen,
                                                         const SampledSpectrum& contribution,
                                                         const SampledSpectrum& scattering_pdf,
                                                         const Ray& ray, const MediumState& media,
                                                         float cos_film,
                                                         const std::optional<StokesSpectrum>& measured) {
  connections_.push_back({path.index, {chosen.index, path.depth + 1}, contribution, cos_film});
  if (measured) measured_stokes_.push_back(*measured);
  through_media_.push_back({ray, media, path.packet.lane_pdf * scattering_pdf, chosen.pdf,
                            path.packet.lane_pdf.sum(), chosen.towards->distance});
  shadow_rays_.push_back(shadow_ray(ray, *chosen.towards));
}

// Applies transmittance and MIS weight to an unoccluded connection. Returns false if the weight is not
// finite.
[[gnu::noinline]] bool PathTracer::apply_transmittance(Connection& connection, const ThroughMedia& segment) {
  const SampledSpectrum& wavelengths_nm = batch_.paths()[connection.path].lambda_nm();
  const Transmission through =
      transmission(scene_, caster_, segment.ray, segment.media, wavelengths_nm, segment.distance);
  const float weight =
      weights_.connection_weight(segment.scattering_pdf * through.pdf, segment.light_pdf, segment.path_pdf);
  connection.contribution *= through.transmittance * weight;
  return std::isfinite(weight);
}

// Contributions and their exposure.

// Stokes vector that the sensor measures of light from `wi` scattered by an event with this matrix, relative
// to an unpolarised estimate.
StokesSpectrum PathTracer::measure(const CameraPath& path, const std::optional<MuellerMatrix>& matrix,
                                   const Light& light, const Imath::V3f& wi) {
  const Polarisation rows =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return rows.of(emitted_polarisation(light, -wi), -wi);
}

// Adds a contribution; `measured` is the polarised estimate of a contribution of 1, if polarisation is
// carried.
void PathTracer::add(CameraPath& path, const ContributionInfo& info, const SampledSpectrum& contribution,
                     float cos_film, const StokesSpectrum* measured) {
  with_measurement(measures_polarisation_, contribution, measured, [&](const auto& light) {
    if constexpr (std::is_same_v<decltype(light), const StokesSpectrum&>)
      add_to(stokes_[path.index], path, info, light, cos_film);
    else
      add_to(batch_.paths()[path.index].radiance, path, info, light, cos_film);
  });
}

// Direct light on a probe and light in a direction of the guide have their own angle of incidence.
template <typename Contribution>
void PathTracer::add_to(Contribution& radiance, CameraPath& path, const ContributionInfo& info,
                        const Contribution& contribution, float cos_film) {
  const bool adds_to_path = !response_.angular() || cos_film == batch_.paths()[path.index].at.cos_film;
  if (adds_to_path) radiance += contribution;
  if (adds_to_path && !layer_sink_) return;
  FilmPoint at = path.at;
  at.cos_film = cos_film;
  response_.expose(at, path.packet.wavelengths, contribution * path.scale,
                   [&](const FilmPoint& pixel, std::span<const double> values) {
                     if (layer_sink_) layer_sink_(first_ + path.index, pixel, info, values);
                     if (!adds_to_path) (*deposit_)(first_ + path.index, pixel, values);
                   });
}

// Exposes the sum of a path that has ended.
void PathTracer::expose(const CameraPath& path) {
  if (measures_polarisation_)
    expose(path, stokes_[path.index] * path.scale);
  else
    expose(path, path.radiance * path.scale);
}

template <typename Contribution>
void PathTracer::expose(const CameraPath& path, const Contribution& radiance) {
  response_.expose(path.at, path.packet.wavelengths, radiance,
                   [&](const FilmPoint& at, std::span<const double> values) {
                     (*deposit_)(first_ + path.index, at, values);
                   });
}

}  // namespace abbe
