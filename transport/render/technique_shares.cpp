#include "transport/render/technique_shares.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "transport/render/pilot.h"
#include "transport/render/threads.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

constexpr std::uint32_t kPixels = 4096;
constexpr std::uint32_t kPathsPerPixel = 8;
constexpr std::uint32_t kPhotons = 1U << 16;
constexpr std::uint32_t kBatches = 64;
constexpr int kGrid = 16;  // regions along an edge of the film
constexpr int kMostHalvings = 3;

// What the pilots found in one region, a value being the sum of |film value| over the channels.
struct Region {
  double pixels = 0;        // that camera paths went through
  double mean = 0;          // sum over them of the mean,
  double variance = 0;      // of the variance of a path,
  double path_squares = 0;  // and of the mean square
  double photons = 0;       // sum of all splats of photons that each stand for all of a sample's,
  double squares = 0;       // and of their squares
};

struct Findings {
  std::array<Region, static_cast<std::size_t>(kGrid) * kGrid> regions;
  std::uint64_t path_rays = 0;
  std::uint64_t photon_rays = 0;

  Region& at(const Camera& camera, int x, int y) {
    return regions[static_cast<std::size_t>(y * kGrid / camera.height * kGrid + x * kGrid / camera.width)];
  }
  void add(const Findings& more) {
    for (std::size_t i = 0; i < regions.size(); ++i) {
      regions[i].pixels += more.regions[i].pixels;
      regions[i].mean += more.regions[i].mean;
      regions[i].variance += more.regions[i].variance;
      regions[i].path_squares += more.regions[i].path_squares;
      regions[i].photons += more.regions[i].photons;
      regions[i].squares += more.regions[i].squares;
    }
    path_rays += more.path_rays;
    photon_rays += more.photon_rays;
  }
};

double strength(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += std::abs(v);
  return std::isfinite(sum) ? sum : 0;
}

void try_paths(PathTracer& tracer, const Camera& camera, std::uint32_t pixel, Findings& found) {
  const std::array<float, 4> u = Sampler(kSeedOfPilots, Purpose::pilot, 0, 1, pixel).group(0);
  const int x = std::min(static_cast<int>(u[0] * static_cast<float>(camera.width)), camera.width - 1);
  const int y = std::min(static_cast<int>(u[1] * static_cast<float>(camera.height)), camera.height - 1);
  std::vector<PixelSample> samples;
  for (std::uint32_t i = 0; i < kPathsPerPixel; ++i)
    samples.push_back({x, y, Sampler(kSeedOfPilots, Purpose::pilot, 1, pixel, i)});
  std::array<double, kPathsPerPixel> values{};
  tracer.trace(samples, [&](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
    values[path] += strength(more);
  });
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  Region& region = found.at(camera, x, y);
  region.pixels += 1;
  region.mean += sum / kPathsPerPixel;
  region.path_squares += squares / kPathsPerPixel;
  region.variance += std::max(0.0, squares - sum * sum / kPathsPerPixel) / (kPathsPerPixel - 1);
}

void try_photons(LightTracer& tracer, const Camera& camera, std::uint32_t batch, Findings& found) {
  std::vector<Sampler> photons;
  for (std::uint32_t i = batch; i < kPhotons; i += kBatches)
    photons.emplace_back(kSeedOfPilots, Purpose::pilot, 2, 0, i);
  tracer.trace(photons, [&](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    const double value = strength(values);
    Region& region = found.at(camera, at.x, at.y);
    region.photons += value;
    region.squares += value * value;
  });
}

Findings try_batch(const Plan& plan, std::uint32_t batch) {
  Findings found;
  const Camera& camera = plan.scene.camera;
  RayCaster path_caster(plan.scene);
  PathTracer path_tracer(plan, path_caster);
  for (std::uint32_t i = batch; i < kPixels; i += kBatches) try_paths(path_tracer, camera, i, found);
  RayCaster photon_caster(plan.scene);
  LightTracer light_tracer(plan, photon_caster, 1);
  try_photons(light_tracer, camera, batch, found);
  found.path_rays = path_caster.rays();
  found.photon_rays = photon_caster.rays();
  return found;
}

