#include "sensor/readout/photon_transfer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"
#include "sensor/readout/readout.h"
#include "tests/tier.h"

namespace abbe {
namespace {

constexpr std::size_t kPixels = 1000000;

/// Pairs of simulated flats, one expected frame per pair.
struct Flats {
  const Readout& readout;
  std::deque<RawFrame> frames = {};
  std::vector<FlatPair> pairs = {};
  std::uint32_t frame = 0;
  std::size_t pixels = kPixels;

  void add(double electrons, double exposure_s) {
    add(std::vector<float>(pixels, static_cast<float>(electrons)), exposure_s);
  }
  void add(const std::vector<float>& expected, double exposure_s) {
    for (int i = 0; i < 2; ++i) frames.push_back(read_out(readout, expected, {exposure_s, 20, frame++}));
    pairs.push_back({exposure_s, frames[frames.size() - 2].dn, frames.back().dn});
  }
};

struct Bench {
  Flats dark;
  Flats lit;
};
Bench measure(const Readout& readout, double saturation_e) {
  Bench bench{{readout}, {readout}};
  for (const double seconds : {0.01, 20.0}) bench.dark.add(0, seconds);
  bench.lit.frame = 100;
  for (const double share : {0.35, 0.5, 0.65, 1.6}) bench.lit.add(share * saturation_e, 0.01);
  return bench;
}

PhotonTransfer transfer(const Bench& bench, int bits) {
  return photon_transfer(bench.dark.pairs, bench.lit.pairs, bits);
}

// With 16 electrons per code the read noise is half a code, so that a quarter of the dark variance is
// rounding.
TEST(PhotonTransfer, CoarseCodesNeedTheVarianceOfRounding) {
  Readout readout;
  readout.gain_e_per_dn = 16;
  readout.bits = 12;
  readout.offset_dn = 50;
  readout.read_noise_e = 8;
  readout.dsnu_e = 8;            // spreads the pixels over the steps, so that rounding acts as noise
  readout.full_well_e = 100000;  // above the range of 12 bits
  const double most_e = electrons_of(readout, readout.highest_code());
  const PhotonTransfer found = transfer(measure(readout, most_e), readout.bits);
  EXPECT_NEAR(found.gain_e_per_dn / readout.gain_e_per_dn, 1, 0.005);
  EXPECT_NEAR(found.read_noise_e / readout.read_noise_e, 1, 0.005);
  EXPECT_GT(std::hypot(found.read_noise_e, readout.gain_e_per_dn / std::sqrt(12)) / readout.read_noise_e, 1.1)
      << "the rounding would have shown";
  EXPECT_FALSE(found.full_well_e) << "the codes end before the well is full";
  EXPECT_NEAR(found.saturation_e.value() / most_e, 1, 0.01);
}

TEST(PhotonTransfer, AWellThatIsNotFilledIsNotKnown) {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 50;
  readout.read_noise_e = 8;
  Bench bench{{readout}, {readout}};
  for (const double seconds : {1.0, 2.0}) bench.dark.add(0, seconds);
  for (const double electrons : {1000.0, 2000.0}) bench.lit.add(electrons, 1);
  const PhotonTransfer found = transfer(bench, readout.bits);
  EXPECT_FALSE(found.full_well_e);
  EXPECT_FALSE(found.saturation_e);
  readout.full_well_e = 4000;
  bench.lit.add(6000, 1);
  const PhotonTransfer filled = transfer(bench, readout.bits);
  EXPECT_NEAR(filled.full_well_e.value(), 4000, 40);
  EXPECT_EQ(filled.saturation_e, filled.full_well_e);
}

// 240 codes of 5/3 DN each up to half of the signal, and of 5/7 DN above.
Readout curved(double gain_e_per_dn, double read_noise_e) {
  Readout readout;
  readout.gain_e_per_dn = gain_e_per_dn;
  readout.bits = 8;
  readout.offset_dn = 15;
  readout.read_noise_e = read_noise_e;
  readout.response_curve = MonotoneCurve({{0, 0}, {0.5, 0.3}, {1, 1}});
  return readout;
}

TEST(CodeLevels, AreTheSignalsThatACurveMakesOneCodeOf) {
  const std::vector<CodeLevel> levels = code_levels(curved(20, 20));
  const auto expect = [&](std::size_t code, double low, double high) {
    EXPECT_NEAR(levels[code].signal_dn, (low + high) / 2, 1e-9) << code;
    EXPECT_NEAR(levels[code].rounding_dn2, (high - low) * (high - low) / 12, 1e-9) << code;
  };
  expect(15, 15 - 5.0 / 6, 15 + 5.0 / 6);
  expect(17, 15 + 5.0 / 6, 15 + 15.0 / 6);                // code 16, 16.67 on a straight line
  expect(135, 135 - 5.0 / 6, 135 + 5.0 / 14);             // at the bend of the curve
  expect(139, 135 + 5.0 / 7 * 4.5, 135 + 5.0 / 7 * 6.5);  // codes 92 and 93
  expect(16, 15.5, 16.5);                                 // no code
  Readout deep = curved(20, 20);
  deep.offset_dn = 51;
  const CodeLevel lowest = code_levels(deep)[0];
  EXPECT_NEAR(lowest.signal_dn, 51 - 5.0 / 3 * 31, 1e-9) << "of 20; what is below is cut off at 0 as well";
  EXPECT_NEAR(lowest.rounding_dn2, 25.0 / 9 / 12, 1e-9);
}

TEST(CodeLevels, OfAStraightResponseAreTheCodes) {
  const std::vector<CodeLevel> levels = code_levels({});
  ASSERT_EQ(levels.size(), 65536U);
  for (const std::size_t code : {0U, 1000U, 65535U}) {
    EXPECT_EQ(levels[code].signal_dn, static_cast<double>(code));
    EXPECT_EQ(levels[code].rounding_dn2, 1.0 / 12);
  }
}

// Levels for pairs whose codes are linearised like raw files.
PhotonTransfer straightened_transfer(const Readout& readout) {
  const double most_e = electrons_of(readout, readout.highest_code());
  const std::vector<std::uint16_t> straight = linear_codes(readout);
  Bench bench{{readout}, {readout}};
  bench.dark.pixels = bench.lit.pixels = 100000;
  bench.lit.frame = 100;
  for (const double seconds : {0.01, 1.0}) bench.dark.add(0, seconds);
  for (const double share : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.6})
    bench.lit.add(share * most_e, 0.01);
  for (Flats* flats : {&bench.dark, &bench.lit})
    for (RawFrame& frame : flats->frames)
      for (std::uint16_t& code : frame.dn) code = straight.empty() ? code : straight[code];
  return photon_transfer(bench.dark.pairs, bench.lit.pairs, readout.bits, code_levels(readout));
}

void expect_within_errors(const Readout& readout, const PhotonTransfer& found) {
  constexpr double kStandardErrors = 2.58;  // 99 %
  EXPECT_NEAR(found.gain_e_per_dn, readout.gain_e_per_dn, kStandardErrors * found.gain_standard_error);
  EXPECT_NEAR(found.read_noise_e, readout.read_noise_e,
              kStandardErrors * found.read_noise_standard_error.value());
}

// A code that is 5/3 DN wide adds a rounding variance of 2.8 times 1/12 DN^2.
TEST(PhotonTransfer, CodesOfAResponseCurveTellThePlantedSensor) {
  Readout readout = curved(20, 20);
  const PhotonTransfer coarse = straightened_transfer(readout);
  expect_within_errors(readout, coarse);
  EXPECT_LT(coarse.gain_standard_error, 0.005 * readout.gain_e_per_dn);
  EXPECT_LT(coarse.read_noise_standard_error.value(), 0.01 * readout.read_noise_e);
  readout.response_curve = MonotoneCurve({{0, 0}, {0.1, 0.4}, {0.4, 0.55}, {1, 1}});
  readout.read_noise_e = 30;
  const PhotonTransfer fine = straightened_transfer(readout);
  expect_within_errors(readout, fine);
  EXPECT_LT(fine.gain_standard_error, 0.005 * readout.gain_e_per_dn);
}

// 8 electrons are 0.4 codes. The mean of darkness lies on a code, where rounding adds less than 1/12 DN^2.
TEST(PhotonTransfer, NoiseThatIsNarrowerThanACodeIsKnownLess) {
  Readout readout;
  readout.gain_e_per_dn = 20;
  readout.bits = 8;
  readout.offset_dn = 15;
  readout.read_noise_e = 8;
  const PhotonTransfer narrow = straightened_transfer(readout);
  EXPECT_LT(narrow.read_noise_e, 7.5);
  expect_within_errors(readout, narrow);
  readout.read_noise_e = 5;
  readout.dsnu_e = 20;  // with these, part of the rounding error is the same in both exposures
  const PhotonTransfer patterned = straightened_transfer(readout);
  EXPECT_LT(patterned.read_noise_e, 4.9);
  expect_within_errors(readout, patterned);
}

// Pure noise gives an arbitrary gain, which its standard error rejects.
TEST(PhotonTransfer, LitPairsThatAreDarkAreRefused) {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 50;
  readout.read_noise_e = 8;
  for (std::uint32_t series = 0; series < 20; ++series) {
    Flats dark{readout};
    Flats lit{readout};
    dark.frame = 1000 * series;
    lit.frame = dark.frame + 100;
    dark.pixels = lit.pixels = 10000;
    for (const double seconds : {0.01, 20.0}) dark.add(0, seconds);
    for (int i = 0; i < 3; ++i) lit.add(0, 0.01);
    EXPECT_THROW((void)photon_transfer(dark.pairs, lit.pairs, readout.bits), Error) << series;
  }
}

// One pixel in a thousand has an additional dark current of 1000 e/s, fills its well in the longest dark
// exposure, and dominates the patterns of all others.
Readout with_hot_pixels() {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.bits = 12;
  readout.offset_dn = 100;
  readout.full_well_e = 7500;
  readout.read_noise_e = 5;
  readout.dark_e_per_s = 5;
  readout.prnu_percent = 1;
  readout.dsnu_e = 2;
  readout.hot_pixels_percent = 0.1;
  readout.hot_pixel_e_per_s = 1000;
  return readout;
}

// Illuminated pairs that fill these fractions of a well of 7500 electrons.
Bench flats(const Readout& readout, const std::vector<double>& dark_s, double lit_s,
            const std::vector<double>& lit, std::size_t pixels = 65536) {
  Bench bench{{readout}, {readout}};
  bench.dark.pixels = bench.lit.pixels = pixels;
  bench.lit.frame = 100;
  for (const double seconds : dark_s) bench.dark.add(0, seconds);
  for (const double share : lit) bench.lit.add(share * 7500, lit_s);
  return bench;
}

// Hot pixels contribute to the pattern of darkness as long as the illuminated exposures, but not to that of
// short exposures. 65536 pixels determine PRNU within 0.8 % and DSNU within 3 %, as standard deviations.
TEST(PhotonTransfer, HotPixelsAreNoPatternOfLightOrOffsets) {
  const Readout readout = with_hot_pixels();
  for (const std::vector<double>& dark_s : std::vector<std::vector<double>>{
           {0.01, 10}, {1, 10}, {0.01, 1}, {0.1, 0.2, 0.5, 2, 4}, {0.01, 0.01, 1, 1}}) {
    const Bench bench = flats(readout, dark_s, 1, {0.05, 0.2, 0.35, 0.5, 0.65, 1.3});
    const PhotonTransfer found = transfer(bench, readout.bits);
    EXPECT_NEAR(found.prnu_percent, readout.prnu_percent, 0.03) << dark_s.front() << " to " << dark_s.back();
    EXPECT_NEAR(found.dsnu_e, readout.dsnu_e, 0.25) << dark_s.front() << " to " << dark_s.back();
    expect_within_errors(readout, found);
  }
}

// The code of full wells identifies the pixels that fill up in long darkness. Pixels that fill up only with
// light lack room for the darkness of that time, from dark pairs of that time or from the line through
// others.
TEST(PhotonTransfer, HotPixelsThatFillTheWellUnseenAreNoPattern) {
  struct Series {
    double hot_percent;
    std::vector<double> dark_s;
    double lit_s;
    std::vector<double> lit;
    int bits;
  };
  for (const auto& [hot_percent, dark_s, lit_s, lit, bits] :
       {Series{0.1, {1, 10}, 1, {0.2, 0.8}, 14}, Series{1, {0.1, 10}, 10, {0.2, 0.5, 0.8, 1.5}, 14},
        Series{0.1, {1, 5}, 10, {0.2, 0.5, 0.8, 1.5}, 12}, Series{1, {0.1, 10}, 10, {0.2, 0.65, 0.9}, 12},
        Series{0, {0.1, 10}, 10, {0.02, 0.9, 0.94}, 12}, Series{1, {0.1, 10}, 10, {0.02, 0.9, 0.94}, 12}}) {
    Readout readout = with_hot_pixels();
    readout.bits = bits;
    readout.hot_pixels_percent = hot_percent;
    for (readout.serial = 1; readout.serial <= (test::nightly() ? 6U : 3U); ++readout.serial) {
      const Bench bench = flats(readout, dark_s, lit_s, lit);
      const auto white_dn = static_cast<std::uint16_t>(white_level(readout));
      const PhotonTransfer found =
          photon_transfer(bench.dark.pairs, bench.lit.pairs, bits, code_levels(readout), white_dn);
      const std::string at = fmt::format("{} % hot, {} s, serial {}", hot_percent, dark_s, readout.serial);
      EXPECT_NEAR(found.prnu_percent, readout.prnu_percent, 0.05) << at;
      EXPECT_NEAR(found.dsnu_e, readout.dsnu_e, 0.25) << at;
    }
  }
}

// White levels below the light, dark exposures longer than illuminated ones, extrapolated darkness; no pixel
// is hot.
TEST(PhotonTransfer, NoPixelIsLeftOutForWhatAllHave) {
  struct Series {
    double dark_e_per_s;
    std::vector<double> dark_s;
    double lit_s;
    std::vector<double> lit;
    std::uint16_t white_dn;
  };
  for (const auto& [dark_e_per_s, dark_s, lit_s, lit, white_dn] :
       {Series{5, {0.1, 10}, 1, {0.02, 0.9, 0.94}, 1000}, Series{300, {10, 20}, 0.1, {0.1, 0.65, 0.8}, 3800},
        Series{800, {5, 8}, 0.1, {0.05, 0.2, 0.5, 0.8}, 3800},
        Series{100, {10, 20}, 1, {0.02, 0.9, 0.94}, 3800},
        Series{5, {0.1, 0.2}, 10, {0.02, 0.9, 0.94}, 3800}}) {
    Readout readout = with_hot_pixels();
    readout.hot_pixels_percent = 0;
    readout.dark_e_per_s = dark_e_per_s;
    const Bench bench = flats(readout, dark_s, lit_s, lit, kPixels);
    const PhotonTransfer found =
        photon_transfer(bench.dark.pairs, bench.lit.pairs, readout.bits, code_levels(readout), white_dn);
    EXPECT_NEAR(found.prnu_percent, readout.prnu_percent, 0.1)
        << fmt::format("dark {} s, lit {} s", dark_s, lit_s);
  }
}

void expect_refusal(const std::vector<FlatPair>& dark, const std::vector<FlatPair>& lit,
                    const std::string& text) {
  try {
    (void)photon_transfer(dark, lit, 12);
    ADD_FAILURE() << "nothing is refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

// Illumination that falls off to a tenth, so that only the center fills the wells of the brightest pair.
TEST(PhotonTransfer, ShadedFlatsHaveTheGainOfEvenOnes) {
  const Readout readout = with_hot_pixels();
  Bench bench{{readout}, {readout}};
  bench.dark.pixels = 65536;
  bench.lit.frame = 100;
  for (const double seconds : {0.01, 10.0}) bench.dark.add(0, seconds);
  for (const double share : {0.05, 0.2, 0.35, 0.5, 0.65, 2.0, 3.0}) {
    std::vector<float> expected;
    for (std::size_t i = 0; i < bench.dark.pixels; ++i)
      expected.push_back(static_cast<float>(share * 7500 * std::pow(0.1, static_cast<double>(i) / 65536)));
    bench.lit.add(expected, 0.01);
  }
  const PhotonTransfer found = transfer(bench, readout.bits);
  EXPECT_NEAR(found.gain_e_per_dn, readout.gain_e_per_dn, 0.02);
  EXPECT_NEAR(found.dsnu_e, readout.dsnu_e, 0.25);
}

// The well holds twenty times the read noise.
TEST(PhotonTransfer, AWellOfFewElectronsLeavesNoPixelOut) {
  Readout readout = with_hot_pixels();
  readout.gain_e_per_dn = 1;
  readout.full_well_e = 200;
  readout.read_noise_e = 10;
  readout.dsnu_e = 15;
  readout.hot_pixels_percent = 0;
  Bench bench{{readout}, {readout}};
  bench.dark.pixels = bench.lit.pixels = 65536;
  bench.lit.frame = 100;
  for (const double seconds : {0.01, 1.0}) bench.dark.add(0, seconds);
  for (const double electrons : {20.0, 60.0, 100.0, 130.0, 260.0}) bench.lit.add(electrons, 0.01);
  const PhotonTransfer found = transfer(bench, readout.bits);
  EXPECT_NEAR(found.gain_e_per_dn, 1, 0.05);
  EXPECT_NEAR(found.read_noise_e, 10, 0.4);
  EXPECT_NEAR(found.dsnu_e, 15, 0.3);
}

// A line through dark pairs of similar times is noise at a distant time.
TEST(PhotonTransfer, DarknessIsNotExtrapolatedIntoNoise) {
  Readout readout = with_hot_pixels();
  readout.hot_pixels_percent = 0;
  for (const auto& [dark_s, lit_s] :
       {std::pair{std::vector{5.0, 6.0}, 0.01}, {{10.0, 10.5}, 0.01}, {{0.01, 1.0}, 100.0}}) {
    Bench bench{{readout}, {readout}};
    bench.dark.pixels = bench.lit.pixels = 65536;
    bench.lit.frame = 100;
    for (const double seconds : dark_s) bench.dark.add(0, seconds);
    for (const double share : {0.1, 0.2, 0.35, 0.5, 0.65, 1.3}) bench.lit.add(share * 7500, lit_s);
    const PhotonTransfer found = transfer(bench, readout.bits);
    EXPECT_NEAR(found.prnu_percent, 1, 0.1) << dark_s.front() << " s";
    EXPECT_NEAR(found.dsnu_e, 2, 0.2) << dark_s.front() << " s";
  }
}

// All wells are full in the longer dark exposure.
TEST(PhotonTransfer, FullDarkPairsAreRefused) {
  const Readout readout = with_hot_pixels();
  Bench bench{{readout}, {readout}};
  bench.dark.pixels = bench.lit.pixels = 4096;
  bench.lit.frame = 100;
  for (const double seconds : {0.01, 2000.0}) bench.dark.add(0, seconds);
  for (const double share : {0.2, 0.5, 1.3}) bench.lit.add(share * 7500, 0.01);
  expect_refusal(bench.dark.pairs, bench.lit.pairs, "all pixels of a dark pair are full");
}

TEST(PhotonTransfer, PairsThatDetermineNothingAreRefused) {
  const std::vector<std::uint16_t> a{10, 12, 11, 14};
  const std::vector<std::uint16_t> b{11, 12, 10, 13};
  const FlatPair pair{1, a, b};
  const FlatPair later{2, a, b};
  const FlatPair uneven{2, a, std::span(b).first(3)};
  const std::vector<FlatPair> none;
  const auto refused = [](std::vector<FlatPair> dark, std::vector<FlatPair> lit) {
    try {
      (void)photon_transfer(dark, lit, 12);
      return false;
    } catch (const Error& error) {
      return error.code == ErrorCode::input;
    }
  };
  EXPECT_TRUE(refused(none, {pair}));
  EXPECT_TRUE(refused({pair, later}, none));
  EXPECT_TRUE(refused({pair, pair}, {pair}));
  EXPECT_TRUE(refused({pair, uneven}, {pair}));
  EXPECT_TRUE(refused({pair, later}, {pair})) << "no light at all";
  const FlatPair smaller{1, std::span(a).first(3), std::span(b).first(3)};
  expect_refusal({pair, later}, {smaller}, "the frames have unequal sizes");
}

}  // namespace
}  // namespace abbe
