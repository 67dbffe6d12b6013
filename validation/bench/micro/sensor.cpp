#include <benchmark/benchmark.h>

#include "sensor/film/film.h"
#include "sensor/response/channel.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

// X, Y and Z of one packet.
void weigh_channels(benchmark::State& state) {
  const std::vector<Channel> channels = observer_channels(Observer::cie1931);
  micro::NumberCycle u;
  for (auto _ : state) {
    const SampledSpectrum nm = u.packet();
    for (const Channel& channel : channels) benchmark::DoNotOptimize(channel.weight(nm));
  }
}
BENCHMARK(weigh_channels);

// One sample of three channels, in the pixel order of a tile.
void add_to_film(benchmark::State& state) {
  constexpr int kEdge = 256;
  Film film(kEdge, kEdge, 3, 4, 1);
  micro::NumberCycle u;
  std::size_t pixel = 0;
  for (auto _ : state) {
    const std::array<double, 3> values{u.next(), u.next(), u.next()};
    film.add(pixel, 0, values);
    pixel = (pixel + 1) % (std::size_t{kEdge} * kEdge);
  }
}
BENCHMARK(add_to_film);

}  // namespace
}  // namespace abbe
