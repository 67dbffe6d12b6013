#include "sensor/film/relative_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace abbe {
namespace {

constexpr std::size_t kValues = 20000;

// True deviations and their estimates from normal replicates.
struct Estimated {
  std::vector<double> truth;
  std::vector<double> estimates;

  [[nodiscard]] double true_quantile(double p) const {
    return truth[static_cast<std::size_t>(p * static_cast<double>(truth.size()))];
  }
  [[nodiscard]] double seen_quantile(double p) const {
    std::vector<double> sorted = estimates;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size()))];
  }
};
Estimated estimated(int degrees, const std::function<double(std::mt19937&)>& deviation) {
  std::mt19937 random(7);
  std::chi_squared_distribution<double> chi2(degrees);
  Estimated all;
  for (std::size_t i = 0; i < kValues; ++i) {
    all.truth.push_back(deviation(random));
    all.estimates.push_back(all.truth.back() * std::sqrt(chi2(random) / degrees));
  }
  std::sort(all.truth.begin(), all.truth.end());
  return all;
}

double lognormal(std::mt19937& random, double width) {
  return std::exp(width * std::normal_distribution<double>()(random));
}

// Estimates of equal deviations are up to 1.96 times as large at their 95th percentile, and 0.67 times as
// large at the median.
TEST(RelativeError, QuantilesAreThoseOfTheTrueDeviations) {
  struct Law {
    const char* name;
    std::function<double(std::mt19937&)> deviation;
    double margin;
  };
  const Law laws[] = {
      {"equal", [](std::mt19937&) { return 0.01; }, 0.04},
      {"alike", [](std::mt19937& r) { return lognormal(r, 0.3); }, 0.04},
      {"wide", [](std::mt19937& r) { return lognormal(r, 1); }, 0.06},
      {"a tenth much larger", [](std::mt19937& r) { return (r() % 10 == 0 ? 1 : 0.1) * lognormal(r, 0.2); },
       0.04},
  };
  for (const int degrees : {1, 3, 7})
    for (const Law& law : laws) {
      const Estimated all = estimated(degrees, law.deviation);
      constexpr std::array kProbabilities{0.5, 0.95};
      const auto found = quantiles_of_deviation(all.estimates, degrees, kProbabilities);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i] / all.true_quantile(kProbabilities.at(i)), 1,
                    degrees == 1 ? 2 * law.margin : law.margin)
            << law.name << ", " << degrees << " degrees, " << kProbabilities.at(i) << "; uncorrected "
            << all.seen_quantile(kProbabilities.at(i)) / all.true_quantile(kProbabilities.at(i));
    }
}

// Four replicates of one sample each. Half of the film is dark, a quarter exact, and the rest has `noise`.
Film half_dark(double noise) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Film film(64, 64, 1, 4, 1.0);
  for (std::size_t pixel = 0; pixel < 2048; ++pixel)
    for (int r = 0; r < 4; ++r) {
      const double value = pixel < 1024 ? 1 : 1 + 2 * noise * normal(random);
      film.add(pixel, r, {&value, 1});
    }
  film.set_samples({1, 1, 1, 1});
  return film;
}

TEST(RelativeError, IsThatOfLitValues) {
  const Film film = half_dark(0.01);
  const std::vector<std::size_t> lit = nonzero_values(film);
  ASSERT_EQ(lit.size(), 2048U);
  const RelativeError error = relative_error(film, lit);
  EXPECT_NEAR(error.p95, 0.01, 0.0006);
  EXPECT_LE(error.median, 0.01);
  EXPECT_NEAR(error.frame_mean, 0.01 / std::sqrt(1024.0) / 2, 0.0001);

  const std::vector<std::size_t> noisy(lit.begin() + 1024, lit.end());
  EXPECT_NEAR(relative_error(film, noisy).median, 0.01, 0.0003);
  const std::vector<std::size_t> exact(lit.begin(), lit.begin() + 1024);
  EXPECT_EQ(relative_error(film, exact).p95, 0);
}

// Counts of each remainder among the values selected on a film of constant values.
std::vector<std::size_t> chosen(int edge, int planes, const std::function<std::size_t(std::size_t)>& kind) {
  Film film(edge, edge, planes, 1, 1.0);
  const std::vector<double> values(static_cast<std::size_t>(planes), 1.0);
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
       ++pixel)
    film.add(pixel, 0, values);
  film.set_samples({1});
  std::vector<std::size_t> counts;
  const std::vector<std::size_t> lit = nonzero_values(film);
  EXPECT_TRUE(std::is_sorted(lit.begin(), lit.end()));
  EXPECT_EQ(std::adjacent_find(lit.begin(), lit.end()), lit.end());
  for (const std::size_t value : lit) {
    counts.resize(std::max(counts.size(), kind(value) + 1));
    ++counts[kind(value)];
  }
  return counts;
}

TEST(RelativeError, IsThatOfAllPlanesAndColorsAlike) {
  const auto expect_even = [](const std::vector<std::size_t>& counts, std::size_t kinds) {
    ASSERT_EQ(counts.size(), kinds);
    const double share = 131072.0 / static_cast<double>(kinds);
    for (const std::size_t count : counts)
      EXPECT_NEAR(static_cast<double>(count), share, 5 * std::sqrt(share)) << kinds;
  };
  expect_even(chosen(512, 3, [](std::size_t value) { return value % 3; }), 3);
  expect_even(chosen(1024, 1, [](std::size_t pixel) { return pixel / 1024 % 2 * 2 + pixel % 2; }), 4);
}

