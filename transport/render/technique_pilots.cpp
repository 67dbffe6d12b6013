#include "transport/render/technique_pilots.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "sensor/film/relative_error.h"
#include "transport/render/pilot.h"
#include "transport/render/threads.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

constexpr std::uint32_t kPhotonsPerPixel = 2 * kPilotPathsPerPixel;
constexpr std::uint32_t kParted = 16;  // times fewer of those that part
constexpr std::uint32_t kTechniqueBatches = 64;
constexpr int kGrid = 16;

// Regions along an edge of the film. A meter tells its mean.
int regions_along(const Camera& camera) {
  return is_meter(camera) ? 1 : kGrid;
}

// What the pilots found in one region, a value being the sum of |film value| over the channels.
struct Region {
  double pixels = 0;                // that camera paths went through
  double mean = 0;                  // sum over them of the mean,
  double variance = 0;              // of the variance of a path,
  double variance_squares = 0;      // of its square,
  double path_squares = 0;          // and of the mean square
  double path_tracing_squares = 0;  // that path tracing would have of what was joined
  double photons = 0;               // sum of all splats of photons that each stand for all of a sample's,
  double squares = 0;               // and of their squares,
  double parted_squares = 0;        // and the latter of photons that part into their lanes
};

struct Findings {
  std::array<Region, static_cast<std::size_t>(kGrid) * kGrid> regions;
  double photons_traced = 0;
  double photons_parted = 0;
  std::uint64_t path_rays = 0;
  std::uint64_t photon_rays = 0;
  std::uint64_t parted_rays = 0;

  Region& at(const Camera& camera, int x, int y) {
    const int n = regions_along(camera);
    return regions[static_cast<std::size_t>(y * n / camera.height * n + x * n / camera.width)];
  }
  void add(const Findings& more) {
    for (std::size_t i = 0; i < regions.size(); ++i) {
      regions[i].pixels += more.regions[i].pixels;
      regions[i].mean += more.regions[i].mean;
      regions[i].variance += more.regions[i].variance;
      regions[i].variance_squares += more.regions[i].variance_squares;
      regions[i].path_squares += more.regions[i].path_squares;
      regions[i].path_tracing_squares += more.regions[i].path_tracing_squares;
      regions[i].photons += more.regions[i].photons;
      regions[i].squares += more.regions[i].squares;
      regions[i].parted_squares += more.regions[i].parted_squares;
    }
    photons_traced += more.photons_traced;
    photons_parted += more.photons_parted;
    path_rays += more.path_rays;
    photon_rays += more.photon_rays;
    parted_rays += more.parted_rays;
  }
  void add_splat(const Camera& camera, const FilmPoint& at_film, double value) {
    Region& region = at(camera, at_film.x, at_film.y);
    region.photons += value;
    region.squares += value * value;
  }
};

std::pair<int, int> pixel_of(const Camera& camera, std::uint32_t pilot) {
  return pixel_of_pilot(camera, 1, pilot);
}

Sampler path_sampler(std::uint32_t pilot, std::uint32_t path) {
  return {kSeedOfPilots, Purpose::pilot, 1, pilot, path};
}

using PathValues = std::array<double, kPilotPathsPerPixel>;  // of the paths through one pixel

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

void try_paths(PathTracer& tracer, const Camera& camera, std::uint32_t pilot, Findings& found) {
  const auto [x, y] = pixel_of(camera, pilot);
  std::vector<PixelSample> samples;
  for (std::uint32_t i = 0; i < kPilotPathsPerPixel; ++i) samples.push_back({x, y, path_sampler(pilot, i)});
  PathValues values{};
  tracer.trace(samples, [&](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
    values[path] += magnitude(more);
  });
  add_paths(values, found.at(camera, x, y));
}

std::vector<Sampler> photons_of_batch(std::uint32_t batch, std::uint32_t photons_of_all) {
  std::vector<Sampler> photons;
  for (std::uint32_t i = batch; i < photons_of_all; i += kTechniqueBatches)
    photons.emplace_back(kSeedOfPilots, Purpose::pilot, 2, 0, i);
  return photons;
}

