#include "transport/render/collect.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "scene/polarisation_need.h"
#include "transport/render/threads.h"
#include "transport/technique/subpaths.h"

namespace abbe {
namespace {

// Calls `batch(caster, first, last)` for all paths, on that many threads, with a caster and a `Tracer` of
// each.
template <typename Tracer, typename Batch>
void trace_all(const Plan& plan, int threads, PassCounts& counts, const Batch& batch) {
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    Tracer tracer(plan, caster);
    for (std::uint64_t first = kPathsTogether * next++; first < plan.photons; first = kPathsTogether * next++)
      batch(tracer, first, std::min(first + kPathsTogether, plan.photons));
    const std::scoped_lock lock(mutex);
    counts.rays += caster.rays();
    counts.cut += caster.cut();
  });
  counts.paths += plan.photons;
}

// Records whole paths from lights.
class LightRecorder {
 public:
  LightRecorder(const Plan& plan, RayCaster& caster)
      : plan_(plan), caster_(caster), recorder_(plan.scene, caster) {}

  std::vector<RecordedPath>& record(const std::vector<Sampler>& numbers, const PathPacket& packet,
                                    float time) {
    recorder_.paths().clear();
    for (std::uint32_t i = 0; i < numbers.size(); ++i) {
      RecordedPath& path = recorder_.paths().emplace_back(numbers[i], i);
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

std::vector<Sampler> numbers_of(const LightNumbers& numbers, std::uint64_t first, std::uint64_t last) {
  std::vector<Sampler> of;
  for (std::uint64_t path = first; path < last; ++path) of.push_back(numbers(path));
  return of;
}

}  // namespace

std::size_t bytes_of_light_paths(const Scene& scene) {
  constexpr std::size_t kUsualPlaces = 4;
  const std::vector<Technique> techniques = chosen_techniques(scene);
  const std::size_t paths = photons_of_sample(scene);
  const std::size_t carried = carries_polarisation(scene) ? sizeof(Polarisation) : 0;
  if (uses(techniques, Technique::vcm))
    return paths * (LightPaths::kBytesOfPath + kUsualPlaces * (LightPaths::kBytesOfVertex + carried));
  if (std::any_of(techniques.begin(), techniques.end(), gathers_photons))
    return paths * kUsualPlaces * (sizeof(Photon) + PhotonMap::kBytesOfPoint + carried);
  return 0;
}

PhotonCloud collect_photons(const Plan& plan, const PathPacket& packet, float time,
                            const LightNumbers& numbers, int threads, PassCounts& counts) {
  std::vector<std::vector<Photon>> batches((plan.photons + kPathsTogether - 1) / kPathsTogether);
  trace_all<PhotonTracer>(
      plan, threads, counts, [&](PhotonTracer& tracer, std::uint64_t first, std::uint64_t last) {
        tracer.trace(numbers_of(numbers, first, last), packet, time, batches[first / kPathsTogether]);
      });
  std::vector<Photon> photons;  // in the order of their paths, whichever threads traced them
  for (const std::vector<Photon>& batch : batches) photons.insert(photons.end(), batch.begin(), batch.end());
  return {std::move(photons), plan.photons, packet, time};
}

void collect_light_paths(const Plan& plan, const PathPacket& packet, float time, float radius,
                         const LightNumbers& numbers, int threads, LightPaths& kept, PassCounts& counts) {
  kept.begin(plan.photons, packet, time);
  trace_all<LightRecorder>(
      plan, threads, counts, [&](LightRecorder& recorder, std::uint64_t first, std::uint64_t last) {
        kept.keep(first / kPathsTogether, recorder.record(numbers_of(numbers, first, last), packet, time));
      });
  kept.end(radius);
}

}  // namespace abbe
