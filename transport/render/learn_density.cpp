#include "transport/render/learn_density.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sensor/film/relative_error.h"
#include "transport/render/pilot.h"
#include "transport/render/threads.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

constexpr int kLeastEdge = 8;
constexpr int kMostBlocks = 1 << 14;
constexpr std::uint32_t kPixelsOfBlock = 2;
constexpr std::uint32_t kReplicates = 8;
constexpr std::uint32_t kPathsOfReplicate = 4;
constexpr std::uint32_t kPathsOfPixel = kReplicates * kPathsOfReplicate;
constexpr int kMostDoublings = 2;
constexpr double kLeastGain = 1.1;

/// What pilots find in a block of pixels, or in several: sums over its pilot pixels.
struct BlockNoise {
  double pixels = 0;
  double mean = 0;
  double variance = 0;  ///< Of a path through one pixel.
  double rays = 0;      ///< Of its paths.

  BlockNoise& operator+=(const BlockNoise& more) {
    pixels += more.pixels;
    mean += more.mean;
    variance += more.variance;
    rays += more.rays;
    return *this;
  }
};

/// The blocks of a crop.
struct Blocks {
  Crop crop;
  int edge;
  int across;
  int down;

  [[nodiscard]] int count() const { return across * down; }
};

Blocks blocks_of(const Camera& camera, const std::optional<Crop>& asked) {
  const Crop crop = asked.value_or(Crop{0, 0, camera.width, camera.height});
  const int width = crop.x1 - crop.x0;
  const int height = crop.y1 - crop.y0;
  const auto pieces = [](int whole, int edge) { return (whole + edge - 1) / edge; };
  int edge = kLeastEdge;
  while (pieces(width, edge) > kMostBlocks / pieces(height, edge)) ++edge;
  return {crop, edge, pieces(width, edge), pieces(height, edge)};
}

// Paths through pixels of the block chosen by chance.
std::vector<PixelSample> pilots_of(const Blocks& blocks, int block) {
  constexpr std::uint32_t kPixelsReplicate = 4;
  constexpr std::uint32_t kFirstReplicate = 5;
  const auto number = static_cast<std::uint32_t>(block);
  const int x0 = blocks.crop.x0 + block % blocks.across * blocks.edge;
  const int y0 = blocks.crop.y0 + block / blocks.across * blocks.edge;
  const auto within = [&blocks](float u, int from, int end) {
    const int size = std::min(blocks.edge, end - from);
    return from + std::min(static_cast<int>(u * static_cast<float>(size)), size - 1);
  };
  std::vector<PixelSample> pilots;
  for (std::uint32_t pixel = 0; pixel < kPixelsOfBlock; ++pixel) {
    const std::array<float, 4> u =
        Sampler(kSeedOfPilots, Purpose::pilot, kPixelsReplicate, number, pixel).group(0);
    for (std::uint32_t path = 0; path < kPathsOfPixel; ++path)
      pilots.push_back({within(u[0], x0, blocks.crop.x1), within(u[1], y0, blocks.crop.y1),
                        Sampler(kSeedOfPilots, Purpose::pilot, kFirstReplicate + path / kPathsOfReplicate,
                                number * kPixelsOfBlock + pixel, path % kPathsOfReplicate)});
  }
  return pilots;
}

BlockNoise noise_of(std::span<const double> values, double rays) {
  BlockNoise noise{.rays = rays};
  for (std::size_t first = 0; first < values.size(); first += kPathsOfPixel) {
    const PixelNoise pixel = noise_of_pixel(values.subspan(first, kPathsOfPixel), kPathsOfReplicate);
    noise.pixels += 1;
    noise.mean += pixel.mean;
    noise.variance += pixel.variance;
  }
  return noise;
}

