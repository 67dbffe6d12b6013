#include "transport/render/choose_path_splitting.h"

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

constexpr std::uint32_t kTrialPixels = 512;
constexpr std::size_t kTrimmedPixels = kTrialPixels / 64;
constexpr std::uint32_t kTrialReplicates = 4;
constexpr std::uint32_t kPathsPerReplicate = 8;
constexpr std::uint32_t kTrialPaths = kTrialReplicates * kPathsPerReplicate;
constexpr int kMaxSplitBits = 3;
constexpr double kMinGain = 1.02;

// Films of fewer pixels cost too little for trials to pay off.
constexpr double kMinFilmPixels = 1 << 13;

// Pixels of a first trial, which measures the rays per pixel.
constexpr std::uint32_t kFirstPixels = 8;

/// Noise of the pixels and number of rays for one number of directions.
struct Trial {
  std::array<PixelNoise, kTrialPixels> pixels;
  double rays = 0;
};

std::vector<PixelSample> trial_samples(const Camera& camera, std::uint32_t pilot) {
  constexpr std::uint32_t kPixelsStream = 2;
  constexpr std::uint32_t kFirstReplicate = 16;
  const auto [x, y] = pilot_pixel(camera, kPixelsStream, pilot);
  std::vector<PixelSample> paths;
  for (std::uint32_t i = 0; i < kTrialPaths; ++i)
    paths.push_back({x, y,
                     Sampler(kPilotSeed, Purpose::pilot, kFirstReplicate + i / kPathsPerReplicate, pilot,
                             i % kPathsPerReplicate)});
  return paths;
}

// Noise of the first `pixels` pilot pixels with the plan's splitting, and the rays that it took.
Trial trace_pilots(const Plan& plan, int threads, std::uint32_t pixels = kTrialPixels) {
  Trial trial;
  std::atomic<std::uint64_t> rays = 0;
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    PathTracer tracer(plan, caster);
    for (std::uint32_t pilot = next++; pilot < pixels; pilot = next++) {
      std::array<double, kTrialPaths> values{};
      tracer.trace(trial_samples(plan.scene.camera, pilot),
                   [&values](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
                     values.at(path) += magnitude(more);
                   });
      trial.pixels.at(pilot) = estimate_pixel_noise(values, kPathsPerReplicate);
    }
    rays += caster.rays();
  });
  trial.rays = static_cast<double>(rays);
  return trial;
}

// Rays times relMSE without the worst pixels, relative to the squared pixel means of `means`.
double cost(const Trial& trial, const Trial& means) {
  double film_mean = 0;
  for (const PixelNoise& pixel : means.pixels) film_mean += pixel.mean / kTrialPixels;
  const double floor = kUsualFloor * film_mean * film_mean;
  std::array<double, kTrialPixels> errors{};
  for (std::size_t i = 0; i < kTrialPixels; ++i) {
    const double scale = means.pixels.at(i).mean * means.pixels.at(i).mean + floor;
    errors.at(i) = scale > 0 ? trial.pixels.at(i).variance / scale : 0;
  }
  std::sort(errors.begin(), errors.end());
  return trial.rays * std::accumulate(errors.begin(), errors.end() - kTrimmedPixels, 0.0);
}

}  // namespace

void choose_path_splitting(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (plan.scene.render.integrator != Integrator::automatic || !uses(plan.techniques, Technique::path) ||
      1.0 * camera.width * camera.height < kMinFilmPixels)
    return;
  double remaining_rays = pilot_ray_budget(camera);
  // Doubling the directions at most doubles the rays.
  double next = trace_pilots(plan, threads, kFirstPixels).rays * kTrialPixels / kFirstPixels;
  if (3 * next > remaining_rays) return;
  const Trial whole = trace_pilots(plan, threads);
  double best_cost = cost(whole, whole);
  remaining_rays -= whole.rays;
  next = 2 * whole.rays;
  for (int bits = 1; bits <= kMaxSplitBits && next <= remaining_rays; ++bits) {
    Plan split = plan;
    split.log2_splits = bits;
    const Trial trial = trace_pilots(split, threads);
    const double trial_cost = cost(trial, whole);
    if (!(trial_cost < best_cost * kMinGain)) return;
    if (trial_cost * kMinGain < best_cost) {
      best_cost = trial_cost;
      plan.log2_splits = bits;
    }
    remaining_rays -= trial.rays;
    next = 2 * trial.rays;
  }
}

}  // namespace abbe
