#include "transport/render/learn_caustics.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "sampling/sampler.h"
#include "transport/plan/emissions.h"
#include "transport/render/threads.h"
#include "transport/technique/caustic_photons.h"

namespace abbe {
namespace {

// The random numbers of photons, and how many: so many batches.
struct Sampling {
  std::uint64_t seed;
  std::uint32_t stage;
  std::uint32_t batches;
};

using Arrivals = std::vector<CausticPhotonTracer::Arrival>;

constexpr std::uint32_t kLearningBatch = 1U << 9;
constexpr std::uint32_t kAimStage = 3;  // of photons that aim others, which have the stages after it

// So many batches of photons, in the order of these, whichever threads traced them.
std::vector<Arrivals> trace_photons(const Plan& plan, const Emissions& emissions, const Sampling& sampling,
                                    int threads) {
  std::vector<Arrivals> arrived(sampling.batches);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    CausticPhotonTracer tracer(plan, caster, emissions.seen);
    std::vector<Sampler> photons;
    for (std::uint32_t batch = next++; batch < sampling.batches; batch = next++) {
      photons.clear();
      for (std::uint32_t i = 0; i < kLearningBatch; ++i)
        photons.emplace_back(sampling.seed, Purpose::pilot, sampling.stage, 0, batch * kLearningBatch + i);
      const auto some = tracer.trace(photons);
      arrived[batch].assign(some.begin(), some.end());
    }
  });
  return arrived;
}

// Aims photons at where others have come through.
void learn_aims(Plan& plan, const std::vector<Arrivals>& arrived) {
  constexpr int kReach = 2;  // cells
  std::vector<std::vector<double>> importance;
  for (const Aim& aim : plan.aims) importance.push_back(aim.no_importance());
  for (const Arrivals& batch : arrived)
    for (const auto& [start, photon] : batch)
      if (start.cell >= 0) importance[start.light][static_cast<std::size_t>(start.cell)] += 1;
  for (std::size_t light = 0; light < plan.aims.size(); ++light)
    plan.aims[light].learn(importance[light], kReach);
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
// of a traced one, where the camera sees it through such matter.
std::vector<bool> lights_to_find(const Plan& plan) {
  const Scene& scene = plan.scene;
  const bool through = !is_meter(scene.camera) && sees_specular(scene);
  std::vector<bool> found;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    found.push_back(scene.lights[i].is<AreaLight, SunLight>() && scene.lights[i].emission.max() > 0 &&
                    (through || !plan.traced[i]));
  return found;
}

}  // namespace

void learn_caustics(Plan& plan, std::uint64_t seed, int threads) {
  constexpr std::size_t kTooFew = 8;         // of the first photons: so rare are none worth more
  constexpr std::size_t kEnough = 1U << 15;  // that arrive; else up to so many rounds are traced
  constexpr std::uint32_t kRounds = 8;
  if (!plan.scene.needs.caustics || !uses(plan.techniques, Technique::path)) return;
  const std::vector<bool> lights = lights_to_find(plan);
  if (std::ranges::find(lights, true) == lights.end()) return;
  const Emissions emissions = emissions_of(plan.scene);
  std::optional<Plan> photons = make_photon_plan(plan.scene, emissions, lights);
  if (!photons) return;
  const std::vector<Arrivals> first = trace_photons(*photons, emissions, {seed, kAimStage, 1U << 7}, threads);
  if (count(first) < kTooFew) return;
  learn_aims(*photons, first);
  std::vector<Arrivals> arrived;
  for (std::uint32_t round = 0; round < kRounds && count(arrived) < kEnough; ++round)
    for (Arrivals& batch :
         trace_photons(*photons, emissions, {seed, kAimStage + 1 + round, 1U << 8}, threads))
      arrived.push_back(std::move(batch));
  std::vector<CausticPhoton> of_paths;
  std::vector<CausticPhoton> all;
  for (const Arrivals& batch : arrived)
    for (const auto& [start, photon] : batch) {
      all.push_back(photon);
      all.back().power /= static_cast<float>(arrived.size() * kLearningBatch);
      if (!plan.traced[start.light]) of_paths.push_back(all.back());
    }
  plan.caustics_of_paths = CausticGuide(std::move(of_paths), plan.scene.bounds);
  plan.caustics_seen_through = CausticGuide(std::move(all), plan.scene.bounds);
}

}  // namespace abbe
