#include "transport/render/learn_aims.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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

Pilots trace_pilots(const Plan& plan, const RelativePlaces& places, const PilotPhotons& photons,
                    int threads) {
  Pilots all;
  for (const auto& [starts, splats] : trace_pilot_photons(
           plan.scene, photons, threads, [&](RayCaster&caster) { return LightTracer(plan, caster, 1); },
           [&](LightTracer&tracer, std::span<const Sampler> some) {
             return trace_batch(tracer, some, places);
           })) {
    for (const Splat& splat : splats)
      all.splats.push_back({all.starts.size() + splat.of, splat.place, splat.value});
    all.starts.insert(all.starts.end(), starts.begin(), starts.end());
  }
  return all;
}

}  // namespace

// Of photons that come to the film with relative mean square s, drawn by p0, as many are best drawn as p0
// sqrt(s) says; those drawn show p0.
void learn_aims(Plan& plan, int threads) {
  constexpr std::uint32_t kPhotons = 1U << 17;
  if (plan.traced_lights.empty()) return;
  const RelativePlaces places(plan.scene);
  // First where light passes at all, then, from photons aimed there, how much of it.
  for (const PilotStage stage : {PilotStage::first_aims, PilotStage::aims}) {
    const Pilots pilots = trace_pilots(plan, places, {stage, kPhotons}, threads);
    const std::vector<double> squares = relative_squares(pilots.splats, places, pilots.starts.size());
    std::vector<ShownStart> shown;
    for (std::size_t i = 0; i < squares.size(); ++i)
      if (squares[i] > 0 && std::isfinite(squares[i]))
        shown.push_back({pilots.starts[i], std::sqrt(squares[i])});
    aim_where(shown, plan);
  }
}

void aim_where(std::span<const ShownStart> shown, Plan& plan) {
  std::vector<std::vector<ShownRay>> rays(plan.guides.aims.size());
  for (const auto& [start, worth] : shown) rays[start.light].push_back({start.from, start.direction, worth});
  for (std::size_t light = 0; light < rays.size(); ++light) plan.guides.aims[light].learn(rays[light]);
}

}  // namespace abbe
