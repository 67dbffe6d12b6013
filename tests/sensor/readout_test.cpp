#include "sensor/readout/readout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>
#include <vector>

#include "io/error.h"
#include "sensor/random.h"
#include "sensor/readout/speed.h"
#include "spectral/library.h"

namespace abbe {
namespace {

std::vector<float> flat(std::size_t pixels, double electrons) {
  return std::vector<float>(pixels, static_cast<float>(electrons));
}

// The outputs published with the generator.
TEST(SplitMix64, GivesThePublishedNumbers) {
  SplitMix64 random(1234567);
  for (const std::uint64_t expected : {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                       4593380528125082431U, 16408922859458223821U})
    EXPECT_EQ(random(), expected);
}

// Cells of at least 20 expected pixels, those at both ends pooled.
double poisson_p_value(const std::vector<std::uint16_t>& codes, double mean) {
  const boost::math::poisson poisson(mean);
  const auto n = static_cast<double>(codes.size());
  std::vector<double> counts(65536, 0.0);
  for (const std::uint16_t code : codes) ++counts[code];
  double statistic = 0;
  int cells = 0;
  double expected = 0;
  double counted = 0;
  double left = n;
  for (unsigned k = 0; k < counts.size(); ++k) {
    expected += n * boost::math::pdf(poisson, k);
    counted += counts[k];
    if (expected < 20 || left - expected < 20) continue;
    statistic += (counted - expected) * (counted - expected) / expected;
    left -= expected;
    expected = counted = 0;
    ++cells;
  }
  statistic += (counted - left) * (counted - left) / left;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells), statistic));
}

TEST(Readout, PhotonsAreCountedAsPoissonSaid) {
  for (const double mean : {0.2, 3.0, 9.5, 11.0, 240.0})
    EXPECT_GT(poisson_p_value(read_out({}, flat(200000, mean), {}).dn, mean), 1e-4) << mean;
}

TEST(Readout, DarkElectronsArePhotonsThatNobodySent) {
  Readout readout;
  readout.dark_e_per_s = 40;
  EXPECT_GT(poisson_p_value(read_out(readout, flat(200000, 2), {0.25}).dn, 12), 1e-4);
  EXPECT_GT(poisson_p_value(read_out(readout, flat(200000, -3), {0.25}).dn, 10), 1e-4)
      << "negative expectations count as none";
}

TEST(Readout, EachPixelIsAFunctionOfItsOwnElectronsSeedAndFrame) {
  Readout readout;
  readout.read_noise_e = 5;
  readout.offset_dn = 100;
  readout.prnu_percent = 1;
  const std::vector<std::uint16_t> dn = read_out(readout, flat(1000, 500), {1, 7, 2}).dn;
  std::vector<float> other = flat(1000, 500);
  other[10] = 90000;
  std::vector<std::uint16_t> changed = read_out(readout, other, {1, 7, 2}).dn;
  EXPECT_NE(changed[10], dn[10]);
  changed[10] = dn[10];
  EXPECT_EQ(changed, dn);
  EXPECT_EQ(read_out(readout, flat(20, 500), {1, 7, 2}).dn,
            std::vector<std::uint16_t>(dn.begin(), dn.begin() + 20));
  for (const Exposure& exposure : {Exposure{1, 8, 2}, Exposure{1, 7, 3}})
    EXPECT_NE(read_out(readout, flat(1000, 500), exposure).dn, dn);
}

// Frames of bright light with a noise of one thousandth. The remaining deviation of their mean is the
// pattern.
TEST(Readout, FixedPatternsStayFromExposureToExposureAndBelongToTheSpecimen) {
  Readout readout;
  readout.prnu_percent = 2;
  readout.dsnu_e = 30;
  readout.gain_e_per_dn = 10;
  readout.offset_dn = 1000;
  const auto pattern = [&](double electrons, std::uint64_t seed) {
    std::vector<double> values;
    for (const std::uint16_t dn : read_out(readout, flat(20000, electrons), {1, seed}).dn)
      values.push_back(electrons_of(readout, dn) - electrons);
    return values;
  };
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
    double ab = 0;
    double aa = 0;
    double bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ab += a[i] * b[i];
      aa += a[i] * a[i];
      bb += b[i] * b[i];
    }
    return ab / std::sqrt(aa * bb);
  };
  const std::vector<double> bright = pattern(500000, 1);
  const std::vector<double> dark = pattern(0, 1);
  EXPECT_GT(correlation(bright, pattern(500000, 2)), 0.99);
  EXPECT_GT(correlation(dark, pattern(0, 2)), 0.98);
  EXPECT_LT(std::abs(correlation(bright, dark)), 0.03) << "sensitivity and offset are independent";
  readout.serial = 1;
  EXPECT_LT(std::abs(correlation(bright, pattern(500000, 1))), 0.03);
}

