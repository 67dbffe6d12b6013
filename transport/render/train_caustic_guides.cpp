#include "transport/render/train_caustic_guides.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "transport/plan/plan.h"
#include "transport/render/pilot_photons.h"
#include "transport/render/train_photon_guides.h"
#include "transport/technique/caustic_photons.h"

namespace abbe {
namespace {

using CausticHits = std::vector<CausticPhotonTracer::TracedPhoton>;

// Photons of each batch that reached a scattering surface after specular events only.
std::vector<CausticHits> trace_photons(const Plan& plan, const Emissions& emissions,
                                       const PilotPhotons& pilots, int threads) {
  return trace_pilot_photons(
      plan.scene, pilots, threads,
      [&](RayCaster& caster) { return CausticPhotonTracer(plan, caster, emissions.sensor_emissions); },
      [](CausticPhotonTracer& tracer, std::span<const Sampler> photons) {
        const auto hits = tracer.trace(photons);
        return CausticHits(hits.begin(), hits.end());
      });
}

void train_on_hits(Plan& plan, const std::vector<CausticHits>& hits) {
  std::vector<PilotStart> starts;
  for (const CausticHits& batch : hits)
    for (const CausticPhotonTracer::TracedPhoton& hit : batch) starts.push_back({hit.start, 1});
  train_photon_guides_from(starts, plan);
}

std::size_t hit_count(const std::vector<CausticHits>& hits) {
  std::size_t sum = 0;
  for (const CausticHits& batch : hits) sum += batch.size();
  return sum;
}

// True if the camera sees a specular surface, on a grid of rays through the film.
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

// Flags the lights that camera paths may hit through specular surfaces and that photons do not cover. If
// photons trace a light, this is so where the camera sees it through specular surfaces, or for a probe.
std::vector<bool> caustic_lights(const Plan& plan) {
  const Scene& scene = plan.scene;
  const bool sees_through_specular = is_probe(scene.camera) || sees_specular(scene);
  std::vector<bool> selected;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    selected.push_back(!scene.lights[i].is_delta() && !scene.lights[i].is_environment() &&
                       scene.lights[i].emission.max() > 0 && (sees_through_specular || !plan.traced[i]));
  return selected;
}

}  // namespace

void train_caustic_guides(Plan& plan, int threads) {
  // The first photons train the guides of the second ones. If fewer than `kMinHits` arrive, the second ones
  // would not pay off.
  constexpr PilotPhotons kFirst{PilotStage::caustic_photon_guides, 1U << 16};
  constexpr std::size_t kMinHits = 8;
  constexpr PilotPhotons kSecond{PilotStage::caustics, 1U << 20, 1U << 15};
  if (!plan.scene.features.caustics || !uses(plan.techniques, Technique::path)) return;
  const std::vector<bool> lights = caustic_lights(plan);
  if (std::ranges::find(lights, true) == lights.end()) return;
  const Emissions emissions = emissions_of(plan.scene);
  std::optional<Plan> photons = make_photon_plan(plan.scene, emissions, lights);
  if (!photons) return;
  const std::vector<CausticHits> first = trace_photons(*photons, emissions, kFirst, threads);
  if (hit_count(first) < kMinHits) return;
  train_on_hits(*photons, first);
  const std::vector<CausticHits> hits = trace_photons(*photons, emissions, kSecond, threads);
  std::vector<CausticPhoton> untraced_light_photons;
  std::vector<CausticPhoton> all;
  for (const CausticHits& batch : hits)
    for (const auto& [start, photon] : batch) {
      all.push_back(photon);
      all.back().power /= static_cast<float>(hits.size() * kPilotPhotonBatch);
      if (!plan.traced[start.light]) untraced_light_photons.push_back(all.back());
    }
  plan.guides.path_caustics = CausticGuide(std::move(untraced_light_photons), plan.scene.bounds);
  plan.guides.caustics_through_specular = CausticGuide(std::move(all), plan.scene.bounds);
}

}  // namespace abbe