Findings try_all(const Plan& plan, int threads) {
  std::vector<Findings> batches(kBatches);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    for (std::uint32_t batch = next++; batch < kBatches; batch = next++)
      batches[batch] = try_batch(plan, batch);
  });
  Findings all;
  for (const Findings& batch : batches) all.add(batch);  // in their order, whichever threads traced them
  return all;
}

// How many pixels each region has: none, where the film has fewer along an edge than there are regions.
std::vector<double> region_sizes(const Camera& camera) {
  const auto cut = [](int film, int region) { return (region * film + kGrid - 1) / kGrid; };
  std::vector<double> sizes;
  for (int y = 0; y < kGrid; ++y)
    for (int x = 0; x < kGrid; ++x)
      sizes.push_back(static_cast<double>(cut(camera.width, x + 1) - cut(camera.width, x)) *
                      (cut(camera.height, y + 1) - cut(camera.height, y)));
  return sizes;
}

// Relative, summed over the pixels: variance and mean square of a camera path per pixel, and variance of as
// many photons as pixels.
struct Errors {
  double path_variance = 0;
  double path_square = 0;
  double photon_variance = 0;
};
Errors errors_of(const Findings& found, const Camera& camera) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const auto mean = [&](const Region& region, double size) {
    return (region.pixels > 0 ? region.mean / region.pixels : 0) + region.photons / (kPhotons * size);
  };
  const std::vector<double> sizes = region_sizes(camera);
  double film_mean = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] > 0) film_mean += mean(found.regions.at(i), sizes[i]) * sizes[i] / pixels;
  constexpr double kFloor = 0.01;  // of the film's mean, squared
  Errors errors;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Region& region = found.regions.at(i);
    const double scale =
        sizes[i] > 0 ? std::pow(mean(region, sizes[i]), 2) + kFloor * film_mean * film_mean : 0;
    if (!(scale > 0)) continue;
    errors.photon_variance += region.squares / (kPhotons * pixels) / scale;
    if (!(region.pixels > 0)) continue;
    errors.path_variance += sizes[i] * region.variance / region.pixels / scale;
    errors.path_square += sizes[i] * region.path_squares / region.pixels / scale;
  }
  return errors;
}

// How often a share, from 1, is halved to come nearest to the root of `wanted` over `whole`: no more than an
// eighth is left of it, and where nothing is known of either it is left whole.
int halvings(double wanted, double whole) {
  if (!(wanted < whole)) return 0;
  if (!(wanted > 0)) return kMostHalvings;
  return static_cast<int>(
      std::min(std::round((std::log2(whole) - std::log2(wanted)) / 2), 1.0 * kMostHalvings));
}

}  // namespace

std::optional<TechniqueCosts> set_technique_shares(Plan& plan, int threads) {
  if (plan.techniques.size() < 2) return std::nullopt;
  const auto pixels = static_cast<double>(plan.photons);
  const Findings found = try_all(plan, threads);
  const Errors errors = errors_of(found, plan.scene.camera);
  const double path_cost = static_cast<double>(found.path_rays) / (kPixels * kPathsPerPixel);
  const double photon_cost = static_cast<double>(found.photon_rays) / kPhotons;
  const int fewer_photons = halvings(errors.photon_variance * path_cost, errors.path_variance * photon_cost);
  const int fewer_paths = halvings(errors.path_square * photon_cost, errors.photon_variance * path_cost);
  plan.photons = std::max<std::uint64_t>(1, plan.photons >> fewer_photons);
  plan.path_interval = 1U << fewer_paths;
  return TechniqueCosts{{errors.path_variance / pixels, path_cost},
                        {errors.photon_variance / pixels, photon_cost}};
}

}  // namespace abbe
