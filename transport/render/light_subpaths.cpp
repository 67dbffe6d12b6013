#include "transport/render/light_subpaths.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "scene/polarisation_cause.h"
#include "transport/render/threads.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

// Calls `batch(tracer, first, last)` for all light subpaths, on `threads` threads. Each thread has its own
// ray caster and `Tracer`.
template <typename Tracer, typename Batch>
void trace_all(const Plan& plan, int threads, PassCounts& counts, const Batch& batch) {
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    Tracer tracer(plan, caster);
    for (std::uint64_t first = kBatchSize * next++; first < plan.photons; first = kBatchSize * next++)
      batch(tracer, first, std::min(first + kBatchSize, plan.photons));
    const std::scoped_lock lock(mutex);
    counts.rays += caster.rays();
    counts.cut += caster.truncated();
  });
  counts.paths += plan.photons;
}

// Records light subpaths with all their vertices.
class LightRecorder {
 public:
  LightRecorder(const Plan& plan, RayCaster& caster)
      : plan_(plan), caster_(caster), recorder_(plan.scene, caster) {}

  std::vector<RecordedPath>& record(const std::vector<Sampler>& samplers, const PathPacket& packet,
                                    float time) {
    recorder_.paths().clear();
    for (std::uint32_t i = 0; i < samplers.size(); ++i) {
      RecordedPath& path = recorder_.paths().emplace_back(samplers[i], i);
      path.packet = packet;
      start_from_light(plan_, caster_, time, path);
    }
    recorder_.run();
    return recorder_.paths();
  }

 private:
  const Plan& plan_;
  RayCaster& caster_;
  PathRecorder<TransportMode::power> recorder_;
};

std::vector<Sampler> samplers_of(const LightPathSampler& samplers, std::uint64_t first, std::uint64_t last) {
  std::vector<Sampler> batch_samplers;
  for (std::uint64_t path = first; path < last; ++path) batch_samplers.push_back(samplers(path));
  return batch_samplers;
}

}  // namespace

std::size_t bytes_of_light_paths(const Scene& scene) {
  constexpr std::size_t kTypicalVertices = 4;
  const std::vector<Technique> techniques = chosen_techniques(scene);
  const std::size_t paths = photons_of_sample(scene);
  const std::size_t polarisation_bytes = carries_polarisation(scene) ? sizeof(Polarisation) : 0;
  if (uses(techniques, Technique::vcm))
    return paths * (LightSubpaths::kBytesOfPath +
                    kTypicalVertices * (LightSubpaths::kBytesOfVertex + polarisation_bytes));
  if (std::any_of(techniques.begin(), techniques.end(), gathers_photons))
    return paths * kTypicalVertices * (sizeof(Photon) + PhotonMap::kBytesOfPoint + polarisation_bytes);
  return 0;
}

PhotonCloud trace_photon_cloud(const Plan& plan, const PathPacket& packet, float time,
                               const LightPathSampler& samplers, int threads, PassCounts& counts) {
  std::vector<std::vector<Photon>> batches((plan.photons + kBatchSize - 1) / kBatchSize);
  trace_all<PhotonTracer>(
      plan, threads, counts, [&](PhotonTracer& tracer, std::uint64_t first, std::uint64_t last) {
        tracer.trace(samplers_of(samplers, first, last), packet, time, batches[first / kBatchSize]);
      });
  std::vector<Photon> photons;  // in the order of their subpaths, for any number of threads
  for (const std::vector<Photon>& batch : batches) photons.insert(photons.end(), batch.begin(), batch.end());
  return {std::move(photons), plan.photons, packet, time};
}

void trace_light_subpaths(const Plan& plan, const PathPacket& packet, float time, float radius,
                          const LightPathSampler& samplers, int threads, LightSubpaths& light_paths,
                          PassCounts& counts) {
  light_paths.begin(plan.photons, packet, time);
  trace_all<LightRecorder>(
      plan, threads, counts, [&](LightRecorder& recorder, std::uint64_t first, std::uint64_t last) {
        light_paths.store(first / kBatchSize,
                          recorder.record(samplers_of(samplers, first, last), packet, time));
      });
  light_paths.finish(radius);
}

}  // namespace abbe
