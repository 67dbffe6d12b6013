#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "sampling/sampler.h"
#include "scene/scene.h"
#include "sensor/film/film.h"
#include "transport/path/film_response.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/render/render.h"
#include "transport/render/threads.h"

namespace abbe {

/// Seed of the random numbers of pilots. Scene files cannot have so large a seed.
inline constexpr std::uint64_t kPilotSeed = std::uint64_t{1} << 63;

/// Magnitude of film values for pilots: the sum of their absolute values over the channels, 0 if one is not
/// finite.
[[nodiscard]] inline double magnitude(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return std::isfinite(sum) ? sum : 0;
}

/// Number of rays that pilots may cast to choose how a film is rendered: 64 per pixel, about as many as path
/// tracing casts in ten samples. The samples of the render do not count, because parts of one film may state
/// different ones.
[[nodiscard]] inline double pilot_ray_budget(const Camera& camera) {
  return 64.0 * camera.width * camera.height;
}

/// Column and row of the pixel of a pilot path: element `pilot` of a sequence that covers the whole film
/// evenly. Each value of `stream` selects another sequence.
[[nodiscard]] std::pair<int, int> pilot_pixel(const Camera& camera, std::uint32_t stream,
                                              std::uint32_t pilot);

/// Noise of a pixel as pilots estimate it.
struct PixelNoise {
  double mean = 0;      ///< Mean of the paths' values.
  double variance = 0;  ///< Variance of the value of one path.
};

/// Mean and variance of one path from the values of a pixel's paths. Each replicate has `paths_per_replicate`
/// consecutive values; the variance follows from the scatter of the replicates. There must be two replicates
/// or more, all of equal size.
[[nodiscard]] PixelNoise estimate_pixel_noise(std::span<const double> values,
                                              std::size_t paths_per_replicate);

/// A film of one replicate and few samples per pixel, which depends on the plan alone. It has about 65536
/// paths, at least one and at most 16 per pixel, and as many photons if the plan traces photons. No render
/// uses its random numbers, so choices that follow from it are independent of the samples of the render. The
/// film has the crop `crop`. Empty if `stop` returned true before the film was finished; any thread may call
/// `stop`. `threads` is at least 1. Throws as `Pass::run`.
[[nodiscard]] std::optional<Film> pilot_film(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// A film of eight replicates and at most 65536 camera paths and photons, with which `hidden_noise` compares
/// a small film. No render uses its random numbers. Empty for films of more than 8192 pixels or photons per
/// sample, and if `stop` returned true before the film was finished. Arguments and errors are as for
/// `pilot_film`.
[[nodiscard]] std::optional<Film> noise_pilot(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// Adds to `sums.exposure` what each group of lights contributes to the whole film in a sample. All members
/// of `sums` must be set, with `exposure` of one element per group. The estimate uses 16384 camera paths, and
/// as many photons if the plan traces photons, for any number of pixels. It does not depend on `threads`.
/// Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
void pilot_exposures(const Plan& plan, int threads, ExposureByLight& sums);

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

/// Time that Embree alone takes for a render's rays, divided by the time to trace their paths. Some paths are
/// traced with their rays logged: path and light tracing as in the plan, bidirectional paths for all other
/// techniques. Then the rays are replayed. Each time is CPU time of the calling thread, the shortest of
/// three.
[[nodiscard]] double measure_replay_fraction(const Plan& plan);

}  // namespace abbe
