#include <benchmark/benchmark.h>

#include "sensor/response/channel.h"
#include "spectral/wavelength_distribution.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

WavelengthDistribution observer_under(const Curve& light) {
  std::vector<Curve> responses;
  for (const Channel& channel : observer_channels(Observer::cie1931)) responses.push_back(channel.weight);
  return {std::vector{light}, responses};
}

void sample_wavelengths(benchmark::State& state) {
  const WavelengthDistribution wavelengths = observer_under(Curve(1.0));
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(wavelengths.sample(u.next()));
}
BENCHMARK(sample_wavelengths);

// Evaluates a curve with a knot every 4 nm for a packet.
void look_up_curve(benchmark::State& state) {
  std::vector<Knot> knots;
  for (int nm = 400; nm <= 700; nm += 4) knots.push_back({static_cast<double>(nm), nm / 700.0});
  const Curve curve(std::move(knots));
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(curve(u.packet()));
}
BENCHMARK(look_up_curve);

}  // namespace
}  // namespace abbe
