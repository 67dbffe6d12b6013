#include "sensor/readout/photon_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <vector>

#include "io/error.h"
#include "sensor/readout/readout.h"

namespace abbe {
namespace {

constexpr std::size_t kPixels = 1000000;

/// Pairs of simulated flats, each pair of one expected frame.
struct Flats {
  const Readout& readout;
  std::deque<RawFrame> frames = {};
  std::vector<FlatPair> pairs = {};
  std::uint32_t frame = 0;
  std::size_t pixels = kPixels;

  void add(double electrons, double exposure_s) {
    const std::vector<float> expected(pixels, static_cast<float>(electrons));
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
  readout.dsnu_e = 8;            // spreads the pixels over the steps, without which rounding is no noise
  readout.full_well_e = 100000;  // which 12 bits do not reach
  const double most_e = electrons_of(readout, readout.highest_code());
  const PhotonTransfer found = transfer(measure(readout, most_e), readout.bits);
  EXPECT_NEAR(found.gain_e_per_dn / readout.gain_e_per_dn, 1, 0.005);
  EXPECT_NEAR(found.read_noise_e / readout.read_noise_e, 1, 0.005);
  EXPECT_GT(std::hypot(found.read_noise_e, readout.gain_e_per_dn / std::sqrt(12)) / readout.read_noise_e, 1.1)
      << "the rounding would have shown";
  EXPECT_FALSE(found.full_well_e) << "the codes end before the well is full";
}

TEST(PhotonTransfer, AWellThatIsNotFilledIsNotKnown) {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 50;
  readout.read_noise_e = 8;
  Bench bench{{readout}, {readout}};
  for (const double seconds : {1.0, 2.0}) bench.dark.add(0, seconds);
  for (const double electrons : {1000.0, 2000.0}) bench.lit.add(electrons, 1);
  EXPECT_FALSE(transfer(bench, readout.bits).full_well_e);
}

// Noise alone gives some gain or other, which its standard error belies.
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
}

}  // namespace
}  // namespace abbe
