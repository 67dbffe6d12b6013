#include "transport/technique/brute.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/path/dimensions.h"
#include "transport/path/free_path.h"
#include "transport/path/met_lights.h"
#include "transport/path/polarised_ends.h"
#include "transport/technique/subpaths.h"

namespace abbe {

template <TransportMode mode>
void BruteWalk<mode>::keep_hero(PathPacket& packet) {
  const SampledSpectrum hero = SampledSpectrum::only(packet.hero, 1);
  advance(packet, hero, hero);
}

// What matter has taken on the way here is taken by the same chance.
template <TransportMode mode>
std::optional<BsdfSample> BruteWalk<mode>::scatter(RecordedPath& path, const SurfaceVertex& vertex,
                                                   const BsdfRandom& u) const {
  std::optional<BsdfSample> event = vertex.scatter(u, path.packet.hero, mode);
  if (!event) return event;
  const int hero = path.packet.hero;
  if (mode == TransportMode::radiance) path.eta_scale *= vertex.squared_eta(*event, hero);
  const float kept = carried(path) * event->weight[hero];
  if (kept >= 1 || !(kept > 0)) return event;
  if (path.sampler.group(absorption_group(path.events))[0] >= kept) return std::nullopt;
  event->weight *= 1 / kept;
  return event;
}

template class BruteWalk<TransportMode::power>;
template class BruteWalk<TransportMode::radiance>;

BrutePhotonTracer::BrutePhotonTracer(const Plan& plan, RayCaster& caster, double share)
    : plan_(plan),
      scene_(plan.scene),
      caster_(caster),
      opening_(traits(plan.scene.camera).opening),
      scale_(static_cast<float>(share * plan.scene.exposure_s)),
      measures_polarisation_(measures_polarisation(plan.scene)),
      response_(film_response_of(plan.scene)),
      walks_(plan.scene, caster) {}

// The estimate of a film value is the sum over photons of the power Phi that each set out with, over its
// density, times what the camera makes of a flux that comes in: sum Phi W.
void BrutePhotonTracer::trace(std::span<const Sampler> photons, const Deposit& deposit) {
  deposit_ = &deposit;
  std::vector<RecordedPath>& paths = walks_.paths();
  paths.clear();
  for (std::uint32_t i = 0; i < photons.size(); ++i) {
    RecordedPath& path = paths.emplace_back(photons[i], i);
    const std::array<float, 4> aim = photons[i].group(kAimGroup);
    path.packet = draw_packet(plan_.wavelengths, aim[2]);
    keep_hero(path.packet);
    start_from_light(plan_, caster_, aim[kTimeNumber], path);
    if (path.vertices.empty()) continue;
    look_for_camera(path, 0);
    walks_.going().push_back(i);
  }
  walks_.run(*this);
}

// The camera stands in no photon's way, as in none of other techniques. What matter takes before it is
// weighed.
void BrutePhotonTracer::look_for_camera(const RecordedPath& path, int events) {
  if (!opening_) return;
  const auto seen = connection_through(scene_.camera, *opening_, path.ray, path.lambda_nm());
  if (!seen) return;
  const auto through = unblocked_transmission(
      scene_, caster_, way_between(path.ray.origin, seen->lens_point, path.ray.time), path.ray, path.around,
      path.lambda_nm(), (seen->lens_point - path.ray.origin).length());
  if (!through) return;
  const FilmPoint at{static_cast<int>(seen->film.x), static_cast<int>(seen->film.y), seen->cos_film,
                     path.ray.time, images_of(*seen)};
  const LightHistory of{std::get<LightVertex>(path.vertices.front().at).light, events};
  const auto arrives = seen_on_film(scene_, path.packet, path.ray.direction, path.ray.time, images_of(*seen));
  with_seen(measures_polarisation_, path.packet.throughput * seen->weight * through->transmittance * scale_,
            pointer_to(arrives), [&](const auto& light) {
              response_.expose(at, path.packet.wavelengths, let_through(scene_.shutter, at, light),
                               [&](const FilmPoint& pixel, std::span<const double> values) {
                                 (*deposit_)(path.path, pixel, values);
                                 if (apart_) apart_(path.path, pixel, of, values);
                               });
            });
}

AdjointBruteTracer::AdjointBruteTracer(const Plan& plan, RayCaster& caster)
    : plan_(plan),
      scene_(plan.scene),
      response_(film_response_of(plan.scene)),
      walks_(plan.scene, caster),
      found_(plan.scene) {}

// The estimate of a pixel's film value is what a path set out with, over its density, times the radiance of
// the lights it meets.
void AdjointBruteTracer::trace(std::span<const PixelSample> samples, const Deposit& deposit) {
  std::vector<RecordedPath>& paths = walks_.paths();
  paths.clear();
  at_.resize(samples.size());
  images_.resize(samples.size());
  found_.reset(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    RecordedPath& path = paths.emplace_back(samples[i].sampler, i);
    const std::array<float, 4> film = path.sampler.group(kFilmGroup);
    path.packet = draw_packet(plan_.wavelengths_at(samples[i].x, samples[i].y), film[2]);
    at_[i] = start_from_camera(plan_, samples[i].x, samples[i].y,
                               scene_.shutter.draw(samples[i].y, film[kTimeNumber]), path, images_[i]);
    if (at_[i].images != nullptr) {
      const SampledSpectrum others = openings_over_own(scene_.shutter, at_[i]);
      advance(path.packet, others, others);
    }
    keep_hero(path.packet);
    if (path.packet.throughput.is_zero()) continue;  // no light comes through a lens or a shutter there
    path.carried_at_start = path.packet.carried();
    walks_.going().push_back(i);
  }
  walks_.run(*this);
  for (const RecordedPath& path : paths)
    found_.tell(path.path, [&](const auto& found) {
      expose(path, found,
             [&](const FilmPoint& at, std::span<const double> values) { deposit(path.path, at, values); });
    });
}

template <typename Contribution, typename DepositAt>
void AdjointBruteTracer::expose(const RecordedPath& path, const Contribution& contribution,
                                DepositAt deposit) {
  const SampledSpectrum scale(static_cast<float>(scene_.exposure_s * scene_.shutter.mean()));
  response_.expose(at_[path.path], path.packet.wavelengths, contribution * scale, deposit);
}

void AdjointBruteTracer::add_met(const RecordedPath& path, std::uint32_t light) {
  const Light& emitter = scene_.lights[light];
  const Imath::V3f& towards = path.ray.direction;
  const SampledSpectrum contribution =
      path.packet.throughput * emission_from(emitter, towards, path.lambda_nm());
  const auto seen = seen_of(emitter, path.packet, towards);
  found_.add(path.path, contribution, pointer_to(seen));
  if (!apart_) return;
  const LightHistory of{light, path.events};
  found_.tell(contribution, pointer_to(seen), [&](const auto& brought) {
    expose(path, brought,
           [&](const FilmPoint& at, std::span<const double> values) { apart_(path.path, at, of, values); });
  });
}

void AdjointBruteTracer::escape(RecordedPath& path) {
  find_background(scene_, path, [&](const LightVertex& light) { add_met(path, light.light); });
}

void AdjointBruteTracer::meet(RecordedPath& path, const SurfaceHit& hit) {
  if (const auto light = light_met(scene_, hit, path.ray.direction)) add_met(path, light->light);
}

}  // namespace abbe
