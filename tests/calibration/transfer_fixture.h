#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "calibration/chart/transfer_frames.h"
#include "io/picture.h"
#include "sensor/readout/readout.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe::test {

/// Raw files of a planted sensor, in a folder of their own: a read noise of 6 e and darkness at 50 DN.
class PlantedFrames : public testing::Test {
 protected:
  using Files = std::vector<std::filesystem::path>;

  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A frame of a square sensor whose pixels expect these electrons, told by these attributes besides.
  std::filesystem::path frame(const std::string& name, std::span<const float> electrons, double exposure_s,
                              double gain_e_per_dn, int bits,
                              const std::map<std::string, std::string>& attributes) const {
    Readout readout;
    readout.gain_e_per_dn = gain_e_per_dn;
    readout.bits = bits;
    readout.read_noise_e = 6;
    readout.offset_dn = 50;
    const RawFrame raw = read_out(readout, electrons, {exposure_s, std::hash<std::string>()(name), 0});
    const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(electrons.size()))));
    Image image{edge, edge, {{"raw", {raw.dn.begin(), raw.dn.end()}}}, attributes};
    image.metadata.insert({{"exposure_s", fmt::format("{}", exposure_s)},
                           {"sensor", fmt::format(R"({{"readout":{{"bits":{},"offset_dn":50}}}})", bits)}});
    write_raw_picture(folder_ / name, image);
    return folder_ / name;
  }

  /// What `measure_transfer` must object to, in these words.
  static void refused(const Files& dark, const Files& lit, const std::string& text) {
    expect_error(
        [&] {
          Inputs inputs;
          static_cast<void>(measure_transfer(dark, lit, inputs));
        },
        ErrorCode::input, text);
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_transfer_" + std::to_string(::getpid()));
};

}  // namespace abbe::test
