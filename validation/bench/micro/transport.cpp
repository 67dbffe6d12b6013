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

// Whole camera paths through the Cornell box.
void camera_path(benchmark::State& state) {
  const Scene scene = load_suite(choose_suites({"cornell"}).front(), "", false);
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  PathExposure exposure = exposure_of(scene);
  const auto width = static_cast<std::uint32_t>(scene.camera.width);
  std::uint32_t i = 0;
  for (auto _ : state) {
    const std::uint32_t pixel = (i++ * 2654435761U) % (width * width);
    trace_camera_path(plan, caster, Sampler(1, Purpose::camera, 0, pixel, 0), static_cast<int>(pixel % width),
                      static_cast<int>(pixel / width), exposure);
  }
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(caster.rays()), benchmark::Counter::kIsRate);
}
BENCHMARK(camera_path);

}  // namespace
}  // namespace abbe
