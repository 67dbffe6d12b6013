#include "transport/render/learn_splitting.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "sensor/film/relative_error.h"
#include "transport/render/pilot.h"
#include "transport/render/threads.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

constexpr std::uint32_t kTriedPixels = 512;
constexpr std::size_t kForgiven = kTriedPixels / 64;
constexpr std::uint32_t kTriedReplicates = 4;
constexpr std::uint32_t kTriedTogether = 8;
constexpr std::uint32_t kTriedPaths = kTriedReplicates * kTriedTogether;
constexpr int kMostSplitBits = 3;
constexpr double kLeastGainOfMore = 1.02;

// Of fewer pixels films cost too little to be tried.
constexpr double kLeastFilm = 1 << 13;

// Few pixels tell first what rays cost.
constexpr std::uint32_t kFirstPixels = 8;

/// What pilots find by one way to go on.
struct Trial {
  std::array<PixelNoise, kTriedPixels> pixels;
  double rays = 0;
};

std::vector<PixelSample> paths_of(const Camera& camera, std::uint32_t pilot) {
  constexpr std::uint32_t kPixelsStream = 2;
  constexpr std::uint32_t kFirstReplicate = 16;
  const auto [x, y] = pixel_of_pilot(camera, kPixelsStream, pilot);
  std::vector<PixelSample> paths;
  for (std::uint32_t i = 0; i < kTriedPaths; ++i)
    paths.push_back({x, y,
                     Sampler(kSeedOfPilots, Purpose::pilot, kFirstReplicate + i / kTriedTogether, pilot,
                             i % kTriedTogether)});
  return paths;
}

Trial trace_pilots(const Plan& plan, int threads, std::uint32_t pixels = kTriedPixels) {
  Trial trial;
  std::atomic<std::uint64_t> rays = 0;
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    PathTracer tracer(plan, caster);
    for (std::uint32_t pilot = next++; pilot < pixels; pilot = next++) {
      std::array<double, kTriedPaths> values{};
      tracer.trace(paths_of(plan.scene.camera, pilot),
                   [&values](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
                     values.at(path) += magnitude(more);
                   });
      trial.pixels.at(pilot) = noise_of_pixel(values, kTriedTogether);
    }
    rays += caster.rays();
  });
  trial.rays = static_cast<double>(rays);
  return trial;
}

// Rays times relMSE, the worst pixels forgiven, where pixels have these means.
double cost(const Trial& trial, const Trial& means) {
  double film_mean = 0;
  for (const PixelNoise& pixel : means.pixels) film_mean += pixel.mean / kTriedPixels;
  const double floor = kUsualFloor * film_mean * film_mean;
  std::array<double, kTriedPixels> errors{};
  for (std::size_t i = 0; i < kTriedPixels; ++i) {
    const double scale = means.pixels.at(i).mean * means.pixels.at(i).mean + floor;
    errors.at(i) = scale > 0 ? trial.pixels.at(i).variance / scale : 0;
  }
  std::sort(errors.begin(), errors.end());
  return trial.rays * std::accumulate(errors.begin(), errors.end() - kForgiven, 0.0);
}

}  // namespace

void learn_splitting(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (plan.scene.render.integrator != Integrator::automatic || !uses(plan.techniques, Technique::path) ||
      1.0 * camera.width * camera.height < kLeastFilm)
    return;
  double left = rays_of_pilots(camera);
  // With 2^bits parts at most twice the rays of half as many.
  double next = trace_pilots(plan, threads, kFirstPixels).rays * kTriedPixels / kFirstPixels;
  if (3 * next > left) return;
  const Trial whole = trace_pilots(plan, threads);
  double least = cost(whole, whole);
  left -= whole.rays;
  next = 2 * whole.rays;
  for (int bits = 1; bits <= kMostSplitBits && next <= left; ++bits) {
    Plan split = plan;
    split.split_bits = bits;
    const Trial trial = trace_pilots(split, threads);
    const double now = cost(trial, whole);
    if (!(now < least * kLeastGainOfMore)) return;
    if (now * kLeastGainOfMore < least) {
      least = now;
      plan.split_bits = bits;
    }
    left -= trial.rays;
    next = 2 * trial.rays;
  }
}

}  // namespace abbe
