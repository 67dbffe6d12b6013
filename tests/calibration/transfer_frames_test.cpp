#include "calibration/chart/transfer_frames.h"

#include <cmath>

#include "tests/calibration/transfer_fixture.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

class TransferFrames : public test::PlantedFrames {
 protected:
  // A frame of a sensor under R and G in columns, of which G sees twice as much.
  fs::path frame(const std::string& name, double electrons, double exposure_s, int bits = 12) const {
    std::vector<float> expected(kEdge * kEdge);
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = static_cast<float>(i % 2 == 0 ? electrons : 2 * electrons);
    return PlantedFrames::frame(
        name, expected, exposure_s, 2, bits,
        {{"mosaic", "R,G"}, {"mosaic_channels", "R,G"}, {"electrons_per_lx_s", "1000"}});
  }

  std::vector<fs::path> pair(double electrons, double exposure_s) const {
    const std::string name = fmt::format("{}_{}", electrons, exposure_s);
    return {frame(name + "_a.tif", electrons, exposure_s), frame(name + "_b.tif", electrons, exposure_s)};
  }

  static constexpr int kEdge = 512;
};

TEST_F(TransferFrames, FindThePlantedSensorInEachChannel) {
  std::vector<fs::path> dark;
  std::vector<fs::path> lit;
  for (const double t : {0.01, 1.0})
    for (const fs::path& file : pair(0, t)) dark.push_back(file);
  for (const double e : {100.0, 500.0, 1500.0, 3000.0})
    for (const fs::path& file : pair(e, e / 1e5)) lit.push_back(file);
  Inputs inputs;
  const std::vector<ChannelTransfer> found = measure_transfer(dark, lit, inputs);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].channel, "G");
  for (const ChannelTransfer& one : found) {
    EXPECT_NEAR(one.transfer.gain_e_per_dn, 2, 0.02);
    EXPECT_NEAR(one.transfer.read_noise_e, 6, 0.05);
    EXPECT_EQ(one.transfer.points.size(), 4U);
    const double noise = one.transfer.read_noise_e;
    EXPECT_NEAR(one.snr10_e / std::sqrt(one.snr10_e + noise * noise), 10, 1e-12);
    EXPECT_NEAR(one.snr10_lx_s.value(), one.snr10_e / 1000, 1e-12);
    EXPECT_NEAR(one.dynamic_range_db, 20 * std::log10((4095 - 50) * 2 / 6.0), 0.2);
  }
}

// G, exposed for twice as long as the sensor, has twice the dark current's electrons.
TEST_F(TransferFrames, ChannelsOfTheirOwnExposureAreDarkForIt) {
  const auto pair = [&](double electrons, double exposure_s) {
    std::vector<float> expected(kEdge * kEdge);
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = static_cast<float>(electrons + 500 * exposure_s * (i % 2 == 0 ? 1 : 2));
    std::vector<fs::path> files;
    for (const char* end : {"a", "b"})
      files.push_back(PlantedFrames::frame(fmt::format("{}_{}_{}.tif", electrons, exposure_s, end), expected,
                                           exposure_s, 2, 12,
                                           {{"mosaic", "R,G"},
                                            {"mosaic_channels", "R,G"},
                                            {"exposure_s.G", fmt::format("{}", 2 * exposure_s)}}));
    return files;
  };
  std::vector<fs::path> dark = pair(0, 0.01);
  for (const fs::path& file : pair(0, 1)) dark.push_back(file);
  std::vector<fs::path> lit = pair(500, 0.01);
  for (const fs::path& file : pair(4000, 0.01)) lit.push_back(file);
  Inputs inputs;
  for (const ChannelTransfer& one : measure_transfer(dark, lit, inputs))
    EXPECT_NEAR(one.transfer.dark_e_per_s, 500, 10) << one.channel;
}

TEST_F(TransferFrames, ObjectsInSentences) {
  const std::vector<fs::path> dark = pair(0, 0.01);
  const std::vector<fs::path> lit = pair(500, 0.01);
  refused(dark, {lit[0]}, "is alone: two frames of each exposure are needed");
  refused(dark, {lit[0], lit[1], lit[0], frame("other.tif", 500, 0.02)},
          "is exposed for 0.02 s and the frame before it for 0.01");
  refused(dark, {lit[0], frame("deep.tif", 500, 0.01, 14)}, "has 14 bits, the first frame 12");
  refused(dark, lit, "dark pairs are of one exposure time only");
  Image plain{kEdge, kEdge, {{"Y", std::vector<float>(kEdge * kEdge, 7)}}, {}};
  write_raw_picture(folder_ / "plain.tif", plain);
  refused({folder_ / "plain.tif"}, lit, "tells neither bits nor exposure time");
}

}  // namespace
}  // namespace abbe
