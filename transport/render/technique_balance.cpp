#include "transport/render/technique_balance.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "sensor/film/relative_error.h"
#include "transport/render/pilot.h"
#include "transport/render/threads.h"
#include "transport/technique/tracers.h"

namespace abbe {
namespace {

constexpr int kMaxHalvings = 3;

// Number of halvings, from 1, that comes nearest to sqrt(wanted / whole): at most three, and none if neither
// value is known.
int halvings(double wanted, double whole) {
  if (!(wanted < whole)) return 0;
  if (!(wanted > 0)) return kMaxHalvings;
  return static_cast<int>(
      std::min(std::round((std::log2(whole) - std::log2(wanted)) / 2), 1.0 * kMaxHalvings));
}

constexpr std::uint32_t kPhotonsPerPixel = 2 * kPilotPathsPerPixel;
constexpr std::uint32_t kSplitPhotonRatio = 16;  // times fewer photons that split into their wavelengths
constexpr std::uint32_t kTechniqueBatches = 64;
constexpr int kFilmRegions = 16;

// Number of regions along an edge of the film. A probe is read as one mean.
int regions_along(const Camera& camera) {
  return is_probe(camera) ? 1 : kFilmRegions;
}

// Sums of the pilots in one region. A value is the sum of |film value| over the channels.
struct Region {
  double pixels = 0;                // number of pixels that camera paths went through
  double mean = 0;                  // sum over these pixels of the mean of a path
  double variance = 0;              // sum over these pixels of the variance of a path
  double variance_squares = 0;      // sum over these pixels of the squared variance
  double path_squares = 0;          // sum over these pixels of the mean square of a path
  double path_tracing_squares = 0;  // the same for path tracing of the light that bidirectional paths sampled
  double photons = 0;               // sum of all splats, each photon carrying the light of a whole sample
  double squares = 0;               // sum of the squared splats
  double split_squares = 0;         // sum of the squared splats of photons that split
};

struct PilotSums {
  std::array<Region, static_cast<std::size_t>(kFilmRegions) * kFilmRegions> regions;
  double photons_traced = 0;
  double split_photons = 0;
  std::uint64_t path_rays = 0;
  std::uint64_t photon_rays = 0;
  std::uint64_t split_rays = 0;

