// What chance may not change: the mean, whatever ends paths, and rough surfaces of every width, which lose
// nothing.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <boost/math/distributions/students_t.hpp>

#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

constexpr int kGrid = 8;

// Of each tile of a small Cornell box, the means of renders of their own seeds.
std::vector<std::vector<double>> tiles(int first_seed, int renders, int roulette_depth) {
  Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[32, 32]"},
                                            {"/sensor/pixel_pitch_um", "781.25"},
                                            {"/render/samples", "4"},
                                            {"/render/integrator", "path"}});
  scene.render.roulette_depth = roulette_depth;
  std::vector<std::vector<double>> found(kGrid * kGrid);
  constexpr int kEdge = 32 / kGrid;
  for (int seed = first_seed; seed < first_seed + renders; ++seed) {
    scene.render.seed = static_cast<std::uint64_t>(seed);
    const Film film = render(scene, {}).film;
    for (int tile = 0; tile < kGrid * kGrid; ++tile) {
      const int x = tile % kGrid * kEdge;
      const int y = tile / kGrid * kEdge;
      found[static_cast<std::size_t>(tile)].push_back(test::region(film, 1, x, y, x + kEdge, y + kEdge).mean);
    }
  }
  return found;
}

struct Moments {
  double mean = 0;
  double variance_of_mean = 0;
};
Moments moments(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Moments m;
  for (const double v : values) m.mean += v / n;
  for (const double v : values) m.variance_of_mean += (v - m.mean) * (v - m.mean) / (n * (n - 1));
  return m;
}

// Probability, both tails, of a difference at least as large between samples of equal means [Welch].
double welch(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments ma = moments(a);
  const Moments mb = moments(b);
  const double variance = ma.variance_of_mean + mb.variance_of_mean;
  const double degrees = variance * variance /
                         (ma.variance_of_mean * ma.variance_of_mean / static_cast<double>(a.size() - 1) +
                          mb.variance_of_mean * mb.variance_of_mean / static_cast<double>(b.size() - 1));
  const boost::math::students_t law(degrees);
  return 2 *
         boost::math::cdf(boost::math::complement(law, std::abs(ma.mean - mb.mean) / std::sqrt(variance)));
}

// Largest distance between the distribution of `values` and the uniform one, as Kolmogorov and Smirnov take
// it, times the root of their number.
double distance_from_uniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto below = static_cast<double>(i);
    largest = std::max({largest, values[i] - below / n, (below + 1) / n - values[i]});
  }
  return largest * std::sqrt(n);
}

// Stress 34: with and without roulette, over the tiles of a picture.
TEST(Stress, RouletteLeavesWelchsProbabilitiesUniform) {
  const int renders = test::nightly() ? 128 : 16;
  const auto with = tiles(1, renders, 2);
  const auto without = tiles(1001, renders, -1);
  std::vector<double> p;
  for (std::size_t tile = 0; tile < with.size(); ++tile) p.push_back(welch(with[tile], without[tile]));
  EXPECT_LT(distance_from_uniform(p), 2.23);  // 1 in 10 000 is further
}

}  // namespace
}  // namespace abbe