void try_photons(LightTracer& tracer, const Camera& camera, std::uint32_t batch, std::uint32_t photons_of_all,
                 Findings& found) {
  const std::vector<Sampler> photons = photons_of_batch(batch, photons_of_all);
  tracer.trace(photons, [&](std::uint32_t, const FilmPoint& at, std::span<const double> values) {
    found.add_splat(camera, at, magnitude(values));
  });
  found.photons_traced += static_cast<double>(photons.size());
}

// Lanes of one photon that come to one pixel are one value there.
void try_parted_photons(LightTracer& tracer, const Camera& camera, std::uint32_t batch,
                        std::uint32_t photons_of_all, Findings& found) {
  const std::vector<Sampler> photons = photons_of_batch(batch, photons_of_all);
  std::map<std::tuple<std::uint32_t, int, int>, double> values_at;
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint& at, std::span<const double> values) {
    values_at[{photon, at.x, at.y}] += magnitude(values);
  });
  for (const auto& [place, value] : values_at)
    found.at(camera, std::get<1>(place), std::get<2>(place)).parted_squares += value * value;
  found.photons_parted += static_cast<double>(photons.size());
}

// Of what a path from a light exposes, other pixels count as those of a photon.
void try_joined(BidirectionalTracer& tracer, const Plan& plan, std::uint32_t pilot, Findings& found) {
  const Camera& camera = plan.scene.camera;
  const auto [x, y] = pixel_of(camera, pilot);
  std::vector<PixelPair> pairs;
  for (std::uint32_t i = 0; i < kPilotPathsPerPixel; ++i)
    pairs.push_back({x,
                     y,
                     path_sampler(pilot, i),
                     {kSeedOfPilots, Purpose::pilot, 2, 0, pilot * kPilotPathsPerPixel + i},
                     true});
  // With p the density of all strategies and p' that of path tracing, whose mean square of this light is that
  // of f/p', the integral of f^2/p' is the mean of (f/p)^2 p/p' over what is joined.
  Region& region = found.at(camera, x, y);
  tracer.tell_apart(
      [&](std::uint32_t pair, const FilmPoint& at, const LightHistory& of, std::span<const double> more) {
        if (at.x == pairs[pair].x && at.y == pairs[pair].y && of.by_path_tracing > 0)
          region.path_tracing_squares +=
              std::pow(magnitude(more), 2) / static_cast<double>(of.by_path_tracing) / kPilotPathsPerPixel;
      });
  PathValues values{};
  tracer.trace(pairs, [&](std::uint32_t pair, const FilmPoint& at, std::span<const double> more) {
    if (at.x == pairs[pair].x && at.y == pairs[pair].y)
      values[pair] += magnitude(more);
    else
      found.add_splat(camera, at, magnitude(more) * static_cast<double>(plan.photons));
  });
  found.photons_traced += kPilotPathsPerPixel;
  add_paths(values, region);
}

// `parting` is the plan whose photons part, where there is one.
Findings try_batch(const Plan& plan, const std::optional<Plan>& parting, std::uint32_t batch,
                   std::uint32_t pixels) {
  Findings found;
  RayCaster path_caster(plan.scene);
  RayCaster photon_caster(plan.scene);
  if (uses(plan.techniques, Technique::bdpt)) {
    BidirectionalTracer tracer(plan, path_caster);
    for (std::uint32_t i = batch; i < pixels; i += kTechniqueBatches) try_joined(tracer, plan, i, found);
  }
  if (uses(plan.techniques, Technique::path)) {
    PathTracer tracer(plan, path_caster);
    for (std::uint32_t i = batch; i < pixels; i += kTechniqueBatches)
      try_paths(tracer, plan.scene.camera, i, found);
  }
  if (uses(plan.techniques, Technique::light)) {
    LightTracer tracer(plan, photon_caster, 1);
    try_photons(tracer, plan.scene.camera, batch, pixels * kPhotonsPerPixel, found);
  }
  if (parting) {
    RayCaster caster(plan.scene);
    LightTracer tracer(*parting, caster, 1);
    try_parted_photons(tracer, plan.scene.camera, batch, pixels * kPhotonsPerPixel / kParted, found);
    found.parted_rays = caster.rays();
  }
  found.path_rays = path_caster.rays();
  found.photon_rays = photon_caster.rays();
  return found;
}

