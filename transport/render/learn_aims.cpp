#include "transport/render/learn_aims.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "transport/render/pilot_photons.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// A photon that shows where to aim others, by what it adds to the film.
struct Pilot {
  PhotonStart start;
  double exposure = 0;  // the sum of |film value|
};

std::vector<Pilot> trace_batch(LightTracer& tracer, std::span<const Sampler> photons) {
  std::vector<Pilot> pilots(photons.size());
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double> values) {
    for (const double v : values) pilots[photon].exposure += std::abs(v);
  });
  for (std::size_t i = 0; i < pilots.size(); ++i) pilots[i].start = tracer.starts()[i];
  return pilots;
}

}  // namespace

void learn_aims(Plan& plan, int threads) {
  constexpr std::uint32_t kPhotons = 1U << 17;
  // First where light passes at all, then, from photons aimed there, how much of it: spread over so many
  // cells.
  constexpr std::array<std::pair<PilotStage, int>, 2> kStages{
      {{PilotStage::first_aims, 4}, {PilotStage::aims, 1}}};
  if (plan.traced_lights.empty()) return;
  std::vector<Aim>& aims = plan.guides.aims;
  for (const auto& [stage, reach] : kStages) {
    std::vector<std::vector<double>> importance;
    for (const Aim& aim : aims) importance.push_back(aim.no_importance());
    for (const std::vector<Pilot>& batch : trace_pilot_photons(
             plan.scene, {stage, kPhotons}, threads,
             [&](RayCaster& caster) { return LightTracer(plan, caster, 1); }, trace_batch))
      for (const auto& [start, exposure] : batch)
        if (start.cell >= 0 && std::isfinite(exposure))
          importance[start.light][static_cast<std::size_t>(start.cell)] += exposure;
    for (std::size_t light = 0; light < aims.size(); ++light) aims[light].learn(importance[light], reach);
  }
}

}  // namespace abbe
