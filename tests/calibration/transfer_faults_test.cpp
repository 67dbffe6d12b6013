#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "calibration/chart/transfer_frames.h"
#include "io/picture.h"
#include "sensor/readout/readout.h"
#include "tests/calibration/calibration_fixture.h"

// Frames that were confused with one another.

namespace abbe {
namespace {

namespace fs = std::filesystem;

class TransferFaults : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path frame(double electrons, double exposure_s, double gain_e_per_dn = 2) {
    Readout readout;
    readout.gain_e_per_dn = gain_e_per_dn;
    readout.bits = 12;
    readout.read_noise_e = 6;
    readout.offset_dn = 50;
    const std::vector<float> expected(kEdge * kEdge, static_cast<float>(electrons));
    const RawFrame raw = read_out(readout, expected, {exposure_s, ++frames_, 0});
    Image image{kEdge, kEdge, {{"raw", {raw.dn.begin(), raw.dn.end()}}}, {}};
    image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                      {"gain_e_per_dn", fmt::format("{}", gain_e_per_dn)},
                      {"sensor", R"({"readout":{"bits":12,"offset_dn":50}})"}};
    const fs::path path = folder_ / fmt::format("{}.tif", frames_);
    write_raw_picture(path, image);
    return path;
  }

  using Files = std::vector<fs::path>;
  static void refused(const Files& dark, const Files& lit, const fs::path& file, const std::string& text) {
    test::expect_error(
        [&] {
          Inputs inputs;
          (void)measure_transfer(dark, lit, inputs);
        },
        ErrorCode::input, file.filename().string() + ": " + text);
  }

  static constexpr int kEdge = 64;
  std::uint32_t frames_ = 0;
  fs::path folder_ = fs::path(testing::TempDir()) / ("abbe_transfer_faults_" + std::to_string(::getpid()));
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

TEST_F(TransferFaults, OneFrameIsNoPair) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  const fs::path once = frame(500, 0.01);
  refused(dark, {once, once}, once, "has the very codes of the frame before it");
}

TEST_F(TransferFaults, FramesThatAreFullMayBeAlike) {
  const Files dark{frame(0, 0.01), frame(0, 0.01), frame(0, 1), frame(0, 1)};
  Files lit;
  for (const double e : {300, 300, 1000, 1000, 3000, 3000, 6000, 6000, 1000000, 1000000})
    lit.push_back(frame(e, 0.01));
  Inputs inputs;
  EXPECT_NEAR(measure_transfer(dark, lit, inputs)[0].transfer.gain_e_per_dn, 2, 0.1);
}

}  // namespace
}  // namespace abbe
