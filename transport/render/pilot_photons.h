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

/// Purpose of pilot photons. Each stage has random numbers of its own.
enum class PilotStage : std::uint32_t {
  coarse_guides,          ///< Photon guides, first round, with unguided photons.
  photon_guides,          ///< Photon guides, second round, with guided photons.
  wavelengths,            ///< Distribution of the photons' wavelengths.
  caustic_photon_guides,  ///< Guides for the photons of `caustics`.
  caustics,               ///< Caustic guides of camera paths.
  probe_guides            ///< Photon guides to a small probe, through balls around it.
};

/// Number of pilot photons that a thread traces together.
inline constexpr std::uint32_t kPilotPhotonBatch = 1U << 9;

/// Maximum number of rays that the photons of a stage may cast. It limits the cost of media in which photons
/// scatter thousands of times.
inline constexpr std::uint64_t kMaxPilotRays = 1U << 23;

/// Photons of a stage, and the limits at which their tracing stops early, after a whole group of batches.
struct PilotPhotons {
  PilotStage stage;
  std::uint32_t max_photons;  ///< Maximum number of photons; a multiple of `kPilotPhotonBatch`.
  /// Number of results that suffices.
  std::size_t sufficient_results = std::numeric_limits<std::size_t>::max();
  std::uint32_t first = 0;                 ///< Index of the first photon, which selects its random numbers.
  std::uint64_t max_rays = kMaxPilotRays;  ///< Number of rays that ends tracing.
};

/// Returns a vector with the result of `trace(tracer, photons)` for each batch of photons, in the order of
/// the batches. `photons` are the samplers of the batch. Each thread uses its own tracer,
/// `make_tracer(caster)`, and calls both functions concurrently with the others. The `size()` of a result
/// counts towards `sufficient_results`. The random numbers are the same for all scenes and seeds. Neither the
/// results nor their number depend on `threads`, which is at least 1. Rethrows an exception of a thread.
template <typename MakeTracer, typename Trace>
[[nodiscard]] auto trace_pilot_photons(const Scene& scene, const PilotPhotons& pilots, int threads,
                                       MakeTracer make_tracer, Trace trace) {
  using Tracer = std::invoke_result_t<MakeTracer, RayCaster&>;
  using BatchResult = std::invoke_result_t<Trace, Tracer&, std::span<const Sampler>>;
  constexpr std::uint64_t kSeed = 0;
  constexpr std::size_t kMinBatches = 4;
  constexpr std::size_t kMaxBatches = 32;
  const auto stage = static_cast<std::uint32_t>(pilots.stage);
  const std::size_t max_batches = pilots.max_photons / kPilotPhotonBatch;
  std::vector<BatchResult> batches;
  std::size_t results = 0;
  std::atomic<std::uint64_t> rays = 0;
  while (batches.size() < max_batches && results < pilots.sufficient_results && rays < pilots.max_rays) {
    const std::size_t first = batches.size();
    batches.resize(std::min(first + std::clamp(first, kMinBatches, kMaxBatches), max_batches));
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
    for (std::size_t i = first; i < batches.size(); ++i) results += batches[i].size();
  }
  return batches;
}

}  // namespace abbe
