#include "report/image_difference.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/table.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

Image image(std::vector<std::pair<std::string, std::vector<float>>> channels) {
  Image result{static_cast<int>(channels.front().second.size()), 1, {}, {}};
  for (auto& [name, values] : channels) result.channels.push_back({name, values});
  return result;
}

TEST(Compare, FiguresFollowTheirFormulas) {
  const Comparison c = compare_images(image({{"QE", {3, 1}}}), image({{"QE", {2, 2}}, {"other", {9, 9}}}));
  EXPECT_DOUBLE_EQ(c.rel_mse, 1 / (4 + 0.01 * 4));
  EXPECT_DOUBLE_EQ(c.rmse, 1);
  EXPECT_DOUBLE_EQ(c.mean_ratio, 1);
  EXPECT_FALSE(c.color);
}

TEST(Compare, VarianceChannelsDoNotCount) {
  const Comparison c = compare_images(image({{"QE", {2, 4}}, {"Variance.QE", {7, 7}}}),
                                      image({{"QE", {2, 4}}, {"Variance.QE", {1, 1}}}));
  EXPECT_EQ(c.rel_mse, 0);
  EXPECT_EQ(c.rmse, 0);
}

TEST(Compare, WhatStandsBesideTheFilmDoesNotCount) {
  Image a = image({{"QE", {2, 4}}, {"Coverage", {1, 0}}, {"depth.Z", {3, 1e10F}}, {"light.key.QE", {2, 4}}});
  Image b = image({{"QE", {2, 4}}, {"Coverage", {0, 1}}, {"depth.Z", {5, 9}}, {"light.key.QE", {1, 1}}});
  a.metadata["sensor_channels"] = b.metadata["sensor_channels"] = "QE";
  EXPECT_EQ(compare_images(a, b).rmse, 0);
}

TEST(Compare, EqualImagesHaveNoColourDifferenceAndBrightnessMatters) {
  const Image a = image({{"X", {0.9F, 0.5F}}, {"Y", {1, 0.5F}}, {"Z", {1.1F, 0.2F}}});
  EXPECT_EQ(compare_images(a, a).color->max, 0);
  const Image b = image({{"X", {0.9F, 0.6F}}, {"Y", {1, 0.6F}}, {"Z", {1.1F, 0.24F}}});
  const Comparison c = compare_images(b, a);
  ASSERT_TRUE(c.color);
  EXPECT_GT(c.color->max, 3);
  EXPECT_DOUBLE_EQ(c.color->mean, c.color->max / 2);
}

TEST(ColorDifference, AFilmWhoseChannelsAreNamedXYZGoesByItsMatrixUnlessTheyArePhotometric) {
  Image film = image({{"X", {1}}, {"Y", {2}}, {"Z", {4}}});
  film.metadata["sensor_channels"] = "X,Y,Z";
  const auto expect_xyz = [&film](const XYZ& expected) {
    const std::vector<XYZ> seen = tristimuli(film);
    ASSERT_EQ(seen.size(), 1U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[0][i], expected[i], 1e-6) << i;
  };
  expect_xyz({1, 2, 4});
  film.metadata["channel.X"] = "quantum, electrons per m^2";
  EXPECT_TRUE(tristimuli(film).empty());
  film.metadata["to_xyz_d65"] = "0.95 0 0 0 0.5 0.5 0 0 1.09";
  expect_xyz({0.95, 3, 4.36});
  film.metadata["channel.X"] = "photometric, lx s";
  expect_xyz({1, 2, 4});
}

// The published pairs [Sharma2005] as the pixels of two images, after a white pixel. Pairs 10 and 14 are
// omitted: their hues differ by 180 degrees, so that the rounding of pixels selects a branch of the formula.
TEST(Compare, SharmasPairsDifferAsPublished) {
  const ReferenceTable table("ciede2000_sharma2005");
  const XYZ white = unit_xyz(kD65);
  std::array<std::vector<std::pair<std::string, std::vector<float>>>, 2> pixels;
  std::vector<double> expected{0};
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      pixels.at(k).push_back({std::string(1, "XYZ"[i]), {static_cast<float>(white[i])}});
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (const std::string& pair = table.text(row, "pair"); pair == "10" || pair == "14") continue;
    expected.push_back(table.number(row, "dE00"));
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string number = std::to_string(k + 1);
      const XYZ xyz = lab_to_xyz(
          {table.number(row, "L" + number), table.number(row, "a" + number), table.number(row, "b" + number)},
          white);
      for (std::size_t i = 0; i < 3; ++i) pixels.at(k)[i].second.push_back(static_cast<float>(xyz[i]));
    }
  }
  const Comparison c = compare_images(image(pixels[1]), image(pixels[0]));
  ASSERT_TRUE(c.color);
  ASSERT_EQ(c.color->pixels.size(), 33U);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(c.color->pixels[i], expected[i], 3e-4) << i;
}

