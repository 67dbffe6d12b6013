#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "sampling/sampler.h"
#include "scene/scene.h"
#include "transport/path/ray_caster.h"
#include "transport/render/threads.h"

namespace abbe {

/// What photons of pilots are for, each with random numbers of its own.
enum class PilotStage : std::uint32_t { first_aims, aims, wavelengths, caustic_aims, caustics };

inline constexpr std::uint32_t kPilotPhotonBatch = 1U << 9;

/// Those photons of a stage, in multiples of `kPilotPhotonBatch`.
struct PilotPhotons {
  PilotStage stage;
  std::uint32_t count;
  std::uint32_t first = 0;
};

/// What `trace(tracer, photons)` returns of each batch of photons, in their order whichever threads traced
/// them, each thread by a tracer `make_tracer(caster)` of its own. The random numbers are the same for all
/// scenes and seeds.
template <typename MakeTracer, typename Trace>
[[nodiscard]] auto trace_pilot_photons(const Scene& scene, const PilotPhotons& pilots, int threads,
                                       MakeTracer make_tracer, Trace trace) {
  using Tracer = std::invoke_result_t<MakeTracer, RayCaster&>;
  using Found = std::invoke_result_t<Trace, Tracer&, std::span<const Sampler>>;
  constexpr std::uint64_t kSeed = 0;
  const auto stage = static_cast<std::uint32_t>(pilots.stage);
  std::vector<Found> batches(pilots.count / kPilotPhotonBatch);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(scene);
    Tracer tracer = make_tracer(caster);
    std::vector<Sampler> photons;
    for (std::uint32_t batch = next++; batch < batches.size(); batch = next++) {
      photons.clear();
      for (std::uint32_t i = 0; i < kPilotPhotonBatch; ++i)
        photons.emplace_back(kSeed, Purpose::pilot, stage, 0, pilots.first + batch * kPilotPhotonBatch + i);
      batches[batch] = trace(tracer, std::span<const Sampler>(photons));
    }
  });
  return batches;
}

}  // namespace abbe
