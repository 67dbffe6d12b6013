// Checks that the stated errors of measured noise and of patches have their nominal coverage.
#include <cmath>
#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "sensor/film/patch.h"
#include "sensor/readout/photon_transfer.h"
#include "sensor/readout/readout.h"

namespace abbe {
namespace {

constexpr int kSeeds = 100;
constexpr int kEdge = 96;

Readout sensor() {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.bits = 12;
  readout.offset_dn = 50;
  readout.read_noise_e = 6;
  readout.dark_e_per_s = 3;
  readout.prnu_percent = 1;
  readout.dsnu_e = 3;
  readout.full_well_e = 100000;
  return readout;
}

// Errors of a value in standard errors, one per seed.
void expect_coverage(const std::vector<double>& errors, const char* what) {
  constexpr double kQuantile = 1.96;  // 95 % interval of a normal distribution
  int covered = 0;
  double squares = 0;
  for (const double z : errors) {
    covered += std::abs(z) <= kQuantile ? 1 : 0;
    squares += z * z / static_cast<double>(errors.size());
  }
  testing::Test::RecordProperty(what, covered);
  EXPECT_EQ(errors.size(), static_cast<std::size_t>(kSeeds));
  EXPECT_GE(covered, 88) << what;
  // Intervals that are too wide would cover all. The mean square of 100 errors is 1 within 0.14, one standard
  // deviation.
  EXPECT_GT(squares, 0.5) << what;
  EXPECT_LT(squares, 1.6) << what;
}

PhotonTransfer transfer(const Readout& readout, std::uint64_t seed) {
  std::deque<RawFrame> frames;
  std::uint32_t frame = 0;
  const auto pair = [&](double electrons, double exposure_s) {
    const std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
    for (int i = 0; i < 2; ++i) frames.push_back(read_out(readout, expected, {exposure_s, seed, frame++}));
    return FlatPair{exposure_s, frames[frames.size() - 2].dn, frames.back().dn};
  };
  const std::vector<FlatPair> dark{pair(0, 0.01), pair(0, 10)};
  // Enough that the gain is known better than the variance of darkness.
  std::vector<FlatPair> lit{pair(20000, 0.01)};
  for (int level = 0; level < 12; ++level) lit.push_back(pair(1000 + 350 * level, 0.01));
  return photon_transfer(dark, lit, readout.bits);
}

TEST(NoiseCoverage, GainAndReadNoiseLieWithinTheirStandardErrors) {
  const Readout readout = sensor();
  std::vector<double> gain;
  std::vector<double> noise;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PhotonTransfer found = transfer(readout, seed);
    gain.push_back((found.gain_e_per_dn - readout.gain_e_per_dn) / found.gain_standard_error);
    noise.push_back((found.read_noise_e - readout.read_noise_e) / found.read_noise_standard_error.value());
  }
  expect_coverage(gain, "gain");
  expect_coverage(noise, "read_noise");
}

// The standard error of a patch's mean is the deviation of its pixels over the root of their number.
TEST(NoiseCoverage, PatchesLieWithinTheDeviationOfTheirMean) {
  Readout readout = sensor();
  const double electrons = 1000;
  const double dark_s = 0.01;
  const std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
  const PatchOutline outline{"patch", {{{10, 10}, {30, 10}, {30, 30}, {10, 30}}}};
  const double truth =
      readout.offset_dn + (electrons + readout.dark_e_per_s * dark_s) / readout.gain_e_per_dn;
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    readout.serial = seed;  // another specimen for each seed, whose patterns are noise of the patch too
    const RawFrame raw = read_out(readout, expected, {dark_s, seed, 0});
    const Image image{kEdge, kEdge, {{"Y", {raw.dn.begin(), raw.dn.end()}}}, {}};
    const PatchChannel found =
        measure_patches(image, {{&image.channels[0]}, {"Y"}, {}, {}}, {&outline, 1})[0].channels[0];
    errors.push_back((found.mean - truth) /
                     (found.deviation.value() / std::sqrt(static_cast<double>(found.pixels))));
  }
  expect_coverage(errors, "patch");
}

}  // namespace
}  // namespace abbe
