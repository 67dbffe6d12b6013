#include "transport/technique/photon_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "materials/bsdf/warp.h"
#include "transport/path/connect.h"
#include "transport/path/mis_weight.h"
#include "transport/path/path_vertex.h"
#include "transport/path/polarised_paths.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

std::vector<Imath::V3f> positions_of(const std::vector<Photon>& photons) {
  std::vector<Imath::V3f> points(photons.size());
  std::transform(photons.begin(), photons.end(), points.begin(), [](const Photon& p) { return p.point; });
  return points;
}

// Not std::lgamma, which writes a global variable for the sign.
double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace

PhotonTracer::PhotonTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan), caster_(caster), batch_(plan.scene, caster) {}

void PhotonTracer::trace(std::span<const Sampler> samplers, const PathPacket& packet, float time,
                         std::vector<Photon>& photons) {
  path_photons_.clear();
  scattered_.assign(samplers.size(), false);
  std::vector<RecordedPath>& paths = batch_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < samplers.size(); ++i) {
    RecordedPath& path = paths.emplace_back(samplers[i], i);
    path.packet = packet;
    start_from_light(plan_, caster_, time, path);
    if (!path.vertices.empty()) batch_.active().push_back(i);
  }
  batch_.run(*this);
  std::sort(path_photons_.begin(), path_photons_.end(), [](const PathPhoton& a, const PathPhoton& b) {
    return std::pair(a.path, a.photon.depth) < std::pair(b.path, b.photon.depth);
  });
  for (const PathPhoton& stored : path_photons_) photons.push_back(stored.photon);
}

void PhotonTracer::connect(RecordedPath& path, const SurfaceVertex& vertex,
                           const std::array<float, 4>& /*u*/) {
  if (path.depth == 0) return;
  path_photons_.push_back(
      {path.index,
       {vertex.hit.point, vertex.hit.normal, -path.ray.direction, path.packet.throughput,
        path.packet.lane_pdf, path.depth, std::get<LightVertex>(path.vertices.front().at).light,
        !scattered_[path.index], path.packet.polarisation}});
}

void PhotonTracer::connect_in_medium(RecordedPath& path, const PhaseFunction& /*phase*/,
                                     const std::array<float, 4>& /*u*/) {
  scattered_[path.index] = true;
}

PhotonCloud::PhotonCloud(std::vector<Photon> stored_photons, std::uint64_t traced,
                         const PathPacket& start_packet, float start_time)
    : photons(std::move(stored_photons)),
      map(positions_of(photons)),
      paths(traced),
      packet(start_packet),
      time(start_time) {}

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
      probe_(is_probe(plan.scene.camera)),
      max_depth_(depth_limit(plan.scene.render)),
      response_(film_response_of(plan.scene)),
      batch_(plan.scene, caster),
      ghosts_(plan, caster),
      radiance_(plan.scene) {}

// The estimate of a film value is a sum over camera paths that arrive at x with the throughput T_x over its
// pdf. Of N light paths, those that stored photons of power T_y over its pdf within r of x count:
//     T_x [sum_y f T_y / (pi r^2 N) + f G T L_e / p_light].
// Emitter hits after delta events are added. `lane_balance` weights the wavelengths, which are those of all
// paths of a sample. The time is common to all paths as well, uniform over the exposure, and the shutter
// weights each film row.
void PhotonGatherer::trace(std::span<const PixelSample> samples, const PhotonCloud& cloud,
                           const GatherKernel& kernel, const Deposit& deposit) {
  cloud_ = &cloud;
  kernel_ = kernel;
  deposit_ = &deposit;
  for (first_ = 0; first_ < samples.size(); first_ += kBatchSize)
    trace_batch(samples.subspan(first_, std::min<std::size_t>(kBatchSize, samples.size() - first_)));
}

