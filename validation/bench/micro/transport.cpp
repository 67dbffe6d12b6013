#include <benchmark/benchmark.h>

#include "transport/technique/path.h"
#include "validation/bench/suite.h"

namespace abbe {
namespace {

void sampler_group(benchmark::State& state) {
  std::uint32_t i = 0;
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(Sampler(1, Purpose::camera, 0, i / 64, i % 64).group(i % 8));
  }
}
BENCHMARK(sampler_group);

// Complete camera paths in the Cornell box, in batches of 256.
void camera_paths(benchmark::State& state) {
  const Scene scene = load_suite(choose_suites({"cornell"}).front(), "", false);
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  PathTracer tracer(plan, caster);
  const auto width = static_cast<std::uint32_t>(scene.camera.width);
  std::uint32_t i = 0;
  std::vector<PixelSample> samples;
  for (auto _ : state) {
    samples.clear();
    for (int together = 0; together < 256; ++together) {
      const std::uint32_t pixel = (i++ * 2654435761U) % (width * width);
      samples.push_back({static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                         Sampler(1, Purpose::camera, 0, pixel, 0)});
    }
    tracer.trace(samples, [](std::uint32_t, const FilmPoint&, std::span<const double>) {});
  }
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(caster.rays()), benchmark::Counter::kIsRate);
}
BENCHMARK(camera_paths);

}  // namespace
}  // namespace abbe
