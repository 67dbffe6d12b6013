#include "transport/technique/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "materials/bsdf/warp.h"
#include "scene/polarisation_need.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/start_matter.h"

namespace abbe {
namespace {

// The density of directions of which the guide draws some, `scattering` being that of the others.
SampledSpectrum mixed_pdf(const SampledSpectrum& scattering, const CausticLobes& caustics,
                          const Imath::V3f& point, const Imath::V3f& direction) {
  return scattering * (1 - caustics.share()) +
         SampledSpectrum(caustics.share() * caustics.pdf(point, direction));
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
  std::vector<CameraPath>& paths = walks_.paths();
  paths.clear();
  if (measures_polarisation_) found_.assign(samples.size(), {});
  if (camera_.displaces_lanes) {
    start_together(samples);
  } else {
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
      CameraPath& path = paths.emplace_back(samples[i].sampler, i);
      const auto [film, lens, wavelengths_nm, hero, time] = ask(samples[i], path);
      if (start(samples[i], sample_ray(scene_.camera, film, lens, wavelengths_nm, hero, time), path))
        walks_.going().push_back(i);
    }
  }
  resolve_connections();
  walks_.run(*this);
  for (const CameraPath& path : std::span(paths).first(samples.size()))
    if (measures_polarisation_)
      expose(path, found_[path.path] * path.scale);
    else
      expose(path, path.found * path.scale);
}

template <typename Contribution>
void PathTracer::expose(const CameraPath& path, const Contribution& found) {
  response_.expose(path.at, path.packet.wavelengths, found,
                   [&](const FilmPoint& at, std::span<const double> values) {
                     (*deposit_)(first_ + path.path, at, values);
                   });
}

// Rays through a lens are traced several at once.
void PathTracer::start_together(std::span<const PixelSample> samples) {
  std::vector<CameraPath>& paths = walks_.paths();
  asked_.clear();
  rays_.resize(samples.size());
  images_.resize(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i)
    asked_.push_back(ask(samples[i], paths.emplace_back(samples[i].sampler, i)));
  sample_rays(scene_.camera, asked_, rays_);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    if (start(samples[i], rays_[i], paths[i])) walks_.going().push_back(i);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, paths[i].packet.wavelengths, first_ + i, *deposit_, apart_);
  }
}

CameraSample PathTracer::ask(const PixelSample& sample, CameraPath& path) const {
  const std::array<float, 4> film = sample.sampler.group(kFilmGroup);
  const std::array<float, 4> lens =
      camera_.depth_of_field ? sample.sampler.group(kLensGroup) : std::array<float, 4>{};
  path.packet = draw_packet(plan_.wavelengths_at(sample.x, sample.y), film[2]);
  return {{static_cast<float>(sample.x) + film[0], static_cast<float>(sample.y) + film[1]},
          {lens[0], lens[1]},
          path.lambda_nm(),
          path.packet.hero,
          scene_.shutter.draw(sample.y, film[kTimeNumber])};
}

bool PathTracer::start(const PixelSample& sample, const CameraRay& ray, CameraPath& path) {
  path.ray = ray.ray;
  path.route = ray.route;
  if (carries_polarisation_)
    path.packet.polarisation =
        polarisation_of_film(scene_, light_travels(path.ray.direction, kMode), ray.ray.time, images_of(ray));
  path.at = {sample.x, sample.y, ray.cos_film, ray.ray.time};
  path.scale = ray.weight * static_cast<float>(scene_.exposure_s * scene_.shutter.mean());
  enter_camera_matter(plan_, path);
  if (camera_.displaces_lanes && !part_lanes(ray, path)) return false;
  if (!camera_.meter_acceptance) return true;
  const Imath::V3f normal = meter_normal(scene_.camera, path.ray.origin);
  path.events = kMeterEvent;
  const bool leaves = walks_.leave(*this, path, SurfaceVertex::meter(path.ray.origin, normal));
  path.at.cos_film = path.ray.direction.dot(normal);
  return leaves;
}

