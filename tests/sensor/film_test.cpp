#include "sensor/film/film.h"
#include "io/error.h"
#include "sensor/film/crop.h"
#include "sensor/film/patch.h"
#include "sensor/film/relative_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

namespace abbe {
namespace {

TEST(FixedPoint, RoundTripsDoublesExactlyAboveItsUnit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-2, 2);
  for (int exponent = -20; exponent <= 40; ++exponent) {
    const double value = std::ldexp(mantissa(random), exponent);
    EXPECT_EQ(from_fixed(to_fixed(value, -80), -80), value) << exponent;
  }
  EXPECT_EQ(to_fixed(0.0, -80), 0);
}

// Units that are normal doubles, subnormal doubles, and too small for a double.
TEST(FixedPoint, IsAMultipleOfAnyUnit) {
  const Int128 many = (static_cast<Int128>(0x123456789abcdef) << 60) + 1;
  for (const int exponent : {-1200, -1100, -1074, -1023, -1022, -1021, -80, 0, 900, 1023, 1024})
    for (const Int128 fixed : {Int128{0}, Int128{1}, Int128{-3}, many, -many})
      EXPECT_EQ(from_fixed(fixed, exponent), std::ldexp(static_cast<double>(fixed), exponent)) << exponent;
}

TEST(FixedPoint, RoundsToTheNearestUnit) {
  EXPECT_EQ(to_fixed(2.5, 0), 3);
  EXPECT_EQ(to_fixed(-2.5, 0), -3);
  EXPECT_EQ(to_fixed(0.49, 0), 0);
  EXPECT_EQ(to_fixed(std::ldexp(1.0, -100), 0), 0);
  EXPECT_EQ(to_fixed(3.0, 1), 2);
}

TEST(Film, SumsDoNotDependOnTheirOrder) {
  std::mt19937_64 random(2);
  std::lognormal_distribution<double> values(0, 6);
  std::vector<double> list(10000);
  for (double& v : list) v = values(random);
  const auto sum = [](const std::vector<double>& terms) {
    Film film(1, 1, 1, 1, 1.0);
    for (const double v : terms) film.add(0, 0, {&v, 1});
    film.set_samples({1});
    return film.mean(0, 0);
  };
  const double forward = sum(list);
  std::reverse(list.begin(), list.end());
  EXPECT_EQ(sum(list), forward);
}

TEST(Film, AConstantStaysExactOverTenMillionSamples) {
  Film film(1, 1, 1, 1, 1.0);
  const double value = 0.1F;
  for (int i = 0; i < 10'000'000; ++i) film.add(0, 0, {&value, 1});
  film.set_samples({10'000'000});
  EXPECT_EQ(film.mean(0, 0), value);
}

TEST(Film, AdditionsFromSeveralThreadsAreNotLost) {
  Film film(4, 1, 2, 1, 1.0);
  const std::vector<double> values{1.0, 0x1p-60};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (std::size_t i = 0; i < 40000; ++i) film.add(i % 4, 0, values);
      });
  }
  film.set_samples({1});
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    EXPECT_EQ(film.mean(pixel, 0), 40000);
    EXPECT_EQ(film.mean(pixel, 1), 40000 * 0x1p-60);
  }
}