void PhotonGatherer::trace_batch(std::span<const PixelSample> samples) {
  std::vector<GatherPath>& paths = batch_.paths();
  paths.clear();
  film_points_.resize(samples.size());
  images_.resize(samples.size());
  radiance_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    GatherPath& path = paths.emplace_back(samples[i].sampler, i);
    path.packet = cloud_->packet;
    film_points_[i] = start_from_camera(plan_, samples[i].x, samples[i].y, cloud_->time, path, images_[i]);
    if (ghosts_.any())
      ghosts_.connect(samples[i].sampler, path.packet.wavelengths, first_ + i, *deposit_, layer_sink_);
    if (path.vertices.empty()) continue;
    if (probe_) connect_probe(path);
    batch_.active().push_back(i);
  }
  batch_.run(*this);
  for (const GatherPath& path : paths)
    radiance_.visit(path.index, [&](const auto& value) { expose(path, film_points_[path.index], value); });
}

// Emission is not counted again if a connection or caustic photons own it; at a probe, connection and emitter
// hit are balanced.
void PhotonGatherer::add_emission(GatherPath& path, const LightVertex& light) {
  if (path.nee_path_pdf != 0 || path.seeks_photons) return;
  if (path.depth == 0 && on_ghost(path.vertices.front())) return;  // see `GhostLights`
  float weight = lane_balance(path.packet.lane_pdf);
  if (probe_ && path.depth == 0) weight *= 1 - connection_mis_weight(path.vertices.front(), {.at = light});
  const Light& emitter = scene_.lights[light.light];
  const Imath::V3f& towards = path.ray.direction;
  add(path, {light.light, path.depth},
      path.packet.throughput * emission_from(emitter, towards, path.lambda_nm()) * weight,
      pointer_to(measured_emission(emitter, path.packet, towards)));
}

// Balance heuristic for a probe's path to a light, which a connection or a sampled direction may find.
float PhotonGatherer::connection_mis_weight(const PathVertex& probe, const PathVertex& light) const {
  if (scene_.lights[std::get<LightVertex>(light.at).light].is_delta()) return 1;
  const float connection_pdf = end_densities(plan_, probe, light).light_connection;
  const Imath::V3f w = segment_between(probe, light).direction;
  const float direction_sampling_pdf = direction_pdf(scene_, probe, Imath::V3f(0), w)[probe.packet.hero] *
                                       solid_angle_per_area(scene_, probe, light);
  return connection_pdf > 0 ? connection_pdf / (connection_pdf + direction_sampling_pdf) : 0;
}

void PhotonGatherer::on_escape(GatherPath& path) {
  visit_escaped_lights(scene_, path, [&](const LightVertex& light) { add_emission(path, light); });
}

void PhotonGatherer::on_hit(GatherPath& path, const SurfaceHit& hit) {
  if (const auto light = emitter_hit(scene_, hit, path.ray.direction)) add_emission(path, *light);
}

void PhotonGatherer::connect(GatherPath& path, const SurfaceVertex& vertex, const std::array<float, 4>& u) {
  PathVertex here{.at = vertex, .packet = path.packet};
  here.media_front = path.media.stack;
  here.media_behind = vertex.media_behind(scene_, path.media.stack);
  here.time = path.ray.time;
  connect_to_light(path, here, u);
  gather(path, vertex);
}

void PhotonGatherer::connect_in_medium(GatherPath& path, const PhaseFunction& phase,
                                       const std::array<float, 4>& u) {
  PathVertex here{.at = MediumVertex{path.ray.origin, path.ray.direction, phase}, .packet = path.packet};
  here.media_front = here.media_behind = path.media.stack;
  here.time = path.ray.time;
  connect_to_light(path, here, u);
}

void PhotonGatherer::connect_to_light(GatherPath& path, const PathVertex& vertex,
                                      const std::array<float, 4>& u) {
  const std::optional<PathVertex> light = sample_light_vertex(plan_, vertex, u);
  if (!light) return;
  const std::optional<Connection> connection = abbe::connect(scene_, caster_, vertex, *light);
  if (!connection) return;
  add(path, {std::get<LightVertex>(light->at).light, path.depth + 1},
      connection->contribution * lane_balance(vertex.packet.lane_pdf), pointer_to(connection->stokes));
}

