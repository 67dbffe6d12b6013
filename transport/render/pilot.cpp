#include "transport/render/pilot.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "transport/render/cost.h"
#include "transport/render/pass.h"
#include "transport/render/threads.h"
#include "transport/technique/tracers.h"

namespace abbe {
namespace {

constexpr std::uint64_t kPaths = 1U << 16;
constexpr std::uint64_t kMaxPilotSamples = 16;

constexpr std::uint32_t kPilotBatches = 64;
constexpr std::uint32_t kPilotBatch = 256;
constexpr double kPilotPaths = kPilotBatches * kPilotBatch;

// Pixel samples of a batch, spread over the whole film.
std::vector<PixelSample> pixels_of(const Plan& plan, std::uint32_t batch) {
  const Camera& camera = plan.scene.camera;
  std::vector<PixelSample> samples;
  for (std::uint32_t i = batch * kPilotBatch; i < (batch + 1) * kPilotBatch; ++i) {
    const auto [x, y] = pilot_pixel(camera, 0, i);
    samples.push_back({x, y, Sampler(kPilotSeed, Purpose::camera, 0, 0, i)});
  }
  return samples;
}

// Sink that adds up the contributions of each light.
ContributionDeposit sum_by_light(ExposureByLight& sums) {
  return [&sums](std::uint32_t, const FilmPoint&, const ContributionInfo& history,
                 std::span<const double> values) { sums.add(history.light, values); };
}

// Traces camera paths and scales their mean to the sum over all pixels.
void expose_batch(const Plan& plan, std::uint32_t batch, Tracers& tracers, ExposureByLight& sums) {
  const Camera& camera = plan.scene.camera;
  tracers.path.set_layer_sink(sum_by_light(sums));
  tracers.path.trace(pixels_of(plan, batch), discard_values);
  for (double& sum : sums.exposure) sum *= static_cast<double>(camera.width) * camera.height / kPilotPaths;
}

void expose_bidirectional(const Plan& plan, std::uint32_t batch, Tracers& tracers, ExposureByLight& sums) {
  std::vector<PixelPair> pairs;
  for (const PixelSample& sample : pixels_of(plan, batch)) {
    const auto i = static_cast<std::uint32_t>(batch * kPilotBatch + pairs.size());
    pairs.push_back({sample.x, sample.y, sample.sampler, {kPilotSeed, Purpose::light, 0, 0, i}, true});
  }
  tracers.bidirectional.set_layer_sink(sum_by_light(sums));
  tracers.bidirectional.trace(pairs, discard_values);
}

void expose_photons(const Plan& plan, std::uint32_t batch, Tracers& tracers, ExposureByLight& sums) {
  std::vector<Sampler> photons;
  for (std::uint32_t i = batch * kPilotBatch; i < (batch + 1) * kPilotBatch; ++i)
    photons.emplace_back(kPilotSeed, Purpose::light, 0, 0, i);
  const std::size_t planes = plan.scene.film_planes().size();
  std::vector<double> values(photons.size() * planes);
  tracers.light.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double> splat) {
    for (std::size_t k = 0; k < planes; ++k) values[photon * planes + k] += splat[k];
  });
  for (std::size_t i = 0; i < photons.size(); ++i)
    sums.add(tracers.light.starts()[i].light, std::span(values).subspan(i * planes, planes));
}

std::uint64_t pixel_total(const Plan& plan) {
  const Camera& camera = plan.scene.camera;
  return static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height);
}

std::optional<Film> film_of(const Plan& plan, int threads, const std::optional<Crop>& crop,
                            const std::function<bool()>& stop, const SampleRange& samples, int replicates) {
  const Camera& camera = plan.scene.camera;
  Film film(camera.width, camera.height, static_cast<int>(plan.scene.film_planes().size()), replicates,
            plan.nominal_value, replicates > 1 ? paths_to_any_pixel(plan) : 0, plan.path_interval, crop);
  Pass pass(plan, film, crop, samples, 0, kPilotSeed);
  pass.run(threads, stop);
  if (!pass.finished()) return std::nullopt;
  film.set_samples(count_per_replicate({samples}, replicates));
  return film;
}

