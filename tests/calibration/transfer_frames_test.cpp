#include "calibration/chart/transfer_frames.h"

#include <cmath>

#include "calibration/chart/raw_scale.h"
#include "tests/calibration/transfer_fixture.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

// Two areas of a film merged from parts, under a mosaic that begins at the film's corner.
TEST(RawCodes, AreOfThePixelsThatWereRendered) {
  Image image{4, 2, {{"raw", {}}}, {{"crop", "1,0,4,2"}, {"areas", "1,0,2,2=0:8 3,1,4,2=0:8"}}};
  for (int code = 0; code < 8; ++code) image.channels[0].values.push_back(static_cast<float>(code) / 65535);
  RawScale scale;
  scale.channels = {"R", "G", "B"};
  scale.mosaic = Mosaic{2, 2, {0, 1, 1, 2}};
  const std::vector<ChannelCodes> found = raw_codes(image, scale);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_TRUE(found[0].dn.empty());
  EXPECT_EQ(found[1].dn, std::vector<std::uint16_t>{1});
  EXPECT_EQ(found[2].dn, (std::vector<std::uint16_t>{5, 7}));
  scale.mosaic.reset();
  const ChannelCodes all = raw_codes(image, scale)[0];
  EXPECT_EQ(all.dn, (std::vector<std::uint16_t>{1, 5, 7}));
  ASSERT_EQ(all.rows.size(), 3U);
  EXPECT_EQ(all.rows[0].y, 0);
  EXPECT_EQ(all.rows[2].y, 1);
  EXPECT_EQ(all.rows[2].count, 1U);
}

class TransferFrames : public test::PlantedFrames {
 protected:
  // A frame of a sensor with columns of R and G, of which G receives twice as much.
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
  for (const double e : {100.0, 500.0, 1500.0, 3000.0, 10000.0})
    for (const fs::path& file : pair(e, e / 1e5)) lit.push_back(file);
  Inputs inputs;
  const std::vector<ChannelTransfer> found = measure_transfer(dark, lit, inputs);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].channel, "G");
  for (const ChannelTransfer& one : found) {
    EXPECT_NEAR(one.transfer.gain_e_per_dn, 2, 0.02);
    EXPECT_NEAR(one.transfer.read_noise_e, 6, 0.05);
    EXPECT_EQ(one.transfer.points.size(), 5U);
    const double noise = one.transfer.read_noise_e;
    EXPECT_NEAR(one.snr10_e / std::sqrt(one.snr10_e + noise * noise), 10, 1e-12);
    EXPECT_NEAR(one.snr10_lx_s.value(), one.snr10_e / 1000, 1e-12);
    EXPECT_NEAR(one.dynamic_range_db.value(), 20 * std::log10((4095 - 50) * 2 / 6.0), 0.2);
  }
}

// G is exposed for twice as long as the sensor and has twice the electrons of dark current.
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

// The channel of a grey sensor has a name in all formats.
TEST_F(TransferFrames, AnyKindOfFileTellsTheExposureOfAChannelsOwn) {
  for (const char* end : {"tif", "png", "dng", "fits"}) {
    const auto pair = [&](double electrons, double exposure_s) {
      const std::vector<float> expected(64 * 64, static_cast<float>(electrons + 500 * 8 * exposure_s));
      Files files;
      for (const char* of : {"a", "b"}) {
        const std::string name = fmt::format("{}_{}_{}.{}", electrons, exposure_s, of, end);
        files.push_back(PlantedFrames::frame(name, expected, exposure_s, 2, 12,
                                             {{"sensor_channels", "mono"},
                                              {"white_level_dn", "4095"},
                                              {"exposure_s.mono", fmt::format("{}", 8 * exposure_s)}}));
      }
      return files;
    };
    Files dark = pair(0, 0.01);
    for (const fs::path& file : pair(0, 1)) dark.push_back(file);
    Files lit = pair(500, 0.01);
    for (const fs::path& file : pair(4000, 0.01)) lit.push_back(file);
    Inputs inputs;
    const std::vector<ChannelTransfer> found = measure_transfer(dark, lit, inputs);
    ASSERT_EQ(found.size(), 1U) << end;
    EXPECT_EQ(found[0].channel, "mono") << end;
    EXPECT_NEAR(found[0].transfer.dark_e_per_s, 500, 40) << end;
  }
}

// Codes of a coarse response curve; one code is 5/3 DN wide in the dark.
class CurvedFrames : public TransferFrames {
 protected:
  CurvedFrames() {
    readout_.gain_e_per_dn = 20;
    readout_.bits = 8;
    readout_.offset_dn = 15;
    readout_.read_noise_e = 20;
    readout_.response_curve = MonotoneCurve({{0, 0}, {0.5, 0.3}, {1, 1}});
  }

  Files pair(const std::string& end, double electrons, double exposure_s) const {
    const std::vector<float> expected(256 * 256, static_cast<float>(electrons));
    Files files;
    for (const std::uint32_t of : {0U, 1U}) {
      const RawFrame raw =
          read_out(readout_, expected, {exposure_s, static_cast<std::uint64_t>(electrons), of});
      Image image{256, 256, {{"mono", {raw.dn.begin(), raw.dn.end()}}}, {}};
      image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                        {"sensor_channels", "mono"},
                        {"white_level_dn", "255"},
                        {"sensor", fmt::format(R"({{"readout":{{"gain_e_per_dn":20,"bits":8,"offset_dn":15,)"
                                               R"("response_curve":{}}}}})",
                                               told_curve_)}};
      files.push_back(
          write(fmt::format("{}_{}_{}.{}", electrons, exposure_s, of, end), image, linear_codes(readout_)));
    }
    return files;
  }

  Readout readout_;
  std::string told_curve_ = "[[0,0],[0.5,0.3],[1,1]]";
};

