#include "tests/calibration/transfer_fixture.h"

// Frames that were confused with one another, or do not belong together.

namespace abbe {
namespace {

namespace fs = std::filesystem;

class TransferFaults : public test::PlantedFrames {
 protected:
  fs::path frame(double electrons, double exposure_s, double gain_e_per_dn = 2) {
    const std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
    return PlantedFrames::frame(fmt::format("{}.tif", ++frames_), expected, exposure_s, gain_e_per_dn, 12,
                                {{"gain_e_per_dn", fmt::format("{}", gain_e_per_dn)}});
  }

  // A dark frame in which this many pixels have the lowest code.
  fs::path cut_frame(int lowest, double exposure_s) {
    Image image{kEdge, kEdge, {{"raw", {}}}, {}};
    for (int i = 0; i < kEdge * kEdge; ++i)
      image.channels[0].values.push_back(i < lowest ? 0.0F : static_cast<float>(50 + (i + frames_) % 3));
    image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                      {"sensor", R"({"readout":{"bits":12,"offset_dn":50}})"}};
    const fs::path file = folder_ / fmt::format("{}.tif", ++frames_);
    write_raw_picture(file, image);
    return file;
  }

  // A frame of a read-out with 2 e/DN and neither noise nor offset.
  fs::path ideal_frame(double electrons, double exposure_s) {
    Readout readout;
    readout.gain_e_per_dn = 2;
    readout.bits = 12;
    const std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
    const RawFrame raw = read_out(readout, expected, {exposure_s, static_cast<std::uint64_t>(frames_), 0});
    Image image{kEdge, kEdge, {{"raw", {raw.dn.begin(), raw.dn.end()}}}, {}};
    image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                      {"sensor", R"({"readout":{"bits":12}})"}};
    const fs::path file = folder_ / fmt::format("{}.tif", ++frames_);
    write_raw_picture(file, image);
    return file;
  }

  // A frame in which each row of 64 pixels has a row noise of 3 e, in addition to 2 e in each pixel.
  fs::path row_frame(double electrons, double exposure_s, int height = kEdge) {
    Readout readout;
    readout.gain_e_per_dn = 2;
    readout.bits = 12;
    readout.offset_dn = 100;
    readout.read_noise_e = 2;
    readout.row_noise_e = 3;
    const std::vector<float> expected(static_cast<std::size_t>(kEdge * height),
                                      static_cast<float>(electrons));
    const RawFrame raw =
        read_out(readout, expected, {exposure_s, static_cast<std::uint64_t>(frames_), 0, kEdge});
    Image image{kEdge, height, {{"raw", {raw.dn.begin(), raw.dn.end()}}}, {}};
    image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                      {"sensor", R"({"readout":{"bits":12,"offset_dn":100}})"}};
    const fs::path file = folder_ / fmt::format("{}.tif", ++frames_);
    write_raw_picture(file, image);
    return file;
  }

  // A frame in which only the pixels of `areas` were rendered; all others are darker.
  fs::path cropped_frame(double electrons, double exposure_s, const std::string& areas,
                         const std::string& end) {
    std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
    for (std::size_t i = 0; i < expected.size(); ++i)
      if (i % kEdge >= kEdge / 2) expected[i] = 0;
    return PlantedFrames::frame(fmt::format("{}.{}", ++frames_, end), expected, exposure_s, 2, 12,
                                {{"crop", areas}, {"sensor_channels", "raw"}, {"white_level_dn", "4095"}});
  }

  static void refused(const Files& dark, const Files& lit, const fs::path& file, const std::string& text) {
    PlantedFrames::refused(dark, lit, file.filename().string() + ": " + text);
  }

  static constexpr int kEdge = 64;
  int frames_ = 0;
};

TEST_F(TransferFaults, GainsAreNotMixed) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  const Files lit{frame(500, 0.01, 0.5), frame(500, 0.01, 0.5)};
  refused(dark, lit, lit[0], "was read out at 0.5 e/DN, the first frame at 2");
  const Files mixed{frame(500, 0.01), frame(500, 0.01), lit[0], lit[1]};
  refused(dark, mixed, lit[0], "was read out at 0.5 e/DN, the first frame at 2");
}

TEST_F(TransferFaults, FramesOfAPairSeeTheSameLight) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  const Files lit{frame(500, 0.01), frame(500, 0.01), frame(1000, 0.01), frame(3000, 0.01)};
  refused(dark, lit, lit[3], "has a mean of 15");
}

// All pixels of a row have its noise in common, so the mean of a frame is less certain than that of as many
// independent pixels. Two rows do not show how much less.
TEST_F(TransferFaults, RowNoiseIsNoOtherLight) {
  for (const int height : {kEdge, 2}) {
    Files dark;
    Files lit;
    for (int pair = 0; pair < 20; ++pair)
      for (int i = 0; i < 2; ++i) dark.push_back(row_frame(0, pair % 2 == 0 ? 0.01 : 1, height));
    for (const double e : {20, 20, 300, 300, 1000, 1000, 3000, 3000})
      lit.push_back(row_frame(e, 0.01, height));
    Inputs inputs;
    EXPECT_EQ(measure_transfer(dark, lit, inputs).size(), 1U) << height;
  }
}