// A probe receives each light at its own angle of incidence.
void PhotonGatherer::connect_probe(GatherPath& path) {
  const PathVertex& probe = path.vertices.front();
  const std::optional<PathVertex> light =
      sample_light_vertex(plan_, probe, path.sampler.group(scattering_group(kProbeDepth) + 1));
  if (!light) return;
  const std::optional<Connection> connection = abbe::connect(scene_, caster_, probe, *light);
  if (!connection) return;
  FilmPoint at = film_points_[path.index];
  at.cos_film = segment_between(probe, *light).direction.dot(*normal_of(scene_, probe));
  const SampledSpectrum contribution =
      connection->contribution * (lane_balance(probe.packet.lane_pdf) * connection_mis_weight(probe, *light));
  expose(path, at, contribution);
  if (layer_sink_) deposit_to_layer(path, at, {std::get<LightVertex>(light->at).light, 0}, contribution);
}

// Adds a contribution; `measured` is the polarised estimate of a contribution of 1, if polarisation is
// carried.
void PhotonGatherer::add(const GatherPath& path, const ContributionInfo& info,
                         const SampledSpectrum& contribution, const StokesSpectrum* measured) {
  radiance_.add(path.index, contribution, measured);
  if (layer_sink_)
    radiance_.visit(contribution, measured, [&](const auto& value) {
      deposit_to_layer(path, film_points_[path.index], info, value);
    });
}

template <typename Contribution, typename DepositAt>
void PhotonGatherer::expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution,
                            DepositAt deposit) {
  response_.expose(at, path.packet.wavelengths,
                   apply_shutter(scene_.shutter, at, contribution) *
                       SampledSpectrum(static_cast<float>(scene_.exposure_s)),
                   deposit);
}

template <typename Contribution>
void PhotonGatherer::expose(const GatherPath& path, const FilmPoint& at, const Contribution& contribution) {
  expose(path, at, contribution, [&](const FilmPoint& pixel, std::span<const double> values) {
    (*deposit_)(first_ + path.index, pixel, values);
  });
}

template <typename Contribution>
void PhotonGatherer::deposit_to_layer(const GatherPath& path, const FilmPoint& at,
                                      const ContributionInfo& info, const Contribution& contribution) {
  expose(path, at, contribution, [&](const FilmPoint& pixel, std::span<const double> values) {
    layer_sink_(first_ + path.index, pixel, info, values);
  });
}

bool PhotonGatherer::continues_after(GatherPath& path, const BsdfSample& event) const {
  if (event.delta) return true;
  const bool continues = kernel_.final_gather && !path.final_gather;
  path.final_gather = path.seeks_photons = true;
  return continues;
}

void PhotonGatherer::gather(GatherPath& path, const SurfaceVertex& vertex) {
  const PhotonMap& map = cloud_->map;
  const Imath::V3f& x = vertex.hit.point;
  float radius = kernel_.radius;
  if (kernel_.nearest == 0) {
    map.within(x, radius, nearby_);
  } else {
    // The farthest photon only determines the disc's radius; given the radius, the others are distributed
    // independently within it.
    map.nearest(x, kernel_.nearest + 1, nearby_);
    if (nearby_.size() < 2) return;
    radius = (cloud_->photons[nearby_.back()].point - x).length();
    nearby_.pop_back();
  }
  const float area_times_paths = disc_area(radius) * static_cast<float>(cloud_->paths);
  if (!(area_times_paths > 0)) return;
  const bool caustics_only = kernel_.final_gather && !path.final_gather;
  for (const std::uint32_t i : nearby_)
    if (const Photon& photon = cloud_->photons[i]; photon.caustic || !caustics_only)
      gather(photon, path, vertex, 1 / area_times_paths);
}

void PhotonGatherer::gather(const Photon& photon, const GatherPath& path, const SurfaceVertex& vertex,
                            float per_area) {
  if (path.depth + 1 + photon.depth > max_depth_) return;
  const SampledSpectrum f = merged_scattering(vertex, photon.from, photon.normal);
  if (f.is_zero()) return;
  add(path, {photon.light, path.depth + 1 + photon.depth},
      path.packet.throughput * photon.power * f *
          (per_area * lane_balance(path.packet.lane_pdf * photon.lane_pdf)),
      pointer_to(merged_polarisation(vertex, path.packet.polarisation, photon.from, photon.polarisation)));
}

}  // namespace abbe
