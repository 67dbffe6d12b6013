#include "transport/render/learn_caustics.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "transport/plan/emissions.h"
#include "transport/render/learn_aims.h"
#include "transport/render/pilot_photons.h"
#include "transport/technique/caustic_photons.h"

namespace abbe {
namespace {

using Arrivals = std::vector<CausticPhotonTracer::Arrival>;

// Of each batch of those photons.
std::vector<Arrivals> trace_photons(const Plan& plan, const Emissions& emissions, const PilotPhotons& pilots,
                                    int threads) {
  return trace_pilot_photons(
      plan.scene, pilots, threads,
      [&](RayCaster& caster) { return CausticPhotonTracer(plan, caster, emissions.seen); },
      [](CausticPhotonTracer& tracer, std::span<const Sampler> photons) {
        const auto arrived = tracer.trace(photons);
        return Arrivals(arrived.begin(), arrived.end());
      });
}

void aim_where_others_arrived(Plan& plan, const std::vector<Arrivals>& arrived) {
  std::vector<ShownStart> shown;
  for (const Arrivals& batch : arrived)
    for (const CausticPhotonTracer::Arrival& arrival : batch) shown.push_back({arrival.start, 1});
  aim_where(shown, plan);
}

std::size_t count(const std::vector<Arrivals>& arrived) {
  std::size_t sum = 0;
  for (const Arrivals& batch : arrived) sum += batch.size();
  return sum;
}

// Whether what the camera sees first is specular anywhere: of a grid of rays through the film.
bool sees_specular(const Scene& scene) {
  constexpr int kGrid = 64;
  const SampledSpectrum any(550.0F);
  const Imath::V2f cell(static_cast<float>(scene.camera.width) / kGrid,
                        static_cast<float>(scene.camera.height) / kGrid);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int row = i / kGrid;
    const int column = i % kGrid;
    const Imath::V2f film(cell.x * (static_cast<float>(column) + 0.5F),
                          cell.y * (static_cast<float>(row) + 0.5F));
    const auto hit = scene.intersect(sample_ray(scene.camera, film, {0.5F, 0.5F}, any, 0, 0).ray);
    if (hit && lobes(scene.materials[scene.shapes[hit->shape].material]).delta) return true;
  }
  return false;
}

// Per light, whether camera paths may meet it through specular matter where photons do not bring its light:
// of a traced one, where the camera sees it through such matter, or surfaces scatter it to a meter.
std::vector<bool> lights_to_find(const Plan& plan) {
  const Scene& scene = plan.scene;
  const bool through = is_meter(scene.camera) || sees_specular(scene);
  std::vector<bool> found;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    found.push_back(scene.lights[i].is<AreaLight, SunLight>() && scene.lights[i].emission.max() > 0 &&
                    (through || !plan.traced[i]));
  return found;
}

}  // namespace

void learn_caustics(Plan& plan, int threads) {
  // The first photons aim the others, and where so few of them arrive none are worth more.
  constexpr PilotPhotons kFirst{PilotStage::caustic_aims, 1U << 16};
  constexpr std::size_t kTooFew = 8;
  constexpr PilotPhotons kOthers{PilotStage::caustics, 1U << 20, 1U << 15};
  if (!plan.scene.needs.caustics || !uses(plan.techniques, Technique::path)) return;
  const std::vector<bool> lights = lights_to_find(plan);
  if (std::ranges::find(lights, true) == lights.end()) return;
  const Emissions emissions = emissions_of(plan.scene);
  std::optional<Plan> photons = make_photon_plan(plan.scene, emissions, lights);
  if (!photons) return;
  const std::vector<Arrivals> first = trace_photons(*photons, emissions, kFirst, threads);
  if (count(first) < kTooFew) return;
  aim_where_others_arrived(*photons, first);
  const std::vector<Arrivals> arrived = trace_photons(*photons, emissions, kOthers, threads);
  std::vector<CausticPhoton> of_paths;
  std::vector<CausticPhoton> all;
  for (const Arrivals& batch : arrived)
    for (const auto& [start, photon] : batch) {
      all.push_back(photon);
      all.back().power /= static_cast<float>(arrived.size() * kPilotPhotonBatch);
      if (!plan.traced[start.light]) of_paths.push_back(all.back());
    }
  plan.guides.caustics_of_paths = CausticGuide(std::move(of_paths), plan.scene.bounds);
  plan.guides.caustics_seen_through = CausticGuide(std::move(all), plan.scene.bounds);
}

}  // namespace abbe
