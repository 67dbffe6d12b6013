#include "transport/technique/photon_gathering.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/bsdf/warp.h"
#include "transport/path/connect.h"
#include "transport/path/merge.h"
#include "transport/path/met_lights.h"
#include "transport/path/mis_weight.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/subpaths.h"

namespace abbe {
namespace {

// Not std::lgamma, which writes a sign that all threads have in common.
double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace

float gather_radius(float first_radius, std::uint64_t sample) {
  constexpr double kAlpha = 2.0 / 3;
  const auto i = static_cast<double>(sample + 1);
  const double log_ratio = log_gamma(i + kAlpha) - log_gamma(1 + kAlpha) - log_gamma(i + 1);
  return static_cast<float>(first_radius * std::exp(log_ratio / 2));
}

PhotonGatherer::PhotonGatherer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      meter_(is_meter(plan.scene.camera)),
      most_events_(most_events(plan.scene.render)),
      response_(film_response_of(plan.scene)),
      walks_(plan.scene, caster),
      ghosts_(plan, caster),
      found_(plan.scene) {}

// The estimate of a film value is, over paths from the camera that come to x with the throughput T_x over
// their density, and N paths from lights that left photons of the power T_y over theirs within r of x,
//     T_x [sum_y f T_y / (pi r^2 N) + f G T L_e / p_light],
// besides the light that events of a single direction meet: `mis_weight` balances the lanes, which are those
// of all paths of a sample. So is the time, one of all those of the exposure, and each row counts what its
// shutter passes then.
void PhotonGatherer::trace(std::span<const PixelSample> samples, const PhotonCloud& cloud,
                           const GatherKernel& kernel, const Deposit& deposit) {
  cloud_ = &cloud;
  kernel_ = kernel;
  deposit_ = &deposit;
  for (first_ = 0; first_ < samples.size(); first_ += kPathsTogether)
    trace_together(samples.subspan(first_, std::min<std::size_t>(kPathsTogether, samples.size() - first_)));
}

void PhotonGatherer::trace_together(std::span<const PixelSample> samples) {
  std::vector<GatherPath>& paths = walks_.paths();
  paths.clear();
  at_.resize(samples.size());
  images_.resize(samples.size());
  found_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    GatherPath& path = paths.emplace_back(samples[i].sampler, i);
    path.packet = cloud_->packet;
    at_[i] = start_from_camera(plan_, samples[i].x, samples[i].y, cloud_->time, path, images_[i]);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, path.packet.wavelengths, first_ + i, *deposit_, apart_);
    if (path.vertices.empty()) continue;
    if (meter_) connect_meter(path);
    walks_.going().push_back(i);
  }
  walks_.run(*this);
  for (const GatherPath& path : paths)
    found_.tell(path.path, [&](const auto& found) { expose(path, at_[path.path], found); });
}

// What a connection would have found is not counted again where a path meets it, nor what photons of caustics
// have brought; from a meter both are balanced.
void PhotonGatherer::add_met(GatherPath& path, const LightVertex& light) {
  if (path.connected != 0 || path.seeks_photons) return;
  if (path.events == 0 && on_ghost(path.vertices.front())) return;  // see `GhostLights`
  float weight = lane_balance(path.packet.lane_pdf);
  if (meter_ && path.events == 0) weight *= 1 - share_of_connecting(path.vertices.front(), {.at = light});
  const Light& emitter = scene_.lights[light.light];
  const Imath::V3f& towards = path.ray.direction;
  add(path, {light.light, path.events},
      path.packet.throughput * emission_from(emitter, towards, path.lambda_nm()) * weight,
      pointer_to(seen_of(emitter, path.packet, towards)));
}

// By the balance heuristic over both ways in which a meter's path may come to a light.
float PhotonGatherer::share_of_connecting(const PathVertex& meter, const PathVertex& light) const {
  if (scene_.lights[std::get<LightVertex>(light.at).light].is_delta()) return 1;
  const float connected = end_densities(plan_, meter, light).light_connection;
  const Imath::V3f w = way_from(meter, light).direction;
  const float met = direction_pdf(scene_, meter, Imath::V3f(0), w)[meter.packet.hero] *
                    solid_angle_per_area(scene_, meter, light);
  return connected > 0 ? connected / (connected + met) : 0;
}

void PhotonGatherer::escape(GatherPath& path) {
  find_background(scene_, path, [&](const LightVertex& light) { add_met(path, light); });
}

void PhotonGatherer::meet(GatherPath& path, const SurfaceHit& hit) {
  if (const auto light = light_met(scene_, hit, path.ray.direction)) add_met(path, *light);
}

void PhotonGatherer::connect(GatherPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  PathVertex here{.at = vertex, .packet = path.packet};
  here.inside = path.around.inside;
  here.beyond = vertex.behind(scene_, path.around.inside);
  here.time = path.ray.time;
  connect_to_light(path, here, u);
  gather(path, vertex);
}

