#include "transport/render/learn_aims.h"

#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/render/learn_caustics.h"
#include "transport/render/learn_wavelengths.h"
#include "transport/render/threads.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// A photon that shows where to aim others, by what it adds to the film.
struct Pilot {
  PhotonStart start;
  double exposure = 0;  // the sum of |film value|
};

// Those from `first` on, as many as `pilots`.
void trace_batch(LightTracer& tracer, std::uint64_t seed, std::uint32_t stage, std::uint32_t first,
                 std::span<Pilot> pilots) {
  std::vector<Sampler> photons;
  for (std::uint32_t i = 0; i < pilots.size(); ++i)
    photons.emplace_back(seed, Purpose::pilot, stage, 0, first + i);
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double> values) {
    for (const double v : values) pilots[photon].exposure += std::abs(v);
  });
  for (std::size_t i = 0; i < pilots.size(); ++i) pilots[i].start = tracer.starts()[i];
}

std::vector<Pilot> trace_pilots(const Plan& plan, std::uint64_t seed, std::uint32_t stage, int threads) {
  constexpr std::uint32_t kPhotons = 1U << 17;
  constexpr std::uint32_t kLearningBatch = 1U << 9;
  std::vector<Pilot> pilots(kPhotons);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    LightTracer tracer(plan, caster, 1);
    for (std::uint32_t first = kLearningBatch * next++; first < kPhotons; first = kLearningBatch * next++)
      trace_batch(tracer, seed, stage, first, std::span(pilots).subspan(first, kLearningBatch));
  });
  return pilots;
}

void learn_aims(Plan& plan, std::uint64_t seed, int threads) {
  // First where light passes at all, then, from photons aimed there, how much of it.
  constexpr std::array<int, 2> kReaches{4, 1};
  if (plan.traced_lights.empty()) return;
  for (std::uint32_t stage = 0; stage < kReaches.size(); ++stage) {
    std::vector<std::vector<double>> importance;
    for (const Aim& aim : plan.aims) importance.push_back(aim.no_importance());
    // Added up in the order of the photons, whichever threads traced them.
    for (const auto& [start, exposure] : trace_pilots(plan, seed, stage, threads))
      if (start.cell >= 0 && std::isfinite(exposure))
        importance[start.light][static_cast<std::size_t>(start.cell)] += exposure;
    for (std::size_t light = 0; light < plan.aims.size(); ++light)
      plan.aims[light].learn(importance[light], kReaches[stage]);
  }
}

}  // namespace

Plan make_learnt_plan(const Scene& scene, int threads, std::uint64_t seed) {
  Plan plan = make_plan(scene);
  if (plan.techniques.size() > 1) {
    learn_aims(plan, seed, threads);
    learn_wavelengths(plan, seed, threads);
  }
  learn_caustics(plan, seed, threads);
  return plan;
}

}  // namespace abbe
