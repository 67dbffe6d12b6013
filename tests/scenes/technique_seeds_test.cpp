// Cells of the matrix of techniques over many seeds: means are what they say, and standard errors no less
// than they are.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "tests/validation/cases_run.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

constexpr int kSeeds = 200;
constexpr double kFamily = 1e-6;  // of all probabilities below together

// A cell without a blur, which merging has none of on a sphere that is lit evenly, and samples with which a
// film is quick and its mean near a normal law.
struct Seeded {
  const char* cell;
  int samples;
  bool smooth = false;  // what it sums, so that slices of one sequence tell far more than the film's error
};
constexpr std::array kCells{Seeded{"T1-0.2 by path", 16},
                            Seeded{"T1-0.2 by bdpt", 16},
                            Seeded{"T1-0 by photon-brute", 8},
                            Seeded{"T9-outer by bdpt", 16, true},
                            Seeded{"T9-outer by sppm", 16},
                            Seeded{"T9-outer by vcm", 16},
                            Seeded{"T9-outer by adjoint-brute", 64, true},
                            Seeded{"T11 by path", 32},
                            Seeded{"T12-white by path", 32, true},
                            Seeded{"T12-glass by adjoint-brute", 64, true},
                            Seeded{"T13-60 by bdpt", 32},
                            Seeded{"T17-60 by bdpt", 16},
                            Seeded{"ball-axis by bdpt", 64, true},
                            Seeded{"ball-disc by light", 16},
                            Seeded{"pane-thick by path", 64, true},
                            Seeded{"scattered-once by path", 32, true}};

const Case& case_of(const std::string& id) {
  const auto& all = all_cases();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Case& item) { return item.id == id; });
  if (found == all.end()) throw Error(ErrorCode::internal, id, "no such case");
  return *found;
}

// By each seed the probability of a mean no greater than what it found: were the mean right and the error
// that the film tells its own, it would be even over [0, 1] by the law of Student. Replicates that are slices
// of one sequence tell more than the film's error, the more so the smoother what is summed, and so
// probabilities keep to the middle.
std::vector<double> probabilities(const Seeded& seeded) {
  FilmSetup film = film_of(case_of(seeded.cell));
  film.scene.render.samples = seeded.samples;
  film.scene.render.photons.per_sample = 1024;  // of what sends its own; others do not ask
  std::vector<double> all;
  for (int seed = 0; seed < kSeeds; ++seed) {
    film.scene.render.seed = 5000 + static_cast<std::uint64_t>(seed);
    const Film::Average found = render(film.scene, {}).film.average(film.channel);
    const boost::math::students_t law(found.degrees_of_freedom);
    all.push_back(boost::math::cdf(law, (found.mean - film.expected) / found.standard_error));
  }
  return all;
}

// The less likely of both tails, twice.
double both_tails(double below) {
  return 2 * std::min(below, 1 - below);
}

// What of a cell is not to be expected: the likelihoods of its furthest seed and of the mean of all, that of
// so large a variance or a larger one, and that of so many seeds so far out, at whatever distance most are,
// or more.
struct Likelihoods {
  double furthest = 1;
  double mean = 0;
  double spread = 0;
  double beyond = 0;
  double narrow = 0;   // likewise of so small a variance or a smaller one,
  double classes = 0;  // and of how seeds share ten equal classes
};
Likelihoods likelihoods(const char* name, const std::vector<double>& probabilities) {
  constexpr std::size_t kClasses = 10;
  constexpr double kExpected = static_cast<double>(kSeeds) / kClasses;
  const boost::math::normal normal;
  Likelihoods found;
  double sum = 0;
  double squares = 0;
  std::vector<double> tails;
  std::array<int, kClasses> counts{};
  for (const double p : probabilities) {
    const double z = boost::math::quantile(normal, std::clamp(p, 1e-15, 1 - 1e-15));
    tails.push_back(both_tails(p));
    sum += z;
    squares += z * z;
    ++counts.at(std::min(static_cast<std::size_t>(p * kClasses), kClasses - 1));
  }
  std::sort(tails.begin(), tails.end());
  found.furthest = tails.front();
  found.mean = both_tails(boost::math::cdf(normal, sum / std::sqrt(kSeeds)));
  found.spread = boost::math::cdf(boost::math::complement(boost::math::chi_squared(kSeeds), squares));
  found.narrow = boost::math::cdf(boost::math::chi_squared(kSeeds), squares);
  double statistic = 0;
  for (const int count : counts) statistic += std::pow(count - kExpected, 2) / kExpected;
  found.classes =
      boost::math::cdf(boost::math::complement(boost::math::chi_squared(kClasses - 1), statistic));
  // The share of tails below x exceeds x by d anywhere with a probability of at most exp(-2 n d^2).
  // [Massart1990]
  double most = 0;
  for (std::size_t i = 0; i < tails.size(); ++i)
    most = std::max(most, static_cast<double>(i + 1) / kSeeds - tails[i]);
  found.beyond = std::exp(-2 * kSeeds * most * most);
  fmt::print("{}: z {:+.3f} in the mean, variance {:.3f}; likelihoods {:.2g} {:.2g} {:.2g} {:.2g}\n", name,
             sum / kSeeds, squares / kSeeds, found.furthest, found.mean, found.spread, found.beyond);
  return found;
}

// Šidák's bound on one of so many likelihoods of a family.
double bound(std::size_t many) {
  return -std::expm1(std::log1p(-kFamily) / static_cast<double>(many));
}

class NightlySeeds : public testing::TestWithParam<Seeded> {};

TEST_P(NightlySeeds, DeviateAsTheirErrorsSay) {
  const Likelihoods found = likelihoods(GetParam().cell, probabilities(GetParam()));
  const double one = bound(kCells.size() * (kSeeds + 3));
  EXPECT_GT(found.furthest, one) << "a seed is too far off";
  EXPECT_GT(found.mean, one) << "the mean is off";
  EXPECT_GT(2 * found.spread, one) << "standard errors are too small";
  EXPECT_GT(found.beyond, one) << "too many seeds are further off than their errors say";
  if (GetParam().smooth) return;
  EXPECT_GT(2 * found.narrow, one) << "standard errors are too large";
  EXPECT_GT(found.classes, one) << "deviations do not follow their law";
}

INSTANTIATE_TEST_SUITE_P(Nightly, NightlySeeds, testing::ValuesIn(kCells), [](const auto& info) {
  std::string name = info.param.cell;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace abbe