void PhotonGatherer::connect_within(GatherPath& path, const PhaseFunction& phase,
                                    const std::array<float, 4>& u) {
  PathVertex here{.at = MediumVertex{path.ray.origin, path.ray.direction, phase}, .packet = path.packet};
  here.inside = here.beyond = path.around.inside;
  here.time = path.ray.time;
  connect_to_light(path, here, u);
}

void PhotonGatherer::connect_to_light(GatherPath& path, const PathVertex& vertex,
                                      const std::array<float, 4>& u) {
  const std::optional<PathVertex> light = light_for(plan_, vertex, u);
  if (!light) return;
  const std::optional<Connection> joint = abbe::connect(scene_, caster_, vertex, *light);
  if (!joint) return;
  add(path, {std::get<LightVertex>(light->at).light, path.events + 1},
      joint->contribution * lane_balance(vertex.packet.lane_pdf), pointer_to(joint->seen));
}

// A light that a meter sees has an angle of its own.
void PhotonGatherer::connect_meter(GatherPath& path) {
  const PathVertex& meter = path.vertices.front();
  const std::optional<PathVertex> light =
      light_for(plan_, meter, path.sampler.group(scattering_group(kMeterEvent) + 1));
  if (!light) return;
  const std::optional<Connection> joint = abbe::connect(scene_, caster_, meter, *light);
  if (!joint) return;
  FilmPoint at = at_[path.path];
  at.cos_film = way_from(meter, *light).direction.dot(*normal_of(scene_, meter));
  const SampledSpectrum contribution =
      joint->contribution * (lane_balance(meter.packet.lane_pdf) * share_of_connecting(meter, *light));
  expose(path, at, contribution);
  if (apart_) expose_apart(path, at, {std::get<LightVertex>(light->at).light, 0}, contribution);
}

// The sensor measures `seen` of a contribution of 1, where polarisation is carried.
void PhotonGatherer::add(const GatherPath& path, const LightHistory& of, const SampledSpectrum& contribution,
                         const StokesSpectrum* seen) {
  found_.add(path.path, contribution, seen);
  if (apart_)
    found_.tell(contribution, seen,
                [&](const auto& brought) { expose_apart(path, at_[path.path], of, brought); });
}

template <typename Contribution, typename DepositAt>
void PhotonGatherer::expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution,
                            DepositAt deposit) {
  response_.expose(
      at, path.packet.wavelengths,
      let_through(scene_.shutter, at, contribution) * SampledSpectrum(static_cast<float>(scene_.exposure_s)),
      deposit);
}

template <typename Contribution>
void PhotonGatherer::expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution) {
  expose(path, at, contribution, [&](const FilmPoint& pixel, std::span<const double> values) {
    (*deposit_)(first_ + path.path, pixel, values);
  });
}

template <typename Contribution>
void PhotonGatherer::expose_apart(const GatherPath& path, const FilmPoint& at, const LightHistory& of,
                                  const Contribution& contribution) {
  expose(path, at, contribution, [&](const FilmPoint& pixel, std::span<const double> values) {
    apart_(first_ + path.path, pixel, of, values);
  });
}

bool PhotonGatherer::follows(GatherPath& path, const BsdfSample& event) const {
  if (event.delta) return true;
  const bool goes_on = kernel_.final_gather && !path.final_gather;
  path.final_gather = path.seeks_photons = true;
  return goes_on;
}

void PhotonGatherer::gather(GatherPath& path, const SurfaceVertex& vertex) {
  const PhotonMap& map = cloud_->map;
  const Imath::V3f& x = vertex.hit.point;
  float radius = kernel_.radius;
  if (kernel_.nearest == 0) {
    map.within(x, radius, near_);
  } else {
    // The farthest only says how large the disc is, in which the others then lie by chance alone.
    map.nearest(x, kernel_.nearest + 1, near_);
    if (near_.size() < 2) return;
    radius = (cloud_->photons[near_.back()].point - x).length();
    near_.pop_back();
  }
  const float all = disc_area(radius) * static_cast<float>(cloud_->paths);
  if (!(all > 0)) return;
  const bool caustics_alone = kernel_.final_gather && !path.final_gather;
  for (const std::uint32_t i : near_)
    if (const Photon& photon = cloud_->photons[i]; photon.caustic || !caustics_alone)
      gather(photon, path, vertex, 1 / all);
}

void PhotonGatherer::gather(const Photon& photon, const GatherPath& path, const SurfaceVertex& vertex,
                            float per_area) {
  if (path.events + 1 + photon.events > most_events_) return;
  const SampledSpectrum f = merged_scattering(vertex, photon.from, photon.normal);
  if (f.is_zero()) return;
  add(path, {photon.light, path.events + 1 + photon.events},
      path.packet.throughput * photon.power * f *
          (per_area * lane_balance(path.packet.lane_pdf * photon.lane_pdf)),
      pointer_to(merged_polarisation(vertex, path.packet.polarisation, photon.from, photon.polarisation)));
}

}  // namespace abbe