TEST(RelativeError, IsThatOfPlanesThatCountLight) {
  Film film(2, 1, 3, 1, 1.0);
  const std::vector<double> values{1, -0.25, 0.5};
  for (std::size_t pixel = 0; pixel < 2; ++pixel) film.add(pixel, 0, values);
  film.set_samples({1});
  EXPECT_EQ(nonzero_values(film, 1), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(nonzero_values(film, 2), (std::vector<std::size_t>{0, 1, 3, 4}));
  EXPECT_EQ(nonzero_values(film, 9), nonzero_values(film));
}

TEST(RelativeError, OfTheMeanIsThatOfPlanesThatCountLight) {
  Film film(1, 1, 2, 2, 1.0);
  film.add(0, 0, std::vector<double>{2, -3});
  film.add(0, 1, std::vector<double>{4, 3});
  film.set_samples({1, 1});
  EXPECT_DOUBLE_EQ(frame_mean_error(film, 1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(frame_mean_error(film), std::sqrt(1.0 + 9) / 3);
  EXPECT_DOUBLE_EQ(frame_mean_error(film, 9), frame_mean_error(film));
  EXPECT_DOUBLE_EQ(relative_error(film, {}, 1).frame_mean, 1.0 / 3);
}

TEST(RelativeError, WhatIsLitAndNotFoundYetIsInfinitelyFarOff) {
  const Film film = half_dark(0.01);
  std::vector<std::size_t> lit = nonzero_values(film);
  for (std::size_t dark = 2048; dark < 2248; ++dark) lit.push_back(dark);
  const RelativeError error = relative_error(film, lit);
  EXPECT_TRUE(std::isinf(error.p95));
  EXPECT_LE(error.median, 0.011);
}

// 16 by 16 pixels of mean 1 with noise. Some contain a single sample that is brighter than the whole film.
Film with_rare_samples(int replicates, std::size_t rare, double noise = 0.1) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Film film(16, 16, 1, replicates, 1.0);
  for (std::size_t pixel = 0; pixel < 256; ++pixel)
    for (int r = 0; r < replicates; ++r) {
      double value = 1 + noise * normal(random);
      if (pixel % 5 == 2 && pixel / 5 < rare && r == static_cast<int>(pixel) % replicates) value += 1000;
      film.add(pixel, r, {&value, 1});
    }
  film.set_samples(std::vector<std::uint64_t>(static_cast<std::size_t>(replicates), 1));
  return film;
}

TEST(RelativeError, IsNotKnownWhereFewSamplesCarryTheNoise) {
  for (const int replicates : {2, 8}) {
    EXPECT_EQ(few_samples(with_rare_samples(replicates, 1)), 1U) << replicates;
    EXPECT_EQ(few_samples(with_rare_samples(replicates, 5)), 3U) << replicates << ": three of five are half";
    EXPECT_EQ(few_samples(with_rare_samples(replicates, 50)), std::nullopt) << replicates;
    EXPECT_EQ(few_samples(with_rare_samples(replicates, 0)), std::nullopt) << replicates;
  }
  const Film film = with_rare_samples(8, 5);
  EXPECT_EQ(relative_error(film, {}).few_samples, 3U) << "although nothing of it was lit";
  EXPECT_FALSE(is_known(relative_error(film, {})));
  EXPECT_TRUE(is_known(relative_error(with_rare_samples(8, 0), {})));
}

TEST(RelativeError, IsKnownOfFewBrightPixelsThatAllSamplesLight) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Film film(64, 1, 2, 8, 1.0);
  for (const std::size_t bright : {7, 8})
    for (int r = 0; r < 8; ++r)
      film.add(bright, r, std::vector<double>{100 + 10 * normal(random), 50 + 5 * normal(random)});
  film.set_samples(std::vector<std::uint64_t>(8, 1));
  EXPECT_EQ(few_samples(film), std::nullopt);
}

// A pilot with four times the samples; its standard error is half as large for the same noise.
TEST(RelativeError, IsNotKnownWhereAPilotPredictsMoreNoise) {
  const Film film = with_rare_samples(2, 0);
  const double of_noise = 0.1 / std::sqrt(2.0);
  const double of_rare_samples = std::sqrt(20.0 / 256) * 1000 / 8;
  EXPECT_NEAR(hidden_noise(film, with_rare_samples(8, 20)) / (2 * of_rare_samples / of_noise), 1, 0.1);
  EXPECT_EQ(hidden_noise(film, with_rare_samples(8, 0)), 0);
  EXPECT_EQ(hidden_noise(film, with_rare_samples(8, 0, 0.14)), 0) << "an insignificant ratio";
  EXPECT_NEAR(hidden_noise(film, with_rare_samples(8, 0, 0.25)), 2.5, 0.3);
  EXPECT_EQ(hidden_noise(with_rare_samples(2, 3), with_rare_samples(8, 20)), 0) << "the film shows them";
  EXPECT_EQ(hidden_noise(with_rare_samples(8, 0, 0.05), with_rare_samples(2, 0)), 0)
      << "more samples of a smooth integrand may reduce the error by more than their root";
  RelativeError error;
  error.hidden_noise = 40;
  EXPECT_FALSE(is_known(error));
}

TEST(RelativeError, IsUnknownBeforeTwoReplicates) {
  Film film(1, 1, 1, 2, 1.0);
  const double value = 1;
  film.add(0, 0, {&value, 1});
  film.set_samples({1, 0});
  const RelativeError error = relative_error(film, nonzero_values(film));
  EXPECT_TRUE(std::isinf(error.median) && std::isinf(error.p95) && std::isinf(error.frame_mean));
  EXPECT_EQ(error.few_samples, std::nullopt);
}

}  // namespace
}  // namespace abbe
