#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "sampling/sampler.h"
#include "scene/scene.h"
#include "transport/path/ray_caster.h"
#include "transport/render/threads.h"

namespace abbe {

/// What photons of pilots are for, each with random numbers of its own.
enum class PilotStage : std::uint32_t { first_aims, aims, wavelengths, caustic_aims, caustics, meter_aims };

inline constexpr std::uint32_t kPilotPhotonBatch = 1U << 9;

/// As many rays as photons of a stage may cast, so that matter that holds light for thousands of events costs
/// no more than any other.
inline constexpr std::uint64_t kMostPilotRays = 1U << 23;

/// The photons of a stage: at most so many from the one of that number on, both in multiples of
/// `kPilotPhotonBatch`, and no more once enough has been found or so many rays were cast.
struct PilotPhotons {
  PilotStage stage;
  std::uint32_t most;
  std::size_t enough = std::numeric_limits<std::size_t>::max();
  std::uint32_t first = 0;
  std::uint64_t most_rays = kMostPilotRays;
};

/// What `trace(tracer, photons)` returns of each batch of photons, in their order whichever threads traced
/// them, each thread by a tracer `make_tracer(caster)` of its own; its `size()` is how much has been found.
/// The random numbers are the same for all scenes and seeds, and so is when no more are traced for any number
/// of threads.
template <typename MakeTracer, typename Trace>
[[nodiscard]] auto trace_pilot_photons(const Scene& scene, const PilotPhotons& pilots, int threads,
                                       MakeTracer make_tracer, Trace trace) {
  using Tracer = std::invoke_result_t<MakeTracer, RayCaster&>;
  using Found = std::invoke_result_t<Trace, Tracer&, std::span<const Sampler>>;
  constexpr std::uint64_t kSeed = 0;
  constexpr std::size_t kFewestAtATime = 4;
  constexpr std::size_t kMostAtATime = 32;
  const auto stage = static_cast<std::uint32_t>(pilots.stage);
  const std::size_t most = pilots.most / kPilotPhotonBatch;
  std::vector<Found> batches;
  std::size_t found = 0;
  std::atomic<std::uint64_t> rays = 0;
  while (batches.size() < most && found < pilots.enough && rays < pilots.most_rays) {
    const std::size_t first = batches.size();
    batches.resize(std::min(first + std::clamp(first, kFewestAtATime, kMostAtATime), most));
    std::atomic<std::size_t> next = first;
    run_on_threads(threads, [&] {
      RayCaster caster(scene);
      Tracer tracer = make_tracer(caster);
      std::vector<Sampler> photons;
      for (std::size_t batch = next++; batch < batches.size(); batch = next++) {
        photons.clear();
        for (std::uint32_t i = 0; i < kPilotPhotonBatch; ++i)
          photons.emplace_back(kSeed, Purpose::pilot, stage, 0,
                               pilots.first + static_cast<std::uint32_t>(batch) * kPilotPhotonBatch + i);
        batches[batch] = trace(tracer, std::span<const Sampler>(photons));
      }
      rays += caster.rays();
    });
    for (std::size_t i = first; i < batches.size(); ++i) found += batches[i].size();
  }
  return batches;
}

}  // namespace abbe
