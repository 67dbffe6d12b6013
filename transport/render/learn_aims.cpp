#include "transport/render/learn_aims.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "transport/render/pilot_photons.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// What those photons set out with that add to the film: they count by the sum of |film value|.
std::vector<ShownStart> trace_batch(LightTracer& tracer, std::span<const Sampler> photons) {
  std::vector<double> exposures(photons.size());
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double> values) {
    for (const double v : values) exposures[photon] += std::abs(v);
  });
  std::vector<ShownStart> shown;
  for (std::size_t i = 0; i < photons.size(); ++i)
    if (exposures[i] > 0 && std::isfinite(exposures[i])) shown.push_back({tracer.starts()[i], exposures[i]});
  return shown;
}

}  // namespace

void learn_aims(Plan& plan, int threads) {
  constexpr std::uint32_t kPhotons = 1U << 17;
  if (plan.traced_lights.empty()) return;
  // First where light passes at all, then, from photons aimed there, how much of it.
  for (const PilotStage stage : {PilotStage::first_aims, PilotStage::aims}) {
    std::vector<ShownStart> shown;
    for (const std::vector<ShownStart>& batch : trace_pilot_photons(
             plan.scene, {stage, kPhotons}, threads,
             [&](RayCaster& caster) { return LightTracer(plan, caster, 1); }, trace_batch))
      shown.insert(shown.end(), batch.begin(), batch.end());
    aim_where(shown, plan);
  }
}

void aim_where(std::span<const ShownStart> shown, Plan& plan) {
  std::vector<std::vector<ShownRay>> rays(plan.guides.aims.size());
  for (const auto& [start, worth] : shown) rays[start.light].push_back({start.from, start.direction, worth});
  for (std::size_t light = 0; light < rays.size(); ++light) plan.guides.aims[light].learn(rays[light]);
}

}  // namespace abbe