TEST(Readout, CodesAreRoundedAndCutAndSaturationIsMarked) {
  Readout readout;
  readout.bits = 8;
  readout.gain_e_per_dn = 1e6;  // so large that photon noise is below half a code
  readout.offset_dn = 10;
  const std::vector<float> electrons{0, 0.4e6F, 0.6e6F, 200e6F, 244.4e6F, 246e6F, 900e6F};
  const RawFrame frame = read_out(readout, electrons, {});
  EXPECT_EQ(frame.dn, (std::vector<std::uint16_t>{10, 10, 11, 210, 254, 255, 255}));
  EXPECT_EQ(frame.saturated, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 1}));
  readout.full_well_e = 100e6;
  const RawFrame shallow = read_out(readout, electrons, {});
  EXPECT_EQ(shallow.dn, (std::vector<std::uint16_t>{10, 10, 11, 110, 110, 110, 110}));
  EXPECT_EQ(shallow.saturated, (std::vector<std::uint8_t>{0, 0, 0, 1, 1, 1, 1}));
  readout.read_noise_e = 20e6;
  readout.offset_dn = 0;
  const RawFrame noisy = read_out(readout, flat(1000, 0), {});
  const auto zeros = std::count(noisy.dn.begin(), noisy.dn.end(), 0);
  EXPECT_NEAR(static_cast<double>(zeros), 510, 80) << "what falls below 0 is cut, about half of it";
}

TEST(Readout, TheResponseCurveBendsSharesOfTheCodesAboveTheOffset) {
  Readout readout;
  readout.bits = 8;
  readout.gain_e_per_dn = 1e6;
  readout.offset_dn = 15;  // 240 codes above it
  readout.response_curve = MonotoneCurve({{0, 0}, {0.25, 0.5}, {1, 1}});
  const std::vector<float> electrons{0, 30e6F, 60e6F, 120e6F, 180e6F, 300e6F};
  const std::vector<std::uint16_t> expected{15, 75, 135, 175, 215, 255};
  EXPECT_EQ(read_out(readout, electrons, {}).dn, expected);
  for (std::size_t i = 0; i + 1 < electrons.size(); ++i)
    EXPECT_NEAR(electrons_of(readout, expected[i]), static_cast<double>(electrons[i]), 1) << i;
  readout.response_curve = {};
  EXPECT_DOUBLE_EQ(electrons_of(readout, 75), 60e6);
}

TEST(Readout, CodesEndWhereTheySaturate) {
  Readout readout;
  readout.bits = 12;
  readout.gain_e_per_dn = 1e4;
  readout.saturation_dn = 3000;
  const RawFrame frame = read_out(readout, std::array{2.5e7F, 3.5e7F}, {});
  EXPECT_NEAR(frame.dn[0], 2500, 3);
  EXPECT_EQ(frame.dn[1], 3000);
  EXPECT_EQ(frame.saturated, (std::vector<std::uint8_t>{0, 1}));
}

// The white level of files is valid for any noise added to a full well.
TEST(Readout, SaturatedPixelsReachTheWhiteLevel) {
  Readout readout;
  readout.bits = 12;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 100;
  readout.full_well_e = 7500;
  EXPECT_EQ(white_level(readout), 3850);
  readout.read_noise_e = 10;
  readout.row_noise_e = 4;
  readout.dsnu_e = 3;
  const RawFrame frame = read_out(readout, flat(20000, 1e4), {1, 5, 0, 100});
  EXPECT_EQ(std::count(frame.saturated.begin(), frame.saturated.end(), 1), 20000);
  const double white = white_level(readout);
  EXPECT_GE(*std::min_element(frame.dn.begin(), frame.dn.end()), white);
  EXPECT_EQ(white, std::floor(3850 - 6 * std::sqrt(125.0) / 2 + 0.5));
  readout.full_well_e = 100;
  EXPECT_EQ(white_level(readout), 100 + 25) << "that of half a well, where noise hides it";
}