TEST(Film, VarianceIsThatOfTheMeanOverReplicates) {
  Film film(1, 1, 1, 4, 1.0);
  for (int r = 0; r < 4; ++r) {
    const double sum = 2.0 * (r + 1);  // two samples each: means 1, 2, 3, 4
    film.add(0, r, {&sum, 1});
  }
  film.set_samples({2, 2, 2, 2});
  EXPECT_DOUBLE_EQ(film.mean(0, 0), 2.5);
  EXPECT_DOUBLE_EQ(film.variance(0, 0), 5.0 / 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(frame_mean_error(film), std::sqrt(5.0 / 12.0) / 2.5);
}

TEST(Film, AveragesPixelsWithTheErrorOfTheirMean) {
  Film film(2, 1, 1, 2, 1.0);
  for (int r = 0; r < 2; ++r) {
    const double left = 1.0 + r;
    const double right = 5.0 - 3 * r;
    film.add(0, r, {&left, 1});
    film.add(1, r, {&right, 1});
  }
  film.set_samples({1, 1});
  EXPECT_DOUBLE_EQ(film.average(0).mean, 2.5);
  EXPECT_DOUBLE_EQ(film.average(0).standard_error, std::sqrt(0.25 + 2.25) / 2);
  EXPECT_DOUBLE_EQ(film.average(0).degrees_of_freedom, 3 * 2.5 * 2.5 / (0.25 * 0.25 + 2.25 * 2.25) - 2);
  EXPECT_DOUBLE_EQ(film.average(0, 1, 0, 2, 1).mean, 3.5);
  EXPECT_DOUBLE_EQ(film.average(0, 1, 0, 2, 1).standard_error, 1.5);
  EXPECT_DOUBLE_EQ(film.average(0, 1, 0, 2, 1).degrees_of_freedom, 1);
}

TEST(Film, AveragesPixelsThatAreEachDividedByTheirOwn) {
  for (const bool shared : {false, true}) {
    Film film(2, 1, 1, 2, 1.0, shared);
    Film divided(2, 1, 1, 2, 1.0, shared);
    for (int r = 0; r < 2; ++r) {
      const std::array<double, 2> values{1.0 + r, 5.0 - 3 * r};
      const std::array<double, 2> quotients{values[0] / 4, values[1] / 0.5};
      for (const std::size_t pixel : {0U, 1U}) {
        film.add(pixel, r, {&values.at(pixel), 1});
        divided.add(pixel, r, {&quotients.at(pixel), 1});
      }
    }
    film.set_samples({1, 1});
    divided.set_samples({1, 1});
    const Film::Average average = film.average(0, 0, 0, 2, 1, std::array<double, 2>{4, 0.5});
    EXPECT_DOUBLE_EQ(average.mean, divided.average(0).mean);
    EXPECT_DOUBLE_EQ(average.standard_error, divided.average(0).standard_error);
    EXPECT_DOUBLE_EQ(average.degrees_of_freedom, divided.average(0).degrees_of_freedom);
  }
}

// Each replicate lacks on the left what it has in excess on the right.
TEST(Film, PixelsThatSharePhotonsHaveOneErrorTogether) {
  for (const bool shared : {false, true}) {
    Film film(2, 1, 1, 2, 1.0, shared);
    for (int r = 0; r < 2; ++r) {
      const double left = 1.0 + r;
      const double right = 5.0 - r;
      film.add(0, r, {&left, 1});
      film.add(1, r, {&right, 1});
    }
    film.set_samples({1, 1});
    EXPECT_DOUBLE_EQ(film.average(0).mean, 3);
    EXPECT_DOUBLE_EQ(film.average(0).standard_error, shared ? 0 : std::sqrt(0.5) / 2);
    EXPECT_DOUBLE_EQ(film.average(0, 0, 0, 1, 1).standard_error, 0.5);
  }
}

TEST(Film, HoldsRefusesWhatWouldOverflow) {
  const Film film(1, 1, 1, 1, 1.0);
  EXPECT_TRUE(film.holds(1e12));
  EXPECT_FALSE(film.holds(1e15));
  EXPECT_FALSE(film.holds(std::nan("")));
  EXPECT_FALSE(film.holds(-INFINITY));
}

// Values that no sum holds are errors; all others are accepted.
TEST(Film, SumsHoldThousandsOfTheLargestValuesAndRefuseMore) {
  Film film(1, 1, 1, 1, 1.0);
  const double value = std::ldexp(0.75, 44);
  ASSERT_TRUE(film.holds(value));
  film.add(0, 0, {&value, 1});
  const auto twice = [&film] { film.add(film.only(std::array{0})); };
  for (int doublings = 0; doublings < 16; ++doublings) twice();
  film.set_samples({1});
  EXPECT_EQ(film.total(0, 0), std::ldexp(value, 16));
  EXPECT_THROW(twice(), Error);
  EXPECT_EQ(film.total(0, 0), std::ldexp(value, 16));
}

TEST(Film, AveragesTheLargestValuesItHolds) {
  Film film(8, 8, 1, 8, 1.0);
  const double value = std::ldexp(0.75, 44);
  ASSERT_TRUE(film.holds(value));
  for (std::size_t pixel = 0; pixel < 64; ++pixel)
    for (int r = 0; r < 8; ++r) film.add(pixel, r, {&value, 1});
  film.set_samples(std::vector<std::uint64_t>(8, 1));
  EXPECT_EQ(film.mean(5, 0), value);
  EXPECT_EQ(film.average(0).mean, value);
  EXPECT_EQ(film.average(0).standard_error, 0);
}

TEST(Film, ImageNamesValueAndVariancePlanes) {
  Film film(2, 1, 1, 2, 1.0);
  const double one = 1;
  film.add(1, 0, {&one, 1});
  film.set_samples({1, 1});
  const std::vector<std::string> names{"G"};
  const Image image = film.image(names);
  ASSERT_NE(image.find("G"), nullptr);
  ASSERT_NE(image.find("Variance.G"), nullptr);
  EXPECT_EQ(image.find("G")->values, (std::vector<float>{0, 0.5F}));
  EXPECT_EQ(image.find("Variance.G")->values, (std::vector<float>{0, 0.25F}));
}

TEST(Film, AVarianceBeyondSinglePrecisionIsInfinite) {
  Film film(1, 1, 1, 2, 1e21);
  film.add(0, 0, std::array{1e21});
  film.add(0, 1, std::array{3e21});
  film.set_samples({1, 1});
  const Image image = film.image(std::vector<std::string>{"e"});
  EXPECT_EQ(image.channels[0].values[0], 2e21F);
  EXPECT_EQ(image.channels[1].values[0], std::numeric_limits<float>::infinity());
  EXPECT_NEAR(film.variance(0, 0), 1e42, 1e30);
}

TEST(Film, FilmsAddUpToTheFilmOfAllTheirSamples) {
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> values(0, 6);
  Film whole(3, 2, 2, 2, 1.0);
  std::vector<Film> parts;
  for (int i = 0; i < 3; ++i) parts.emplace_back(whole.shape());
  for (std::size_t i = 0; i < 3000; ++i) {
    const std::vector<double> both{values(random), -values(random)};
    whole.add(i % 6, static_cast<int>(i % 2), both);
    parts[random() % 3].add(i % 6, static_cast<int>(i % 2), both);
  }
  parts[2].add(parts[0]);
  parts[2].add(parts[1]);
  EXPECT_EQ(parts[2].bytes(), whole.bytes());
  EXPECT_NE(parts[0].bytes(), whole.bytes());
}

TEST(Film, BytesMakeTheSameFilm) {
  Film film(2, 1, 3, 2, 1e-3);
  film.add(1, 1, std::vector<double>{1e-3, -2.5, 1e6});
  const std::optional<Film> back = Film::from_bytes(film.shape(), film.bytes());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->bytes(), film.bytes());
  EXPECT_EQ(back->shape(), film.shape());
  EXPECT_FALSE(Film::from_bytes(film.shape(), film.bytes().substr(1)));
  EXPECT_FALSE(Film::from_bytes(film.shape(), film.bytes().substr(16)));
  EXPECT_FALSE(Film::from_bytes(film.shape(), std::string(film.bytes()) + "x"));
}