  Region& at(const Camera& camera, int x, int y) {
    const int n = regions_along(camera);
    return regions[static_cast<std::size_t>(y * n / camera.height * n + x * n / camera.width)];
  }
  void add(const PilotSums& more) {
    for (std::size_t i = 0; i < regions.size(); ++i) {
      regions[i].pixels += more.regions[i].pixels;
      regions[i].mean += more.regions[i].mean;
      regions[i].variance += more.regions[i].variance;
      regions[i].variance_squares += more.regions[i].variance_squares;
      regions[i].path_squares += more.regions[i].path_squares;
      regions[i].path_tracing_squares += more.regions[i].path_tracing_squares;
      regions[i].photons += more.regions[i].photons;
      regions[i].squares += more.regions[i].squares;
      regions[i].split_squares += more.regions[i].split_squares;
    }
    photons_traced += more.photons_traced;
    split_photons += more.split_photons;
    path_rays += more.path_rays;
    photon_rays += more.photon_rays;
    split_rays += more.split_rays;
  }
  void add_splat(const Camera& camera, const FilmPoint& at_film, double value) {
    Region& region = at(camera, at_film.x, at_film.y);
    region.photons += value;
    region.squares += value * value;
  }
};

std::pair<int, int> pixel_of(const Camera& camera, std::uint32_t pilot) {
  return pilot_pixel(camera, 1, pilot);
}

Sampler path_sampler(std::uint32_t pilot, std::uint32_t path) {
  return {kPilotSeed, Purpose::pilot, 1, pilot, path};
}

using PathValues = std::array<double, kPilotPathsPerPixel>;  // values of the paths through one pixel

// Adds mean, mean square and unbiased variance of the paths through one pixel to its region.
void add_paths(const PathValues& values, Region& region) {
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  region.pixels += 1;
  region.mean += sum / kPilotPathsPerPixel;
  region.path_squares += squares / kPilotPathsPerPixel;
  const double variance =
      std::max(0.0, squares - sum * sum / kPilotPathsPerPixel) / (kPilotPathsPerPixel - 1);
  region.variance += variance;
  region.variance_squares += variance * variance;
}

// Traces the camera paths of one pilot pixel.
void measure_paths(Tracers& tracers, const Camera& camera, std::uint32_t pilot, PilotSums& sums) {
  const auto [x, y] = pixel_of(camera, pilot);
  std::vector<PixelSample> samples;
  for (std::uint32_t i = 0; i < kPilotPathsPerPixel; ++i) samples.push_back({x, y, path_sampler(pilot, i)});
  PathValues values{};
  tracers.path.trace(samples, [&](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
    values[path] += magnitude(more);
  });
  add_paths(values, sums.at(camera, x, y));
}

std::vector<Sampler> photons_of_batch(std::uint32_t batch, std::uint32_t total_photons) {
  std::vector<Sampler> photons;
  for (std::uint32_t i = batch; i < total_photons; i += kTechniqueBatches)
    photons.emplace_back(kPilotSeed, Purpose::pilot, 2, 0, i);
  return photons;
}

void measure_photons(Tracers& tracers, const Camera& camera, std::uint32_t batch, std::uint32_t total_photons,
                     PilotSums& sums) {
  const std::vector<Sampler> photons = photons_of_batch(batch, total_photons);
  tracers.light.trace(photons, [&](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    sums.add_splat(camera, at, magnitude(values));
  });
  sums.photons_traced += static_cast<double>(photons.size());
}

// Wavelengths of one photon that arrive at the same pixel add up to one value.
void measure_split_photons(Tracers& tracers, const Camera& camera, std::uint32_t batch,
                           std::uint32_t total_photons, PilotSums& sums) {
  const std::vector<Sampler> photons = photons_of_batch(batch, total_photons);
  std::map<std::tuple<std::uint32_t, int, int>, double> values_at;
  tracers.light.trace(photons,
                      [&](std::uint32_t photon, const FilmPoint& at, std::span<const double> values) {
                        values_at[{photon, at.x, at.y}] += magnitude(values);
                      });
  for (const auto& [key, value] : values_at)
    sums.at(camera, std::get<1>(key), std::get<2>(key)).split_squares += value * value;
  sums.split_photons += static_cast<double>(photons.size());
}

// Splats of a light subpath on other pixels count as those of a photon.
void measure_bidirectional(Tracers& tracers, const Plan& plan, std::uint32_t pilot, PilotSums& sums) {
  const Camera& camera = plan.scene.camera;
  const auto [x, y] = pixel_of(camera, pilot);
  std::vector<PixelPair> pairs;
  for (std::uint32_t i = 0; i < kPilotPathsPerPixel; ++i)
    pairs.push_back({x,
                     y,
                     path_sampler(pilot, i),
                     {kPilotSeed, Purpose::pilot, 2, 0, pilot * kPilotPathsPerPixel + i},
                     true});
  // Let p be the density of all strategies and p' that of path tracing, whose mean square of this light is
  // that of f/p'. The integral of f^2/p' is then the mean of (f/p)^2 p/p' over the bidirectional samples.
  Region& region = sums.at(camera, x, y);
  tracers.bidirectional.set_layer_sink([&](std::uint32_t pair, const FilmPoint& at,
                                           const ContributionInfo& history, std::span<const double> more) {
    if (at.x == pairs[pair].x && at.y == pairs[pair].y && history.path_tracing_fraction > 0)
      region.path_tracing_squares += std::pow(magnitude(more), 2) /
                                     static_cast<double>(history.path_tracing_fraction) / kPilotPathsPerPixel;
  });
  PathValues values{};
  tracers.bidirectional.trace(
      pairs, [&](std::uint32_t pair, const FilmPoint& at, std::span<const double> more) {
        if (at.x == pairs[pair].x && at.y == pairs[pair].y)
          values[pair] += magnitude(more);
        else
          sums.add_splat(camera, at, magnitude(more) * static_cast<double>(plan.photons));
      });
  sums.photons_traced += kPilotPathsPerPixel;
  add_paths(values, region);
}

// Traces one batch of pilots. `split_plan` is the plan whose photons split, if there is one.
PilotSums measure_batch(const Plan& plan, const std::optional<Plan>& split_plan, std::uint32_t batch,
                        std::uint32_t pixels) {
  PilotSums sums;
  const Camera& camera = plan.scene.camera;
  RayCaster caster(plan.scene);
  Tracers tracers(plan, caster, 1);
  for (std::uint32_t i = batch; i < pixels; i += kTechniqueBatches) {
    if (traces(plan.techniques, TracedPaths::both)) measure_bidirectional(tracers, plan, i, sums);
    if (traces(plan.techniques, TracedPaths::camera)) measure_paths(tracers, camera, i, sums);
  }
  sums.path_rays = caster.rays();
  if (traces(plan.techniques, TracedPaths::light))
    measure_photons(tracers, camera, batch, pixels * kPhotonsPerPixel, sums);
  sums.photon_rays = caster.rays() - sums.path_rays;
  if (split_plan) {
    RayCaster split_caster(plan.scene);
    Tracers split_tracers(*split_plan, split_caster, 1);
    measure_split_photons(split_tracers, camera, batch, pixels * kPhotonsPerPixel / kSplitPhotonRatio, sums);
    sums.split_rays = split_caster.rays();
  }
  return sums;
}

// Sums of all batches of pilots; if light tracing has dispersion, also of photons that split.
PilotSums measure_all(const Plan& plan, int threads, std::uint32_t pixels) {
  std::optional<Plan> split_plan;
  if (plan.scene.features.dispersion && traces(plan.techniques, TracedPaths::light)) {
    split_plan.emplace(plan);
    split_plan->photons_split_wavelengths = true;
  }
  std::vector<PilotSums> batches(kTechniqueBatches);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    for (std::uint32_t batch = next++; batch < kTechniqueBatches; batch = next++)
      batches[batch] = measure_batch(plan, split_plan, batch, pixels);
  });
  PilotSums all;
  for (const PilotSums& batch : batches) all.add(batch);  // in a fixed order, for any number of threads
  return all;
}