TEST(Readout, TheHighestCodeIsAWholeNumber) {
  Readout readout;
  readout.saturation_dn = 100.7;
  EXPECT_EQ(readout.highest_code(), 100);
  EXPECT_EQ(white_level(readout), 100);
  const RawFrame frame = read_out(readout, std::array{1e4F}, {});
  EXPECT_EQ(frame.dn[0], 100);
  EXPECT_EQ(frame.saturated[0], 1);
}

TEST(Readout, RowsShareTheirNoise) {
  Readout readout;
  readout.offset_dn = 1000;
  readout.row_noise_e = 20;
  const std::size_t width = 50;
  const std::size_t rows = 2000;
  const std::vector<std::uint16_t> dn = read_out(readout, flat(width * rows, 0), {1, 3, 0, width}).dn;
  double squares = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    squares += std::pow(dn[row * width] - 1000.0, 2);
    for (std::size_t x = 1; x < width; ++x) ASSERT_EQ(dn[row * width + x], dn[row * width]);
  }
  EXPECT_NEAR(std::sqrt(squares / rows), 20, 5 * 20 / std::sqrt(2.0 * rows));
  EXPECT_NE(dn, read_out(readout, flat(width * rows, 0), {1, 3, 1, width}).dn) << "anew in each exposure";
  readout.read_noise_e = 5;
  EXPECT_DOUBLE_EQ(temporal_noise(readout, 0, 0).total_e, std::sqrt(425 + 1.0 / 12));
}

TEST(Readout, HotPixelsHaveADarkCurrentOfTheirOwn) {
  Readout readout;
  readout.hot_pixels_percent = 2;
  readout.hot_pixel_e_per_s = 1000;
  const std::size_t n = 200000;
  const std::vector<std::uint16_t> brief = read_out(readout, flat(n, 0), {1, 1}).dn;
  const std::vector<std::uint16_t> longer = read_out(readout, flat(n, 0), {4, 2}).dn;
  double hot = 0;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    hot += longer[i] > 0 ? 1 : 0;
    sum += longer[i];
    if (brief[i] <= 100) continue;
    ASSERT_NEAR(longer[i], 4.0 * brief[i], 12 * std::sqrt(longer[i])) << "the same pixels";
  }
  EXPECT_NEAR(hot / static_cast<double>(n), 0.02, 0.002);
  EXPECT_NEAR(sum / hot / 4000, 1, 0.08);  // five deviations of the mean of 4000 exponential numbers
}

TEST(Readout, WhatAWellCannotHoldFlowsAlongItsColumn) {
  Readout readout;
  readout.full_well_e = 1e7;
  readout.gain_e_per_dn = 1e6;
  readout.bits = 8;
  readout.blooming = true;
  std::vector<float> electrons(3 * 9, 0.0F);
  electrons[1 + 3 * 4] = 50e6F;  // 40 million electrons too many in the center of the central column
  const RawFrame frame = read_out(readout, electrons, {1, 0, 0, 3});
  const auto column = [&](std::size_t x) {
    std::vector<int> codes;
    for (std::size_t y = 0; y < 9; ++y) codes.push_back(frame.dn[3 * y + x]);
    return codes;
  };
  EXPECT_EQ(column(1), (std::vector<int>{0, 0, 10, 10, 10, 10, 10, 0, 0}));
  EXPECT_EQ(column(0), std::vector<int>(9, 0));
  EXPECT_EQ(std::count(frame.saturated.begin(), frame.saturated.end(), 1), 5);
  readout.blooming = false;
  EXPECT_EQ(read_out(readout, electrons, {1, 0, 0, 3}).dn[1 + 3 * 3], 0);
}

TEST(Readout, ACurveThatDoesNotIncreaseIsABug) {
  EXPECT_THROW(MonotoneCurve({{0, 0}, {0.5, 0.5}, {0.5, 0.7}}), Error);
  EXPECT_THROW(MonotoneCurve({{0, 0}, {0.5, 0.5}, {0.7, 0.5}}), Error);
  EXPECT_THROW(MonotoneCurve({{0, 0}}), Error);
}

TEST(Readout, ElectronsThatAreNoNumberAreRefused) {
  for (const float bad : {std::nanf(""), INFINITY, 2e15F}) try {
      const RawFrame frame = read_out({}, std::array{1.0F, bad}, {});
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input);
      EXPECT_NE(std::string(error.what()).find("pixel 1 expects"), std::string::npos) << error.what();
    }
}

