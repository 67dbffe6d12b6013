#include <benchmark/benchmark.h>

#include "description/lens_files.h"
#include "lens/beam.h"
#include "lens/spectral_system.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

lens::SpectralSystem double_gauss() {
  Diagnostics diagnostics;
  lens::System lens = load_lens("double_gauss", diagnostics).value();
  const double stop_radius = lens::stop_radius(lens);
  return {std::move(lens), stop_radius};
}

// Rays parallel to the axis in front of the first surface.
lens::Ray next_ray(const lens::SpectralSystem& system, micro::NumberCycle& u) {
  const double width = system.stop_radius_mm();
  const Imath::V2f at = u.pair();
  return {{(at.x - 0.5) * width, (at.y - 0.5) * width, -5}, {0, 0, 1}};
}

// The lens has eleven surfaces.
void trace_lens_ray(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(system.to_image(next_ray(system, u), 550));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_lens_ray);

void trace_lens_packets(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  micro::NumberCycle u;
  const SampledSpectrum wavelengths_nm = u.packet();
  for (auto _ : state)
    benchmark::DoNotOptimize(system.to_image(
        {{{next_ray(system, u), wavelengths_nm}, {next_ray(system, u), wavelengths_nm}}}, system.direct()));
  state.SetItemsProcessed(state.iterations() * 2 * kLanes);
}
BENCHMARK(trace_lens_packets);

void trace_lens_ray_out(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  micro::NumberCycle u;
  for (auto _ : state) {
    lens::Ray ray = next_ray(system, u);
    ray.origin.z = system.image_z();
    const Imath::V3d to(ray.origin.x, ray.origin.y, system.last_z());
    ray.origin.x = ray.origin.y = 0;
    benchmark::DoNotOptimize(system.to_object({ray.origin, (to - ray.origin).normalized()}, 550));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_lens_ray_out);

}  // namespace
}  // namespace abbe