TEST(Compare, GreyOfLinearSrgbDiffersInLightnessAlone) {
  // For a white of 1: L* of Y = 0.25 and 0.5, and CIEDE2000 of that step on the neutral axis.
  const std::vector<float> reference{1, 0.25F};
  const std::vector<float> changed{1, 0.5F};
  const Comparison c = compare_images(image({{"R", changed}, {"G", changed}, {"B", changed}}),
                                      image({{"R", reference}, {"G", reference}, {"B", reference}}));
  const double l1 = 116 * std::cbrt(0.25) - 16;
  const double l2 = 116 * std::cbrt(0.5) - 16;
  const double m = std::pow((l1 + l2) / 2 - 50, 2);
  ASSERT_TRUE(c.color);
  EXPECT_NEAR(c.color->max, (l2 - l1) / (1 + 0.015 * m / std::sqrt(20 + m)), 1e-6);
}

// Every value is off by 0.5 from a reference whose own variance is 0.05.
TEST(RelMse, KnownAnswerWithFloorVarianceAndWeights) {
  const Image reference =
      image({{"R", {1, 2}}, {"G", {2, 3}}, {"Variance.R", {0.05F, 0.05F}}, {"Variance.G", {0.05F, 0.05F}}});
  const Image noisy = image({{"R", {1.5F, 1.5F}}, {"G", {2.5F, 2.5F}}});
  const double v = 0.05F;
  const auto expected = [](double taken, double floor) {
    const double d = 0.25 - taken;
    const double m2 = 4 * floor;  // the mean is 2
    return (d / (1 + m2) + 2 * d / (4 + m2) + d / (9 + m2)) / 4;
  };
  EXPECT_DOUBLE_EQ(rel_mse(noisy, reference), expected(0, 0.01));
  EXPECT_DOUBLE_EQ(rel_mse(noisy, reference, {.floor = 0.0025}), expected(0, 0.0025));
  EXPECT_DOUBLE_EQ(rel_mse(noisy, reference, {.subtract_variance = true}), expected(v, 0.01));
  EXPECT_DOUBLE_EQ(rel_mse(noisy, reference, {.relative = 0, .floor = 1}), 0.25 / 4);
  EXPECT_LT(rel_mse(reference, reference, {.subtract_variance = true}), 0);
}

TEST(RelativeErrors, TheirMeanSquareIsTheRelMse) {
  const Image a = image({{"Y", {1, 2, 4, 0}}});
  const Image b = image({{"Y", {1, 3, 3, 1}}});
  double squares = 0;
  for (const double error : relative_errors(a, b)) squares += error * error / 4;
  EXPECT_NEAR(squares, rel_mse(a, b), 1e-12);
  EXPECT_EQ(relative_errors(a, b)[0], 0);
}

TEST(RelMse, TrimLeavesTheLargestQuotientsOut) {
  std::vector<float> values(2000, 1.0F);
  const Image reference = image({{"Y", values}});
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i < 2 ? 100.0F : 1.5F;
  const Image fireflies = image({{"Y", values}});
  EXPECT_NEAR(rel_mse(fireflies, reference, {.trim = 0.001}), 0.25 / 1.01, 1e-12);
  EXPECT_NEAR(rel_mse(fireflies, reference), (2 * 9801.0 + 1998 * 0.25) / 2000 / 1.01, 1e-9);
}

TEST(RelMse, RefusesAReferenceWithoutVariance) {
  EXPECT_THROW(
      static_cast<void>(rel_mse(image({{"Y", {1}}}), image({{"Y", {1}}}), {.subtract_variance = true})),
      Error);
}

TEST(RelMse, RefusesAReferenceOfInfiniteVariance) {
  const Image lamp = image({{"Y", {2e21F}}, {"Variance.Y", {std::numeric_limits<float>::infinity()}}});
  EXPECT_EQ(rel_mse(lamp, lamp), 0);
  EXPECT_THROW(static_cast<void>(rel_mse(lamp, lamp, {.subtract_variance = true})), Error);
}