TEST_F(TransferFaults, DarkFramesOfAPairSeeTheSameLight) {
  const Files dark{row_frame(0, 0.01), row_frame(0, 0.01), row_frame(0, 1), row_frame(30, 1)};
  const Files lit{frame(500, 0.01), frame(500, 0.01)};
  refused(dark, lit, dark[3], "has a mean of 11");
}

TEST_F(TransferFaults, OneFrameIsNoPair) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  const fs::path once = frame(500, 0.01);
  refused(dark, {once, once}, once, "has exactly the codes of the frame before it");
}

TEST_F(TransferFaults, FramesThatAreFullMayBeAlike) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  Files lit;
  for (const double e : {300, 300, 1000, 1000, 3000, 3000, 6000, 6000, 1000000, 1000000})
    lit.push_back(frame(e, 0.01));
  Inputs inputs;
  EXPECT_NEAR(measure_transfer(dark, lit, inputs)[0].transfer.gain_e_per_dn, 2, 0.1);
}

// Half of the pixels were not rendered and are dark, which is not a pattern of the sensor.
TEST_F(TransferFaults, PixelsThatWereNotRenderedDoNotCount) {
  for (const char* end : {"tif", "png", "dng", "fits"}) {
    Files dark;
    Files lit;
    for (const double seconds : {0.01, 0.01, 1.0, 1.0})
      dark.push_back(cropped_frame(0, seconds, "0,0,32,64", end));
    for (const double e : {300, 300, 1000, 1000, 3000, 3000, 6000, 6000})
      lit.push_back(cropped_frame(e, 0.01, "0,0,32,64", end));
    Inputs inputs;
    const PhotonTransfer found = measure_transfer(dark, lit, inputs).at(0).transfer;
    EXPECT_NEAR(found.gain_e_per_dn, 2, 3 * found.gain_standard_error) << end;
    EXPECT_LT(found.gain_standard_error, 0.1) << end;
    EXPECT_LT(found.prnu_percent, 1) << end;
    EXPECT_NEAR(found.points[1].signal_dn, 500, 5) << end;
  }
}

TEST_F(TransferFaults, FramesAreOfTheSamePixels) {
  const Files dark{cropped_frame(0, 0.01, "0,0,32,64", "tif"), cropped_frame(0, 0.01, "0,0,32,64", "tif")};
  const Files other{cropped_frame(300, 0.01, "0,0,32,60", "tif")};
  refused(dark, {other[0], other[0]}, other[0], "has exactly the codes of the frame before it");
  const Files lit{other[0], cropped_frame(300, 0.01, "0,0,32,60", "tif")};
  refused(dark, lit, lit[0],
          "was rendered at the pixels 0,0,32,60, the first frame at 0,0,32,64: fixed patterns need the same "
          "pixels");
  const Files one{cropped_frame(300, 0.01, "0,0,1,1", "tif")};
  refused(one, lit, one[0], "has too few pixels in raw to measure noise (got 1, allowed 2 or more)");
}

// 20 of 4096 pixels are 0.488 %, 21 are 0.513 %.
TEST_F(TransferFaults, FramesWhoseNoiseIsCutOffAreRefused) {
  Files lit;
  for (const double e : {300, 300, 1000, 1000, 3000, 3000}) lit.push_back(frame(e, 0.01));
  const auto dark = [&](int lowest) {
    Files files;
    for (const double seconds : {0.01, 0.01, 1.0}) files.push_back(cut_frame(20, seconds));
    files.push_back(cut_frame(lowest, 1));
    return files;
  };
  Inputs inputs;
  EXPECT_EQ(measure_transfer(dark(20), lit, inputs).size(), 1U);
  const Files cut = dark(21);
  refused(cut, lit, cut[3], "0.513 % of its codes in ");
  PlantedFrames::refused(cut, lit, " are 0, the lowest, at which noise is cut off (allowed 0.5 %), so");
}

// In the dark all codes are 0, which is correct. If only some are, the frames are rejected.
TEST_F(TransferFaults, FramesOfAnIdealReadOutAreDarkThroughout) {
  const Files dark{ideal_frame(0, 0.01), ideal_frame(0, 0.01), ideal_frame(0, 1), ideal_frame(0, 1)};
  Files lit;
  for (const double e : {300, 300, 1000, 1000, 3000, 3000}) lit.push_back(ideal_frame(e, 0.01));
  Inputs inputs;
  const PhotonTransfer found = measure_transfer(dark, lit, inputs).at(0).transfer;
  EXPECT_NEAR(found.gain_e_per_dn, 2, 0.1);
  EXPECT_EQ(found.read_noise_e, 0);
  EXPECT_EQ(found.dark_e_per_s, 0);
  const Files dim{ideal_frame(2, 0.01), ideal_frame(2, 0.01)};
  PlantedFrames::refused(dark, dim, " are 0, the lowest, at which noise is cut off (allowed 0.5 %), so");
}

}  // namespace
}  // namespace abbe
