#include "transport/technique/brute.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/path/dimensions.h"
#include "transport/path/free_path.h"
#include "transport/path/path_vertex.h"
#include "transport/path/polarised_paths.h"
#include "transport/technique/path_starts.h"

namespace abbe {

template <TransportMode mode>
void BruteForceTechnique<mode>::keep_hero_only(PathPacket& packet) {
  const SampledSpectrum hero = SampledSpectrum::only(packet.hero, 1);
  advance(packet, hero, hero);
}

// The absorption decision also covers the attenuation by media on the way to this vertex.
template <TransportMode mode>
std::optional<BsdfSample> BruteForceTechnique<mode>::scatter(RecordedPath& path, const SurfaceVertex& vertex,
                                                             const BsdfRandom& u) const {
  std::optional<BsdfSample> event = vertex.scatter(u, path.packet.hero, mode);
  if (!event) return event;
  const int hero = path.packet.hero;
  if (mode == TransportMode::radiance) path.eta_scale *= vertex.squared_eta(*event, hero);
  const float survival = path.throughput_estimate() * event->weight[hero];
  if (survival >= 1 || !(survival > 0)) return event;
  if (path.sampler.group(absorption_group(path.depth))[0] >= survival) return std::nullopt;
  event->weight *= 1 / survival;
  return event;
}

template class BruteForceTechnique<TransportMode::power>;
template class BruteForceTechnique<TransportMode::radiance>;

BrutePhotonTracer::BrutePhotonTracer(const Plan& plan, RayCaster& caster, double sample_fraction)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      opening_(traits(plan.scene.camera).opening),
      scale_(static_cast<float>(sample_fraction * plan.scene.exposure_s)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      response_(film_response_of(plan.scene)),
      batch_(plan.scene, caster) {}

// The estimate of a film value is the sum over photons of their initial power Phi over its pdf, times the
// camera's response W to incident flux: sum Phi W.
void BrutePhotonTracer::trace(std::span<const Sampler> photons, const Deposit& deposit) {
  deposit_ = &deposit;
  std::vector<RecordedPath>& paths = batch_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    RecordedPath& path = paths.emplace_back(photons[i], i);
    const std::array<float, 4> guide_random = photons[i].group(kPhotonGuideGroup);
    path.packet = draw_packet(plan_.wavelengths, guide_random[2]);
    keep_hero_only(path.packet);
    start_from_light(plan_, caster_, guide_random[kTimeIndex], path);
    if (path.vertices.empty()) continue;
    record_camera_hit(path, 0);
    batch_.active().push_back(i);
  }
  batch_.run(*this);
}

// The camera occludes no photon, as in the other techniques. The transmittance of media in front of it is a
// weight.
void BrutePhotonTracer::record_camera_hit(const RecordedPath& path, int depth) {
  if (!opening_) return;
  const auto connection = connection_through(scene_.camera, *opening_, path.ray, path.lambda_nm());
  if (!connection) return;
  const auto through = unblocked_transmission(
      scene_, caster_, shadow_ray_between(path.ray.origin, connection->lens_point, path.ray.time), path.ray,
      path.media, path.lambda_nm(), (connection->lens_point - path.ray.origin).length());
  if (!through) return;
  const FilmPoint at{static_cast<int>(connection->film.x), static_cast<int>(connection->film.y),
                     connection->cos_film, path.ray.time, images_of(*connection)};
  const ContributionInfo info{std::get<LightVertex>(path.vertices.front().at).light, depth};
  const auto arrives =
      measured_on_film(scene_, path.packet, path.ray.direction, path.ray.time, images_of(*connection));
  with_measurement(measures_polarisation_,
                   path.packet.throughput * connection->weight * through->transmittance * scale_,
                   pointer_to(arrives), [&](const auto& light) {
                     response_.expose(at, path.packet.wavelengths, apply_shutter(scene_.shutter, at, light),
                                      [&](const FilmPoint& pixel, std::span<const double> values) {
                                        (*deposit_)(path.index, pixel, values);
                                        if (layer_sink_) layer_sink_(path.index, pixel, info, values);
                                      });
                   });
}

AdjointBruteTracer::AdjointBruteTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      response_(film_response_of(plan.scene)),
      batch_(plan.scene, caster),
      radiance_(plan.scene) {}

// The estimate of a film value is the initial throughput of a path over its pdf, times the radiance of the
// lights it hits.
void AdjointBruteTracer::trace(std::span<const PixelSample> samples, const Deposit& deposit) {
  std::vector<RecordedPath>& paths = batch_.paths();
  paths.clear();
  film_points_.resize(samples.size());
  images_.resize(samples.size());
  radiance_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    RecordedPath& path = paths.emplace_back(samples[i].sampler, i);
    const std::array<float, 4> film = path.sampler.group(kFilmGroup);
    path.packet = draw_packet(plan_.wavelengths_at(samples[i].x, samples[i].y), film[2]);
    film_points_[i] =
        start_from_camera(plan_, samples[i].x, samples[i].y,
                          scene_.shutter.sample(samples[i].y, film[kTimeIndex]), path, images_[i]);
    if (film_points_[i].images != nullptr) {
      const SampledSpectrum shutter_weights = relative_shutter_weights(scene_.shutter, film_points_[i]);
      advance(path.packet, shutter_weights, shutter_weights);
    }
    keep_hero_only(path.packet);
    if (path.packet.throughput.is_zero()) continue;  // no light passes the lens or the shutter there
    path.initial_throughput = path.packet.throughput_estimate();
    batch_.active().push_back(i);
  }
  batch_.run(*this);
  for (const RecordedPath& path : paths)
    radiance_.visit(path.index, [&](const auto& value) {
      expose(path, value,
             [&](const FilmPoint& at, std::span<const double> values) { deposit(path.index, at, values); });
    });
}

template <typename Contribution, typename DepositAt>
void AdjointBruteTracer::expose(const RecordedPath& path, const Contribution& contribution,
                                DepositAt deposit) {
  const SampledSpectrum scale(static_cast<float>(scene_.exposure_s * scene_.shutter.mean()));
  response_.expose(film_points_[path.index], path.packet.wavelengths, contribution * scale, deposit);
}

void AdjointBruteTracer::add_emission(const RecordedPath& path, std::uint32_t light) {
  const Light& emitter = scene_.lights[light];
  const Imath::V3f& towards = path.ray.direction;
  const SampledSpectrum contribution =
      path.packet.throughput * emission_from(emitter, towards, path.lambda_nm());
  const auto measured = measured_emission(emitter, path.packet, towards);
  radiance_.add(path.index, contribution, pointer_to(measured));
  if (!layer_sink_) return;
  const ContributionInfo info{light, path.depth};
  radiance_.visit(contribution, pointer_to(measured), [&](const auto& value) {
    expose(path, value, [&](const FilmPoint& at, std::span<const double> values) {
      layer_sink_(path.index, at, info, values);
    });
  });
}

void AdjointBruteTracer::on_escape(RecordedPath& path) {
  visit_escaped_lights(scene_, path, [&](const LightVertex& light) { add_emission(path, light.light); });
}

void AdjointBruteTracer::on_hit(RecordedPath& path, const SurfaceHit& hit) {
  if (const auto light = emitter_hit(scene_, hit, path.ray.direction)) add_emission(path, light->light);
}

}  // namespace abbe