// Number of pixels of each region; 0 if the film has fewer pixels along an edge than regions.
std::vector<double> region_sizes(const Camera& camera) {
  const int n = regions_along(camera);
  const auto cut = [n](int film, int region) { return (region * film + n - 1) / n; };
  std::vector<double> sizes;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      sizes.push_back(static_cast<double>(cut(camera.width, x + 1) - cut(camera.width, x)) *
                      (cut(camera.height, y + 1) - cut(camera.height, y)));
  return sizes;
}

// Lets photons split, with this variance and number of rays, if that lowers the cost of error.
void split_if_cheaper(double variance, double rays, TechniqueStatistics& statistics) {
  if (!(variance > 0 && variance * rays < statistics.photon_variance * statistics.photon_rays)) return;
  statistics.split_ray_ratio = rays / statistics.photon_rays;
  statistics.photon_variance = variance;
  statistics.photon_rays = rays;
}

// Standard error of a weighted sum, over regions, of the variance of their paths. If a region has two pixels
// or more, their scatter estimates it without bias. A single pixel has no scatter. Its square is then
// multiplied by the ratio of scatter to squares of the other regions, which is near 1 if few pixels hold the
// variance.
class VarianceError {
 public:
  void add(const Region& region, double weight) {
    const double squares = weight * weight * region.variance_squares;
    if (!(region.pixels > 1)) {
      single_squares_ += squares;
      return;
    }
    const double mean_square = weight * weight * region.variance * region.variance / region.pixels;
    squares_ += squares;
    scatter_ += std::max(0.0, squares - mean_square) * region.pixels / (region.pixels - 1);
  }
  [[nodiscard]] double standard_error() const {
    return std::sqrt(scatter_ + single_squares_ * (squares_ > 0 ? scatter_ / squares_ : 1));
  }

 private:
  double single_squares_ = 0;  // sum over regions of one pixel
  double squares_ = 0;         // sum over all other regions
  double scatter_ = 0;
};