// Each lane falls where the lens takes it, balanced with the others that would have drawn the ray, and the
// time of it. Whether any light comes through at all.
[[gnu::noinline]] bool PathTracer::part_lanes(const CameraRay& ray, CameraPath& path) {
  if (ray.weight.is_zero()) return false;
  images_[path.path] = *ray.images;
  path.at.images = &images_[path.path];
  const SampledSpectrum openings = openings_over_own(scene_.shutter, path.at);
  path.scale *= openings;
  path.packet.lane_pdf = ray.lane_pdf * openings;
  path.eta_scale = path.packet.lane_pdf.max();
  return !openings.is_zero();
}

// What the sensor measures of light that comes from `wi` and that an event of that matrix sends along the
// path, over what it would measure were all of it unpolarised.
StokesSpectrum PathTracer::measured(const CameraPath& path, const std::optional<MuellerMatrix>& matrix,
                                    const Light& light, const Imath::V3f& wi) {
  const Polarisation rows =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return rows.of(polarisation_of_lamp(light, -wi), -wi);
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
  if (owned_by_others(path, light)) return;
  const float pdf = connection_pdf(path, met);
  const Imath::V3f& towards = path.ray.direction;
  const SampledSpectrum contribution = path.packet.throughput *
                                       emission_from(scene_.lights[light], towards, path.lambda_nm()) *
                                       weights_.of_met(path.packet.lane_pdf, pdf, path.connected);
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
  if (!connects()) return;
  const ChosenLight chosen = choose_light(vertex.place(), u, path.ray.time);
  if (!chosen.towards) return;
  const Imath::V3f& world = chosen.towards->wi;
  const auto [wi, f, crosses] = vertex.towards(world, kMode);
  if (f.is_zero()) return;
  SampledSpectrum contribution =
      f * (path.packet.throughput * emission_from(chosen.light, world, path.lambda_nm()) *
           (std::abs(wi.z) * chosen.towards->factor));
  std::optional<StokesSpectrum> seen;
  if (path.packet.polarisation) seen = measured(path, vertex.mueller(wi, false), chosen.light, world);
  SampledSpectrum scattering_pdf = chosen.light.is_delta() ? SampledSpectrum(0.0F) : unguided_pdf(vertex, wi);
  if (path.events == kMeterEvent && !accepted(world, vertex.hit.normal, contribution, scattering_pdf)) return;
  if (!path.caustics.empty() && !chosen.light.is_delta())
    scattering_pdf = mixed_pdf(scattering_pdf, path.caustics, vertex.hit.point, world);
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

// A meter counts what comes within an angle as a white surface would what comes from its hemisphere: that is
// over pi sin^2, and so is the density of its directions, which `leave_meter` draws by the cosine.
bool PathTracer::accepted(const Imath::V3f& direction, const Imath::V3f& normal,
                          SampledSpectrum& contribution, SampledSpectrum& pdf) const {
  const float acceptance = *camera_.meter_acceptance;
  if (!within_acceptance(acceptance, normal, direction)) return false;
  if (!narrow_) return true;
  contribution *= 1 / (acceptance * acceptance);
  if (!pdf.is_zero()) pdf = SampledSpectrum(normal.dot(direction) / disc_area(acceptance));
  return true;
}

[[gnu::noinline]] BsdfSample PathTracer::leave_meter(const Imath::V2f& u) const {
  const float acceptance = *camera_.meter_acceptance;
  const Imath::V3f wi = cosine_cone(u, acceptance);
  return BsdfSample{.wi = wi, .weight = SampledSpectrum(1.0F), .pdf = wi.z / disc_area(acceptance)};
}

// The photons bring what comes through specular matter from traced lights, but for what a camera sees through
// it, and for what a surface or matter scatters to a meter.
void PathTracer::reach(CameraPath& path, const SurfaceVertex& vertex) const {
  if (narrow_ && path.events == kMeterEvent) return;
  const bool of_traced = path.owns_caustics || (camera_.meter_acceptance && path.events == 0);
  const CausticGuide& guide = of_traced ? plan_.guides.caustics_seen_through : plan_.guides.caustics_of_paths;
  path.caustics = !guide.empty() && scatters(vertex.bsdf) ? guide.at(vertex.hit.point) : CausticLobes();
}

// A direction drawn from the guide or as without it, by chance. Roulette must not take what the guide draws
// the more often the less likely for what it carries less: what that is over is counted as still there.
[[gnu::noinline]] std::optional<BsdfSample> PathTracer::scatter_guided(CameraPath& path,
                                                                       const SurfaceVertex& vertex,
                                                                       BsdfRandom u) const {
  const float share = path.caustics.share();
  const bool guided = u.lobe < share;
  u.lobe = guided ? u.lobe / share : (u.lobe - share) / (1 - share);
  std::optional<BsdfSample> event;
  SampledSpectrum scattered;       // f cos
  SampledSpectrum scattering_pdf;  // of each lane
  Imath::V3f world;
  if (guided) {
    world = path.caustics.sample(vertex.hit.point, u.lobe, u.direction);
    const auto [wi, f, crosses] = vertex.towards(world, kMode);
    if (f.is_zero()) return std::nullopt;
    scattered = f * std::abs(wi.z);
    scattering_pdf = unguided_pdf(vertex, wi);
    event.emplace().wi = wi;
    event->transmitted = crosses;
  } else {
    event = scatter_unguided(path, vertex, u);
    if (!event) return event;
    if (event->delta) {
      event->weight *= 1 / (1 - share);
      event->pdf *= 1 - share;
      return event;
    }
    world = vertex.frame.to_world(event->wi);
    scattered = event->weight * event->pdf;
    scattering_pdf = event->lane_pdf * event->pdf;
  }
  const SampledSpectrum mixed = mixed_pdf(scattering_pdf, path.caustics, vertex.hit.point, world);
  event->pdf = mixed[path.packet.hero];
  if (!(event->pdf > 0)) return std::nullopt;
  event->weight = scattered * (1 / event->pdf);
  event->lane_pdf = mixed * (1 / event->pdf);
  path.eta_scale *= std::max(1.0F, mixed.max() / scattering_pdf.max());
  return event;
}

bool PathTracer::follows(CameraPath& path, const BsdfSample& event) const {
  if (path.events == 0) path.owns_caustics = event.delta != camera_.meter_acceptance.has_value();
  return true;
}

float PathTracer::kept(CameraPath& path, const SurfaceVertex& vertex, const BsdfSample& event) const {
  path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
  return path.going_on * carried(path);
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

// The sensor measures `seen` of a contribution of 1, where polarisation is carried.
void PathTracer::add(CameraPath& path, const LightHistory& of, const SampledSpectrum& contribution,
                     float cos_film, const StokesSpectrum* seen) {
  with_seen(measures_polarisation_, contribution, seen, [&](const auto& light) {
    if constexpr (std::is_same_v<decltype(light), const StokesSpectrum&>)
      add_to(found_[path.path], path, of, light, cos_film);
    else
      add_to(walks_.paths()[path.path].found, path, of, light, cos_film);
  });
}

// Light that a meter sees directly comes in under an angle of its own.
template <typename Contribution>
void PathTracer::add_to(Contribution& found, CameraPath& path, const LightHistory& of,
                        const Contribution& contribution, float cos_film) {
  const bool with_others = !response_.angular() || cos_film == path.at.cos_film;
  if (with_others) found += contribution;
  if (with_others && !apart_) return;
  FilmPoint at = path.at;
  at.cos_film = cos_film;
  response_.expose(at, path.packet.wavelengths, contribution * path.scale,
                   [&](const FilmPoint& pixel, std::span<const double> values) {
                     if (apart_) apart_(first_ + path.path, pixel, of, values);
                     if (!with_others) (*deposit_)(first_ + path.path, pixel, values);
                   });
}

}  // namespace abbe
