#include "transport/render/cost.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <time.h>

#include "transport/technique/bidirectional.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

double cpu_seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Traces paths spread evenly over the film, and as many photons.
void trace_some(const Plan& plan, RayCaster& caster) {
  constexpr std::uint32_t kPaths = 1U << 15;
  constexpr std::uint32_t kTogether = 256;
  const Scene& scene = plan.scene;
  const auto width = static_cast<std::uint32_t>(scene.camera.width);
  const std::uint32_t pixels = width * static_cast<std::uint32_t>(scene.camera.height);
  PathTracer path_tracer(plan, caster);
  LightTracer light_tracer(plan, caster, 1);
  BidirectionalTracer bidirectional_tracer(plan, caster);
  const Deposit dropped = [](std::uint32_t, const FilmPoint&, std::span<const double>) {};
  std::vector<PixelSample> samples;
  std::vector<Sampler> photons;
  std::vector<PixelPair> pairs;
  for (std::uint32_t first = 0; first < kPaths; first += kTogether) {
    samples.clear();
    photons.clear();
    pairs.clear();
    for (std::uint32_t i = first; i < first + kTogether; ++i) {
      const auto pixel = static_cast<std::uint32_t>(std::uint64_t{i} * pixels / kPaths);
      samples.push_back({static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                         Sampler(scene.render.seed, Purpose::camera, 0, pixel, i / pixels)});
      photons.emplace_back(scene.render.seed, Purpose::light, 0, 0, i);
      pairs.push_back({samples.back().x, samples.back().y, samples.back().sampler, photons.back(), true});
    }
    if (uses(plan.techniques, Technique::path)) path_tracer.trace(samples, dropped);
    if (uses(plan.techniques, Technique::light)) light_tracer.trace(photons, dropped);
    if (!uses(plan.techniques, Technique::path) && !uses(plan.techniques, Technique::light))
      bidirectional_tracer.trace(pairs, dropped);
  }
}

}  // namespace

double thread_cpu_seconds() {
  return cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
}
double process_cpu_seconds() {
  return cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

double measure_replay_fraction(const Plan& plan) {
  std::vector<LoggedRay> log;
  RayCaster logging(plan.scene, &log);
  trace_some(plan, logging);
  double tracing = std::numeric_limits<double>::infinity();
  double replaying = tracing;
  for (int repeat = 0; repeat < 3; ++repeat) {
    RayCaster plain(plan.scene);
    const double t0 = thread_cpu_seconds();
    trace_some(plan, plain);
    const double t1 = thread_cpu_seconds();
    plan.scene.replay(log);
    const double t2 = thread_cpu_seconds();
    tracing = std::min(tracing, t1 - t0);
    replaying = std::min(replaying, t2 - t1);
  }
  return replaying / tracing;
}

}  // namespace abbe