TEST(Compare, RefusesValuesOfDifferentUnits) {
  const auto in = [](const char* key, const char* unit) {
    Image film = image({{"R", {1, 2}}, {"raw", {1, 2}}});
    if (*unit != 0) film.metadata[key] = unit;
    return film;
  };
  const Image joules = in("channel.R", "energy, response-weighted J per m^2");
  const Image electrons = in("channel.R", "quantum, electrons per m^2");
  const Image spectral = image({{"S0.500,000000nm", {1, 2}}, {"S0.600,000000nm", {1, 2}}, {"R", {1, 2}}});
  const auto compared = [](const Image& a, const Image& b) {
    try {
      return fmt::format("{}", compare_images(a, b).rmse);
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(compared(joules, electrons),
            "the images differ in the unit of channel R (got \"energy, response-weighted J per m^2\" and "
            "\"quantum, electrons per m^2\")");
  EXPECT_NE(compared(spectral, joules).find("(got \"preview, cd per m^2\" and \"energy"), std::string::npos);
  EXPECT_EQ(compared(joules, joules), "0");
  EXPECT_EQ(compared(spectral, spectral), "0");
  EXPECT_EQ(compared(in("", ""), electrons), "0") << "of a renderer that tells none";
}

TEST(Compare, RefusesMosaicsThatCountDifferentUnits) {
  const auto mosaic = [](const char* unit) {
    Image film = image({{"raw", {1, 2}}});
    film.metadata = {{"mosaic", "R,G"},
                     {"mosaic_channels", "R,G"},
                     {"sensor_channels", "raw"},
                     {"channel.R", "quantum, electrons per m^2"},
                     {"channel.G", unit}};
    return film;
  };
  const Image electrons = mosaic("quantum, electrons per m^2");
  EXPECT_EQ(compare_images(electrons, electrons).rmse, 0);
  EXPECT_THROW((void)compare_images(mosaic("energy, response-weighted J per m^2"), electrons), Error);
}

TEST(Compare, AUnitThatOneImageTellsIsNamed) {
  const Image plain = image({{"QE", {1}}});
  Image film = plain;
  film.metadata["channel.QE"] = "quantum, electrons per m^2";
  EXPECT_EQ(channel_with_undeclared_unit(film, plain), "QE");
  EXPECT_EQ(channel_with_undeclared_unit(plain, film), "QE");
  EXPECT_FALSE(channel_with_undeclared_unit(film, film));
  EXPECT_FALSE(channel_with_undeclared_unit(plain, plain));
}

TEST(Compare, WhatStandsBesideFilmsIsNotMissed) {
  Image film = image({{"QE", {1}}, {"Variance.QE", {1}}, {"depth.Z", {3}}, {"light.key.QE", {1}}});
  film.metadata["sensor_channels"] = "QE";
  EXPECT_FALSE(uncompared_channels(film, image({{"QE", {1}}, {"A", {1}}})));
  EXPECT_EQ(uncompared_channels(image({{"QE", {1}}, {"B", {1}}}), image({{"QE", {1}}, {"C", {1}}})),
            "channels that only one of the images has are not compared: B, C");
}

TEST(Compare, AValueThatIsNotFiniteIsSaidToBeWhose) {
  const Image sound = image({{"G", {1}}, {"R", {1}}});
  const Image faulty = image({{"G", {1}}, {"R", {NAN}}});
  const auto compared = [](const Image& a, const Image& b) {
    try {
      (void)compare_images(a, b);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(compared(faulty, sound), "the image has a value that is not finite (in channel R)");
  EXPECT_EQ(compared(sound, faulty), "the reference has a value that is not finite (in channel R)");
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(static_cast<void>(compare_images(image({{"Y", {1}}}), image({{"Y", {1, 2}}}))), Error);
  EXPECT_THROW(static_cast<void>(compare_images(image({{"Y", {1}}}), image({{"R", {1}}}))), Error);
  EXPECT_THROW(static_cast<void>(compare_images(image({{"Y", {NAN}}}), image({{"Y", {1}}}))), Error);
}

TEST(DeltaEChoice, EachFormulaIsItsOwn) {
  const Lab a{50, 50, 0};
  const Lab b{50, 60, 0};
  EXPECT_DOUBLE_EQ(delta_e(DeltaE::cie76, a, b), 10);
  EXPECT_NEAR(delta_e(DeltaE::cie94, a, b), 10 / 3.25, 1e-12);
  EXPECT_NEAR(delta_e(DeltaE::cie2000, {50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 5e-5);
}

TEST(DeltaEChoice, OfWhatIsNotFiniteIsUnknown) {
  const Lab finite{50, 2, -79};
  for (const double v : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    for (const DeltaE formula :
         {DeltaE::cie2000, DeltaE::cie94, DeltaE::cie76, DeltaE::cam16_ucs, DeltaE::itp}) {
      EXPECT_TRUE(std::isnan(delta_e(formula, {v, 0, 0}, finite)));
      EXPECT_TRUE(std::isnan(delta_e(formula, finite, {v, 0, 0})));
      EXPECT_TRUE(std::isnan(delta_e(formula, {v, 0, 0}, {v, 0, 0})));
    }
}

}  // namespace
}  // namespace abbe