TEST(RecordedAreas, AreThoseOfTheFilmOrAllOfItsCrop) {
  Image film{8, 4, {}, {}};
  EXPECT_EQ(recorded_areas(film), (std::vector<Crop>{{0, 0, 8, 4}}));
  film.metadata[kCropKey] = "0,0,6,4";
  for (const char* nonsense : {"", "0,0,2=0:8", "0,0,7,4=0:8", "0,0,2,2=0:8 x"}) {
    film.metadata[kAreasKey] = nonsense;
    EXPECT_EQ(recorded_areas(film), (std::vector<Crop>{{0, 0, 6, 4}})) << nonsense;
  }
  film.metadata[kAreasKey] = "0,0,2,4=0:8 2,0,6,4=0:4";
  EXPECT_EQ(recorded_areas(film), (std::vector<Crop>{{0, 0, 6, 4}})) << "there are no gaps";
  film.metadata[kAreasKey] = "0,0,2,2=0:8 3,2,6,4=0:4,5:8";
  EXPECT_EQ(recorded_areas(film), (std::vector<Crop>{{0, 0, 2, 2}, {3, 2, 6, 4}}));
}

TEST(Patches, ReachOverAreasThatTouchAndOverNoGap) {
  const ImageChannel plane{"Y", std::vector<float>(32, 3)};
  const Image film{8, 4, {plane}, {}};
  const std::vector<PatchOutline> patch{{"patch", {{{1, 1}, {6.5, 1}, {6.5, 3}, {1, 3}}}}};
  const auto measured = [&](const std::vector<Crop>& rendered) {
    return measure_patches(film, {{&plane}, {"Y"}, {}, {}, rendered}, patch);
  };
  for (const std::vector<Crop>& held :
       {std::vector<Crop>{}, {{0, 0, 7, 4}}, {{0, 0, 8, 2}, {0, 2, 4, 4}, {4, 2, 8, 4}}})
    EXPECT_EQ(measured(held)[0].channels[0].pixels, 10U);
  for (const std::vector<Crop>& gaps :
       {std::vector<Crop>{{0, 0, 6, 4}}, {{0, 0, 8, 2}, {0, 2, 4, 4}, {5, 2, 8, 4}}})
    EXPECT_THROW((void)measured(gaps), Error);
}

// The deviation of two pixels, 3 and 5, is the root of 2.
TEST(Patches, OnePixelHasNoDeviation) {
  const ImageChannel plane{"Y", {3, 5, 5, 5}};
  const Image film{2, 2, {plane}, {}};
  const auto deviation = [&](double right, double bottom) {
    const std::vector<PatchOutline> patch{{"patch", {{{0, 0}, {right, 0}, {right, bottom}, {0, bottom}}}}};
    return measure_patches(film, {{&plane}, {"Y"}, {}, {}}, patch)[0].channels[0].deviation;
  };
  EXPECT_EQ(deviation(1, 1), std::nullopt);
  EXPECT_DOUBLE_EQ(deviation(2, 1).value(), std::sqrt(2.0));
}

}  // namespace
}  // namespace abbe
