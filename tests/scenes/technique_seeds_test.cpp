// Cells of the matrix of techniques over many seeds: means and standard errors alike are what they say.
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
};
constexpr std::array kCells{Seeded{"T1-0.2 by path", 16},
                            Seeded{"T1-0.2 by bdpt", 16},
                            Seeded{"T1-0 by photon-brute", 8},
                            Seeded{"T9-outer by bdpt", 16},
                            Seeded{"T9-outer by sppm", 16},
                            Seeded{"T9-outer by vcm", 16},
                            Seeded{"T9-outer by adjoint-brute", 64},
                            Seeded{"T11 by path", 32},
                            Seeded{"T12-white by path", 32},
                            Seeded{"T12-glass by adjoint-brute", 64},
                            Seeded{"T13-60 by bdpt", 32},
                            Seeded{"T17-60 by bdpt", 16},
                            Seeded{"ball-axis by bdpt", 64},
                            Seeded{"ball-disc by light", 16},
                            Seeded{"pane-thick by path", 64},
                            Seeded{"scattered-once by path", 32}};

const Case& case_of(const std::string& id) {
  const auto& all = all_cases();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Case& item) { return item.id == id; });
  if (found == all.end()) throw Error(ErrorCode::internal, id, "no such case");
  return *found;
}

// By each seed the probability of a mean no greater than what it found: even over [0, 1] if the mean is right
// and deviates, in standard errors, by the law of Student that the film tells.
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

// What of a cell is not to be expected: the likelihoods of its furthest seed, of the mean and of the variance
// of all, and of how they share ten equal classes.
struct Likelihoods {
  double furthest = 1;
  double mean = 0;
  double spread = 0;
  double classes = 0;
};
Likelihoods likelihoods(const char* name, const std::vector<double>& probabilities) {
  constexpr std::size_t kClasses = 10;
  constexpr double kExpected = static_cast<double>(kSeeds) / kClasses;
  const boost::math::normal normal;
  Likelihoods found;
  double sum = 0;
  double squares = 0;
  std::array<int, kClasses> counts{};
  for (const double p : probabilities) {
    const double z = boost::math::quantile(normal, std::clamp(p, 1e-15, 1 - 1e-15));
    found.furthest = std::min(found.furthest, both_tails(p));
    sum += z;
    squares += z * z;
    ++counts.at(std::min(static_cast<std::size_t>(p * kClasses), kClasses - 1));
  }
  double statistic = 0;
  for (const int count : counts) statistic += std::pow(count - kExpected, 2) / kExpected;
  found.mean = both_tails(boost::math::cdf(normal, sum / std::sqrt(kSeeds)));
  found.spread = both_tails(boost::math::cdf(boost::math::chi_squared(kSeeds), squares));
  found.classes =
      boost::math::cdf(boost::math::complement(boost::math::chi_squared(kClasses - 1), statistic));
  fmt::print("{}: z {:+.3f} in the mean, variance {:.3f}; likelihoods {:.2g} {:.2g} {:.2g} {:.2g}\n", name,
             sum / kSeeds, squares / kSeeds, found.furthest, found.mean, found.spread, found.classes);
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
  EXPECT_GT(found.spread, one) << "standard errors are too small or too large";
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