// Statistics from the sums. Each region's own mean is that of its camera paths plus that of its photons;
// `region_means` replaces it where it is above 0. Squares and variances are divided by the squared mean plus
// a floor, and scaled from the pilots to all pixels.
TechniqueStatistics relative_statistics(const PilotSums& sums, const Camera& camera,
                                        std::uint32_t pilot_pixels, std::span<const double> region_means) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const double photons = std::max(1.0, sums.photons_traced);
  const std::vector<double> sizes = region_sizes(camera);
  TechniqueStatistics statistics;
  std::vector<double>& means = statistics.region_means;
  double film_mean = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Region& region = sums.regions.at(i);
    means.push_back(i < region_means.size() ? region_means[i] : 0);
    if (!(sizes[i] > 0)) continue;
    if (!(means[i] > 0))
      means[i] =
          (region.pixels > 0 ? region.mean / region.pixels : 0) + region.photons / (photons * sizes[i]);
    film_mean += means[i] * sizes[i] / pixels;
  }
  double split_variance = 0;
  VarianceError variance_error;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Region& region = sums.regions.at(i);
    const double scale = sizes[i] > 0 ? std::pow(means[i], 2) + kUsualFloor * film_mean * film_mean : 0;
    if (!(scale > 0)) continue;
    statistics.photon_variance += region.squares / (photons * pixels) / scale;
    split_variance += region.split_squares / (std::max(1.0, sums.split_photons) * pixels) / scale;
    if (!(region.pixels > 0)) continue;
    statistics.path_variance += sizes[i] * region.variance / region.pixels / scale;
    variance_error.add(region, sizes[i] / region.pixels / scale);
    statistics.path_square += sizes[i] * region.path_squares / region.pixels / scale;
    statistics.path_tracing_square += sizes[i] * region.path_tracing_squares / region.pixels / scale;
  }
  statistics.path_variance_error = variance_error.standard_error();
  statistics.path_rays = static_cast<double>(sums.path_rays) / (pilot_pixels * kPilotPathsPerPixel);
  statistics.rays = sums.path_rays + sums.photon_rays + sums.split_rays;
  statistics.photon_rays = static_cast<double>(sums.photon_rays) / photons;
  if (sums.split_photons > 0)
    split_if_cheaper(split_variance, static_cast<double>(sums.split_rays) / sums.split_photons, statistics);
  return statistics;
}

constexpr std::uint32_t kTrialPixels = 512;
constexpr std::size_t kTrimmedPixels = kTrialPixels / 64;
constexpr std::uint32_t kTrialReplicates = 4;
constexpr std::uint32_t kPathsPerReplicate = 8;
constexpr std::uint32_t kTrialPaths = kTrialReplicates * kPathsPerReplicate;
constexpr int kMaxSplitBits = 3;
constexpr double kMinSplittingGain = 1.02;

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
    Tracers tracers(plan, caster, 1);
    for (std::uint32_t pilot = next++; pilot < pixels; pilot = next++) {
      std::array<double, kTrialPaths> values{};
      tracers.path.trace(trial_samples(plan.scene.camera, pilot),
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

std::optional<TechniqueCosts> balance_techniques(Plan& plan, int threads) {
  if (plan.techniques.size() < 2) return std::nullopt;
  const auto pixels = static_cast<double>(plan.photons);
  const TechniqueStatistics statistics = measure_techniques(plan, threads);
  plan.photons_split_wavelengths = statistics.split_ray_ratio.has_value();
  const auto log2_split_ratio =
      static_cast<int>(std::lround(std::log2(std::max(1.0, statistics.split_ray_ratio.value_or(1)))));
  const double photon_variance = std::ldexp(statistics.photon_variance, log2_split_ratio);
  const double photon_rays = std::ldexp(statistics.photon_rays, -log2_split_ratio);
  const int fewer_photons =
      halvings(photon_variance * statistics.path_rays, statistics.path_variance * photon_rays);
  const int fewer_paths =
      halvings(statistics.path_square * photon_rays, photon_variance * statistics.path_rays);
  plan.photons = std::max<std::uint64_t>(1, plan.photons >> (log2_split_ratio + fewer_photons));
  plan.path_interval = 1U << fewer_paths;
  return TechniqueCosts{{statistics.path_variance / pixels, statistics.path_rays},
                        {statistics.photon_variance / pixels, statistics.photon_rays}};
}

TechniqueStatistics measure_techniques(const Plan& plan, int threads, std::uint32_t pixels,
                                       std::span<const double> region_means) {
  return relative_statistics(measure_all(plan, threads, pixels), plan.scene.camera, pixels, region_means);
}

void choose_path_splitting(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (plan.scene.render.integrator != Integrator::automatic ||
      !traces(plan.techniques, TracedPaths::camera) || 1.0 * camera.width * camera.height < kMinFilmPixels)
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
    if (!(trial_cost < best_cost * kMinSplittingGain)) return;
    if (trial_cost * kMinSplittingGain < best_cost) {
      best_cost = trial_cost;
      plan.log2_splits = bits;
    }
    remaining_rays -= trial.rays;
    next = 2 * trial.rays;
  }
}

}  // namespace abbe