// Traces paths spread evenly over the film, and as many photons.
void trace_some(const Plan& plan, RayCaster& caster) {
  constexpr std::uint32_t kReplayed = 1U << 15;
  constexpr std::uint32_t kTogether = 256;
  const Scene& scene = plan.scene;
  const auto width = static_cast<std::uint32_t>(scene.camera.width);
  const std::uint32_t pixels = width * static_cast<std::uint32_t>(scene.camera.height);
  Tracers tracers(plan, caster, 1);
  std::vector<PixelSample> samples;
  std::vector<Sampler> photons;
  std::vector<PixelPair> pairs;
  for (std::uint32_t first = 0; first < kReplayed; first += kTogether) {
    samples.clear();
    photons.clear();
    pairs.clear();
    for (std::uint32_t i = first; i < first + kTogether; ++i) {
      const auto pixel = static_cast<std::uint32_t>(std::uint64_t{i} * pixels / kReplayed);
      samples.push_back({static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                         Sampler(scene.render.seed, Purpose::camera, 0, pixel, i / pixels)});
      photons.emplace_back(scene.render.seed, Purpose::light, 0, 0, i);
      pairs.push_back({samples.back().x, samples.back().y, samples.back().sampler, photons.back(), true});
    }
    if (traces(plan.techniques, TracedPaths::camera)) tracers.path.trace(samples, discard_values);
    if (traces(plan.techniques, TracedPaths::light)) tracers.light.trace(photons, discard_values);
    if (!traces(plan.techniques, TracedPaths::camera) && !traces(plan.techniques, TracedPaths::light))
      tracers.bidirectional.trace(pairs, discard_values);
  }
}

}  // namespace

std::pair<int, int> pilot_pixel(const Camera& camera, std::uint32_t stream, std::uint32_t pilot) {
  const std::array<float, 4> u = Sampler(kPilotSeed, Purpose::pilot, 0, stream, pilot).group(0);
  return {std::min(static_cast<int>(u[0] * static_cast<float>(camera.width)), camera.width - 1),
          std::min(static_cast<int>(u[1] * static_cast<float>(camera.height)), camera.height - 1)};
}

PixelNoise estimate_pixel_noise(std::span<const double> values, std::size_t paths_per_replicate) {
  const auto paths = static_cast<double>(paths_per_replicate);
  const double replicates = static_cast<double>(values.size()) / paths;
  PixelNoise noise{std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size())};
  for (std::size_t first = 0; first < values.size(); first += paths_per_replicate) {
    const auto replicate = values.subspan(first, paths_per_replicate);
    const double mean = std::accumulate(replicate.begin(), replicate.end(), 0.0) / paths;
    noise.variance += paths * std::pow(mean - noise.mean, 2) / (replicates - 1);
  }
  return noise;
}

std::optional<Film> pilot_film(const Plan& plan, int threads, std::optional<Crop> crop,
                               const std::function<bool()>& stop) {
  const std::uint64_t samples = std::clamp<std::uint64_t>(kPaths / pixel_total(plan), 1, kMaxPilotSamples);
  return film_of(plan, threads, crop, stop, {0, samples}, 1);
}

std::optional<Film> noise_pilot(const Plan& plan, int threads, std::optional<Crop> crop,
                                const std::function<bool()>& stop) {
  constexpr int kReplicates = 8;
  const std::uint64_t samples =
      kPaths / std::max(pixel_total(plan), plan.photons) / kReplicates * kReplicates;
  if (samples == 0) return std::nullopt;
  // Samples after those of `pilot_film`, so that the random numbers differ.
  return film_of(plan, threads, crop, stop, {kMaxPilotSamples, kMaxPilotSamples + samples}, kReplicates);
}

void pilot_exposures(const Plan& plan, int threads, ExposureByLight& sums) {
  std::vector<ExposureByLight> batches(kPilotBatches, sums);
  for (ExposureByLight& batch : batches) std::fill(batch.exposure.begin(), batch.exposure.end(), 0.0);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    Tracers tracers(plan, caster, 1 / kPilotPaths);
    for (std::uint32_t batch = next++; batch < kPilotBatches; batch = next++) {
      if (traces(plan.techniques, TracedPaths::camera)) expose_batch(plan, batch, tracers, batches[batch]);
      if (traces(plan.techniques, TracedPaths::light)) expose_photons(plan, batch, tracers, batches[batch]);
      if (!traces(plan.techniques, TracedPaths::camera) && !traces(plan.techniques, TracedPaths::light))
        expose_bidirectional(plan, batch, tracers, batches[batch]);
    }
  });
  // The order of the batches makes the sum independent of the threads.
  for (const ExposureByLight& batch : batches)
    for (std::size_t group = 0; group < sums.exposure.size(); ++group)
      sums.exposure[group] += batch.exposure[group];
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