// Above 2^63 electrons a full pixel used to be dark.
TEST(Readout, DarkSignalsAreBoundedAsLightIs) {
  Readout readout;
  readout.full_well_e = 2e4;
  readout.dark_e_per_s = 1e12;
  const RawFrame full = read_out(readout, std::array{1.0F}, {999});
  EXPECT_EQ(full.dn[0], 20000);
  EXPECT_EQ(full.saturated[0], 1);
  for (const double seconds : {1000.1, 1e8}) try {
      const RawFrame frame = read_out(readout, std::array{1.0F}, {seconds});
      ADD_FAILURE() << seconds;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input);
      const std::string said = error.what();
      EXPECT_NE(said.find("electrons with its dark signal (allowed up to 1e15)"), std::string::npos) << said;
    }
}

TEST(Readout, BlackIsOffsetAndDarkSignalUnlessThatSaturates) {
  Readout readout;
  readout.bits = 12;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 50;
  readout.dark_e_per_s = 1000;
  readout.full_well_e = 6000;
  EXPECT_DOUBLE_EQ(black_level(readout, 0), 50);
  EXPECT_DOUBLE_EQ(black_level(readout, 0.5), 300);
  EXPECT_DOUBLE_EQ(black_level(readout, 5), 2550);
  EXPECT_DOUBLE_EQ(black_level(readout, 6), 50);
  readout.response_curve = MonotoneCurve({{0, 0}, {0.5, 0.8}, {1, 1}});
  EXPECT_DOUBLE_EQ(black_level(readout, 0.5), 300) << "on a straight line";
}

TEST(Readout, TemporalNoiseIsWhatPairsOfFramesShow) {
  Readout readout;
  readout.gain_e_per_dn = 20;
  readout.offset_dn = 50;
  readout.read_noise_e = 15;
  readout.dark_e_per_s = 300;
  readout.prnu_percent = 3;
  readout.dsnu_e = 40;
  const TemporalNoise noise = temporal_noise(readout, 900, 2);
  EXPECT_DOUBLE_EQ(noise.photon_e, 30);
  EXPECT_DOUBLE_EQ(noise.dark_e, std::sqrt(600.0));
  const std::size_t n = 200000;
  const std::vector<std::uint16_t> a = read_out(readout, flat(n, 900), {2, 0, 0}).dn;
  const std::vector<std::uint16_t> b = read_out(readout, flat(n, 900), {2, 0, 1}).dn;
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(static_cast<double>(a[i]) - b[i], 2);
  const double measured_e = std::sqrt(squares / 2 / static_cast<double>(n)) * readout.gain_e_per_dn;
  EXPECT_NEAR(noise.total_e / measured_e, 1, 0.008);  // five deviations of the estimate
}

// A constant quantum efficiency of 1 and light of one wavelength give closed-form results.
TEST(Readout, TheSaturationSpeedFollowsIso12232) {
  Diagnostics diagnostics;
  const auto daylight = load_curve("illuminant", "D55", {}, diagnostics);
  ASSERT_TRUE(daylight) << diagnostics.text();
  Readout readout;
  readout.bits = 12;
  readout.gain_e_per_dn = 10;
  readout.offset_dn = 95;  // 4000 codes of 10 electrons
  readout.full_well_e = 30000;
  const std::vector channels{quantum_channel("dim", Curve(0.1)), quantum_channel("bright", Curve(0.5))};
  const double area = gathering_area(5e-6, 0.8);
  // Electrons/m^2 of the brighter channel for 1 lx s of daylight.
  const double per_lx_s =
      integral_of_product(daylight->curve, channels[1].weight) / photometric(daylight->curve);
  const double saturating_lx_s = 30000 / area / per_lx_s;
  const double sensitivity = daylight_sensitivity(channels, area).value();
  EXPECT_NEAR(saturation_speed(readout, sensitivity), 78 / saturating_lx_s, 1e-9);
  const std::vector longer{exposed(channels[1], 4)};  // its exposure in lx s is longer too
  EXPECT_NEAR(daylight_sensitivity(longer, area).value() / sensitivity, 1, 1e-9);
  readout.full_well_e = 60000;  // now the codes end first
  EXPECT_NEAR(saturation_speed(readout, sensitivity), 78 / saturating_lx_s * 0.75, 1e-9);
  // 1 lx s of daylight up to 830 nm is 5.51 mJ/m^2 or 1.635e16 photons/m^2, of which this pixel counts
  // 1.635e5.
  EXPECT_NEAR(78 / saturating_lx_s, 425.02, 0.05);
}

}  // namespace
}  // namespace abbe