Findings try_all(const Plan& plan, int threads, std::uint32_t pixels) {
  std::optional<Plan> parting;
  if (plan.scene.needs.dispersion && uses(plan.techniques, Technique::light)) {
    parting.emplace(plan);
    parting->photons_part = true;
  }
  std::vector<Findings> batches(kTechniqueBatches);
  std::atomic<std::uint32_t> next = 0;
  run_on_threads(threads, [&] {
    for (std::uint32_t batch = next++; batch < kTechniqueBatches; batch = next++)
      batches[batch] = try_batch(plan, parting, batch, pixels);
  });
  Findings all;
  for (const Findings& batch : batches) all.add(batch);  // in their order, whichever threads traced them
  return all;
}

// How many pixels each region has: none, where the film has fewer along an edge than there are regions.
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

// Photons that part have that variance, and cast so many rays.
void part_where_cheaper(double variance, double rays, PilotFindings& told) {
  if (!(variance > 0 && variance * rays < told.photon_variance * told.photon_rays)) return;
  told.rays_of_parting = rays / told.photon_rays;
  told.photon_variance = variance;
  told.photon_rays = rays;
}

// Squared standard error of a weighted sum over regions of the variance of their paths. From two pixels of a
// region on it is known without bias from their scatter. A single pixel shows none: its square is taken times
// the ratio of the scatter of the other regions to their squares, which is near 1 where few pixels hold the
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
  double single_squares_ = 0;  // of regions of one pixel
  double squares_ = 0;         // of the others
  double scatter_ = 0;
};

PilotFindings relative(const Findings& found, const Camera& camera, std::uint32_t tried) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const double photons = std::max(1.0, found.photons_traced);
  const auto mean = [&](const Region& region, double size) {
    return (region.pixels > 0 ? region.mean / region.pixels : 0) + region.photons / (photons * size);
  };
  const std::vector<double> sizes = region_sizes(camera);
  double film_mean = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] > 0) film_mean += mean(found.regions.at(i), sizes[i]) * sizes[i] / pixels;
  PilotFindings told;
  double parted_variance = 0;
  VarianceError variance_error;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Region& region = found.regions.at(i);
    const double scale =
        sizes[i] > 0 ? std::pow(mean(region, sizes[i]), 2) + kUsualFloor * film_mean * film_mean : 0;
    if (!(scale > 0)) continue;
    told.photon_variance += region.squares / (photons * pixels) / scale;
    parted_variance += region.parted_squares / (std::max(1.0, found.photons_parted) * pixels) / scale;
    if (!(region.pixels > 0)) continue;
    told.path_variance += sizes[i] * region.variance / region.pixels / scale;
    variance_error.add(region, sizes[i] / region.pixels / scale);
    told.path_square += sizes[i] * region.path_squares / region.pixels / scale;
    told.path_tracing_square += sizes[i] * region.path_tracing_squares / region.pixels / scale;
  }
  told.path_variance_error = variance_error.standard_error();
  told.path_rays = static_cast<double>(found.path_rays) / (tried * kPilotPathsPerPixel);
  told.rays = found.path_rays + found.photon_rays + found.parted_rays;
  told.photon_rays = static_cast<double>(found.photon_rays) / photons;
  if (found.photons_parted > 0)
    part_where_cheaper(parted_variance, static_cast<double>(found.parted_rays) / found.photons_parted, told);
  return told;
}

}  // namespace

PilotFindings try_techniques(const Plan& plan, int threads, std::uint32_t pixels) {
  return relative(try_all(plan, threads, pixels), plan.scene.camera, pixels);
}

}  // namespace abbe
