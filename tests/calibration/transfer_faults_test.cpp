#include "tests/calibration/transfer_fixture.h"

// Frames that were confused with one another.

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

  static void refused(const Files& dark, const Files& lit, const fs::path& file, const std::string& text) {
    PlantedFrames::refused(dark, lit, file.filename().string() + ": " + text);
  }

  static constexpr int kEdge = 64;
  std::uint32_t frames_ = 0;
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
