#include "transport/render/learn_aims.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "scene/extent.h"
#include "transport/render/pilot.h"
#include "transport/render/pilot_photons.h"
#include "transport/render/relative_splats.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// Photons, each with what it adds to the film.
struct Pilots {
  std::vector<PhotonStart> starts;
  std::vector<Splat> splats;
  [[nodiscard]] std::size_t size() const { return splats.size(); }
};

Pilots trace_batch(LightTracer& tracer, std::span<const Sampler> photons, const RelativePlaces& places) {
  Pilots pilots;
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint& at, std::span<const double> values) {
    if (magnitude(values) > 0) places.add(photon, at, values, pilots.splats);
  });
  pilots.starts.assign(tracer.starts().begin(), tracer.starts().end());
  return pilots;
}

Pilots trace_pilots(const Plan& plan, const RelativePlaces& places, const PilotPhotons& photons, int threads,
                    std::optional<double> ball_radius) {
  Pilots all;
  for (const auto& [starts, splats] : trace_pilot_photons(
           plan.scene, photons, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1, ball_radius); },
           [&](LightTracer&tracer, std::span<const Sampler> some) {
             return trace_batch(tracer, some, places);
           })) {
    for (const Splat& splat : splats)
      all.splats.push_back({all.starts.size() + splat.of, splat.place, splat.value});
    all.starts.insert(all.starts.end(), starts.begin(), starts.end());
  }
  return all;
}

constexpr std::uint32_t kPilotsOfAims = 1U << 17;

// Of one light, aims are learned from no fewer photons: of fewer it is too likely that they miss a way on
// which much of its light comes, which only those that go anywhere would be left for, each of great power.
constexpr double kEnough = 50;

// What pilots have shown, and of each light how much that counts, and by how many photons: such of one worth
// w as have the same mean and spread, (sum w)^2 / sum w^2.
struct Shown {
  std::vector<ShownStart> starts;
  std::vector<double> worths;
  std::vector<double> counts;
};

// Of photons that come to the film with relative mean square s, drawn by p0, as many are best drawn as p0
// sqrt(s) says; those drawn show p0.
Shown show(const Plan& plan, const PilotPhotons& photons, int threads,
           std::optional<double> ball_radius = {}) {
  const RelativePlaces places(plan.scene);
  const Pilots pilots = trace_pilots(plan, places, photons, threads, ball_radius);
  const std::vector<double> squares = relative_squares(pilots.splats, places, pilots.starts.size());
  const std::size_t lights = plan.guides.aims.size();
  Shown shown{{}, std::vector<double>(lights), std::vector<double>(lights)};
  std::vector<double> sums_of_squares(lights);
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (squares[i] > 0 && std::isfinite(squares[i])) {
      shown.starts.push_back({pilots.starts[i], std::sqrt(squares[i])});
      shown.worths[pilots.starts[i].light] += std::sqrt(squares[i]);
      sums_of_squares[pilots.starts[i].light] += squares[i];
    }
  for (std::size_t light = 0; light < lights; ++light)
    if (const double worth = shown.worths[light]; worth > 0)
      shown.counts[light] = worth * worth / sums_of_squares[light];
  return shown;
}

std::vector<std::vector<ShownRay>> rays_of_lights(std::span<const ShownStart> shown, const Plan& plan) {
  std::vector<std::vector<ShownRay>> rays(plan.guides.aims.size());
  for (const auto& [start, worth] : shown) rays[start.light].push_back({start.from, start.direction, worth});
  return rays;
}

// Lights shown by too few keep the aims that they have at a meter, which is closed in on: nothing like that
// is known for other cameras, so that theirs are guessed.
void aim_by(const Shown& shown, Plan& plan) {
  const std::vector<std::vector<ShownRay>> rays = rays_of_lights(shown.starts, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    if (shown.counts[light] >= kEnough)
      plan.guides.aims[light].learn(rays[light]);
    else if (!is_meter(plan.scene.camera))
      plan.guides.aims[light].guess(rays[light]);
}

// By how many photons the light is shown that is shown by fewest of those that can be aimed and of which at
// least such a share of all is that is shown.
double fewest(const Shown& shown, const Plan& plan, double share) {
  const double all = std::accumulate(shown.worths.begin(), shown.worths.end(), 0.0);
  double fewest = std::numeric_limits<double>::infinity();
  for (std::size_t light = 0; light < shown.counts.size(); ++light)
    if (plan.guides.aims[light].learns() && shown.worths[light] >= share * all)
      fewest = std::min(fewest, shown.counts[light]);
  return fewest;
}

// What few photons show is asked of as many as would show enough.
Shown show_enough(const Plan& plan, PilotStage stage, int threads, std::optional<double> ball_radius = {}) {
  constexpr double kShare = 0.01;
  constexpr double kMostTimes = 8;
  Shown shown = show(plan, {stage, kPilotsOfAims}, threads, ball_radius);
  const double few = fewest(shown, plan, kShare);
  if (few >= kEnough || shown.starts.empty()) return shown;
  const auto times = static_cast<std::uint32_t>(std::min(std::ceil(2 * kEnough / few), kMostTimes));
  return show(plan, {stage, times * kPilotsOfAims}, threads, ball_radius);
}

// What comes to a small meter comes into each ball around it. So photons are aimed at a large one first,
// which many come into by chance, then at ever smaller ones, each of which a good part of those comes into
// that are aimed at the one before.
void close_in_on_meter(Plan& plan, double ball_radius, int threads) {
  constexpr double kStep = 4;
  if (kStep * ball_radius < scene_radius(plan.scene.bounds))
    close_in_on_meter(plan, kStep * ball_radius, threads);
  aim_by(show_enough(plan, PilotStage::meter_aims, threads, ball_radius), plan);
}

// Whether a good part of what is shown is of lights that few photons show.
bool few_show_much(const Shown& shown) {
  constexpr double kMuch = 0.1;
  double all = 0;
  double by_few = 0;
  for (std::size_t light = 0; light < shown.counts.size(); ++light) {
    all += shown.worths[light];
    if (shown.counts[light] < kEnough) by_few += shown.worths[light];
  }
  return by_few > kMuch * all;
}

// Where light passes at all, from aims that are even.
void aim_roughly(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (const std::optional<Opening> opening = traits(camera).opening; is_meter(camera) && opening) {
    const Shown shown = show(plan, {PilotStage::first_aims, kPilotsOfAims}, threads);
    if (fewest(shown, plan, 0) < kEnough) return close_in_on_meter(plan, extent(*opening), threads);
    return aim_by(shown, plan);
  }
  const Shown shown = show_enough(plan, PilotStage::first_aims, threads);
  plan.guides.photons_are_rare = few_show_much(shown);
  aim_by(shown, plan);
}

}  // namespace

// First where light passes at all, then, from photons aimed there, how much of it.
void learn_aims(Plan& plan, int threads) {
  if (plan.traced_lights.empty()) return;
  aim_roughly(plan, threads);
  const Shown shown = show_enough(plan, PilotStage::aims, threads);
  plan.guides.photons_are_rare = plan.guides.photons_are_rare || few_show_much(shown);
  aim_by(shown, plan);
}

void aim_where(std::span<const ShownStart> shown, Plan& plan) {
  const std::vector<std::vector<ShownRay>> rays = rays_of_lights(shown, plan);
  for (std::size_t light = 0; light < rays.size(); ++light) plan.guides.aims[light].learn(rays[light]);
}

}  // namespace abbe