std::vector<BlockNoise> try_blocks(const Plan& plan, const Blocks& blocks, int threads) {
  std::vector<BlockNoise> found(static_cast<std::size_t>(blocks.count()));
  std::atomic<int> next = 0;
  run_on_threads(threads, [&] {
    RayCaster caster(plan.scene);
    PathTracer tracer(plan, caster);
    for (int block = next++; block < blocks.count(); block = next++) {
      const std::uint64_t before = caster.rays();
      std::array<double, std::size_t{kPixelsOfBlock} * kPathsOfPixel> values{};
      tracer.trace(pilots_of(blocks, block),
                   [&values](std::uint32_t path, const FilmPoint&, std::span<const double> more) {
                     values.at(path) += magnitude(more);
                   });
      found[static_cast<std::size_t>(block)] = noise_of(values, static_cast<double>(caster.rays() - before));
    }
  });
  return found;
}

// Of each block and those that touch it together, as two pixels tell little.
std::vector<BlockNoise> smoothed(const std::vector<BlockNoise>& found, const Blocks& blocks) {
  std::vector<BlockNoise> around(found.size());
  for (int y = 0; y < blocks.down; ++y)
    for (int x = 0; x < blocks.across; ++x)
      for (int near_y = std::max(y - 1, 0); near_y < std::min(y + 2, blocks.down); ++near_y)
        for (int near_x = std::max(x - 1, 0); near_x < std::min(x + 2, blocks.across); ++near_x)
          around[static_cast<std::size_t>(y * blocks.across + x)] +=
              found[static_cast<std::size_t>(near_y * blocks.across + near_x)];
  return around;
}

/// What a path through a block costs and leaves of error.
struct BlockCost {
  double variance;  ///< Relative.
  double rays;

  [[nodiscard]] double worth() const { return rays > 0 ? std::sqrt(variance / rays) : 0; }
};

std::vector<BlockCost> costs_of(const std::vector<BlockNoise>& found) {
  BlockNoise film;
  for (const BlockNoise& block : found) film += block;
  const double floor = kUsualFloor * std::pow(film.mean / film.pixels, 2);
  std::vector<BlockCost> costs;
  for (const BlockNoise& block : found) {
    const double scale = std::pow(block.mean / block.pixels, 2) + floor;
    costs.push_back(
        {scale > 0 ? block.variance / block.pixels / scale : 0, block.rays / (block.pixels * kPathsOfPixel)});
  }
  return costs;
}

int doublings(const BlockCost& block, double unit) {
  if (!(block.worth() > 0)) return 0;
  return static_cast<int>(std::clamp(std::round(std::log2(block.worth() / unit)), 0.0, 1.0 * kMostDoublings));
}

// What a sample costs times the error that it leaves, where blocks have a path for each `unit` of what one is
// worth there.
double cost_at_equal_error(const std::vector<BlockCost>& blocks, double unit) {
  double rays = 0;
  double variance = 0;
  for (const BlockCost& block : blocks) {
    const double paths = 1 << doublings(block, unit);
    rays += block.rays * paths;
    variance += block.variance / paths;
  }
  return rays * variance;
}

// The best of units a root of two apart; nothing where paths alike are about as good.
std::optional<double> best_unit(const std::vector<BlockCost>& blocks) {
  double most = 0;
  for (const BlockCost& block : blocks) most = std::max(most, block.worth());
  const double alike = cost_at_equal_error(blocks, 2 * most);
  double best = most;
  double least = alike;
  constexpr int kUnits = 24;
  for (int i = 0; i < kUnits; ++i) {
    const double unit = most * std::exp2(-0.5 * i);
    const double cost = cost_at_equal_error(blocks, unit);
    if (cost < least) {
      least = cost;
      best = unit;
    }
  }
  return least * kLeastGain < alike ? std::optional(best) : std::nullopt;
}

}  // namespace

void learn_density(Plan& plan, const std::optional<Crop>& crop, int threads) {
  if (!uses(plan.techniques, Technique::path)) return;
  const Blocks blocks = blocks_of(plan.scene.camera, crop);
  const std::vector<BlockCost> costs = costs_of(smoothed(try_blocks(plan, blocks, threads), blocks));
  const std::optional<double> unit = best_unit(costs);
  if (!unit) return;
  SamplingDensity& density = plan.density = {blocks.crop.x0, blocks.crop.y0, blocks.edge, blocks.across, {}};
  for (const BlockCost& block : costs)
    density.paths.push_back(static_cast<std::uint8_t>(1 << doublings(block, *unit)));
}

}  // namespace abbe
