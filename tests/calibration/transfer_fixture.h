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
#include "io/raw_picture.h"
#include "sensor/readout/readout.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe::test {

/// Raw files of a planted sensor in a temporary folder. Its read noise is 6 e, and darkness is at 50 DN.
class PlantedFrames : public testing::Test {
 protected:
  using Files = std::vector<std::filesystem::path>;

  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes a frame of a square sensor whose pixels expect these electrons. Further `attributes` are
  /// recorded; the plane has the name of the channel among them.
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
    const auto channel = attributes.find("sensor_channels");
    Image image{edge,
                edge,
                {{channel == attributes.end() ? "raw" : channel->second, {raw.dn.begin(), raw.dn.end()}}},
                attributes};
    image.metadata.insert({{"exposure_s", fmt::format("{}", exposure_s)},
                           {"sensor", fmt::format(R"({{"readout":{{"bits":{},"offset_dn":50}}}})", bits)}});
    return write(name, image);
  }

  /// Writes codes as a raw file whose format follows from its name. A DNG gets `linear_codes` as its
  /// linearisation table.
  std::filesystem::path write(const std::string& name, const Image& codes,
                              const std::vector<std::uint16_t>& linear_codes = {}) const {
    const std::filesystem::path path = folder_ / name;
    if (!is_raw_picture(path)) {
      write_raw_picture(path, codes);
      return path;
    }
    RawPicture raw;
    raw.width = codes.width;
    raw.height = codes.height;
    for (const ImageChannel& channel : codes.channels) raw.planes.push_back(channel.name);
    raw.channels = raw.planes;
    for (std::size_t i = 0; i < codes.pixels(); ++i)
      for (const ImageChannel& channel : codes.channels)
        raw.codes.push_back(static_cast<std::uint16_t>(channel.values[i]));
    raw.white_level_dn = linear_codes.empty() ? 65535 : static_cast<double>(linear_codes.size() - 1);
    raw.linear_codes = linear_codes;
    raw.metadata = codes.metadata;
    if (path.extension() == ".dng")
      write_dng(path, raw);
    else
      write_fits(path, raw);
    return path;
  }

  /// Expects `measure_transfer` to reject the frames with this text.
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