TEST_F(CurvedFrames, TellThePlantedSensorInAnyKindOfFile) {
  std::vector<double> gains;
  for (const char* end : {"tif", "png", "dng", "fits"}) {
    Files dark = pair(end, 0, 0.01);
    for (const fs::path& file : pair(end, 0, 1)) dark.push_back(file);
    Files lit;
    for (const double e : {300.0, 600.0, 1200.0, 1800.0, 2400.0, 3000.0, 3600.0, 8000.0})
      for (const fs::path& file : pair(end, e, 0.01)) lit.push_back(file);
    Inputs inputs;
    const PhotonTransfer found = measure_transfer(dark, lit, inputs).at(0).transfer;
    EXPECT_NEAR(found.gain_e_per_dn, 20, 2.58 * found.gain_standard_error) << end;
    EXPECT_NEAR(found.read_noise_e, 20, 2.58 * found.read_noise_standard_error.value()) << end;
    EXPECT_LT(found.gain_standard_error, 0.2) << end;
    EXPECT_LT(found.read_noise_standard_error.value(), 0.4) << end;
    gains.push_back(found.gain_e_per_dn);
  }
  EXPECT_EQ(gains, std::vector<double>(4, gains[0]));
}

TEST_F(CurvedFrames, AreOfOneCurve) {
  const Files dark = pair("tif", 0, 0.01);
  told_curve_ = "[[0,0],[0.5,0.4],[1,1]]";
  refused(dark, pair("tif", 300, 0.01),
          "has another response curve, offset_dn or saturation_dn than the first frame");
}

// One pixel in a thousand clips in the longer dark exposure, and no bright pair does at first.
TEST_F(TransferFrames, WhiteLevelsTellWhichHotPixelsAreFull) {
  Readout readout;
  readout.gain_e_per_dn = 2;
  readout.bits = 12;
  readout.offset_dn = 100;
  readout.saturation_dn = 3000;
  readout.read_noise_e = 5;
  readout.dsnu_e = 3;
  readout.hot_pixels_percent = 0.1;
  readout.hot_pixel_e_per_s = 1000;
  std::uint32_t number = 0;
  const auto add_pair = [&](Files& files, double electrons, double exposure_s) {
    for (int i = 0; i < 2; ++i, ++number) {
      const RawFrame raw = read_out(readout, std::vector<float>(256 * 256, static_cast<float>(electrons)),
                                    {exposure_s, 1, number});
      files.push_back(
          write(fmt::format("{}.tif", number),
                {256,
                 256,
                 {{"mono", {raw.dn.begin(), raw.dn.end()}}},
                 {{"exposure_s", fmt::format("{}", exposure_s)},
                  {"white_level_dn", "3000"},
                  {"sensor",
                   R"({"readout":{"gain_e_per_dn":2,"bits":12,"offset_dn":100,"saturation_dn":3000}})"}}}));
    }
  };
  Files dark;
  Files lit;
  for (const double seconds : {1.0, 10.0}) add_pair(dark, 0, seconds);
  for (const double electrons : {1200.0, 2900.0, 4700.0}) add_pair(lit, electrons, 1);
  Inputs inputs;
  const ChannelTransfer dim = measure_transfer(dark, lit, inputs).at(0);
  EXPECT_NEAR(dim.transfer.dsnu_e, 3, 0.2);
  EXPECT_FALSE(dim.transfer.full_well_e);
  EXPECT_FALSE(dim.dynamic_range_db) << "nothing tells what saturates";
  add_pair(lit, 7000, 1);
  const ChannelTransfer full = measure_transfer(dark, lit, inputs).at(0);
  EXPECT_FALSE(full.transfer.full_well_e) << "the codes end first";
  EXPECT_NEAR(full.dynamic_range_db.value(), 20 * std::log10(2900 * 2 / 5.0), 0.1);
}

TEST_F(TransferFrames, ObjectsInSentences) {
  const std::vector<fs::path> dark = pair(0, 0.01);
  const std::vector<fs::path> lit = pair(500, 0.01);
  refused(dark, {lit[0]}, "is alone: two frames of each exposure are needed");
  refused(dark, {lit[0], lit[1], lit[0], frame("other.tif", 500, 0.02)},
          "is exposed for 0.02 s and the frame before it for 0.01");
  refused(dark, {lit[0], frame("deep.tif", 500, 0.01, 14)}, "has 14 bits, the first frame 12");
  refused(dark, lit, "dark pairs have only one exposure time");
  Image plain{kEdge, kEdge, {{"Y", std::vector<float>(kEdge * kEdge, 7)}}, {}};
  write_raw_picture(folder_ / "plain.tif", plain);
  refused({folder_ / "plain.tif"}, lit, "records neither bits nor exposure time");
}

}  // namespace
}  // namespace abbe
