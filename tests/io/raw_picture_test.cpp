#include "io/raw_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

// What a picture tells of one of its channels.
struct ToldChannel {
  std::string name;
  std::uint16_t code;
  std::array<double, 3> color;
  double neutral;
};
const ToldChannel kRed{"R", 300, {1.1, -0.3, -0.1}, 0.5};
const ToldChannel kGreen{"G", 200, {-0.4, 1.2, 0.2}, 1};
const ToldChannel kBlue{"B", 100, {0.05, -0.1, 0.9}, 0.75};

RawPicture one_pixel(const std::array<ToldChannel, 3>& channels) {
  RawPicture raw;
  raw.width = raw.height = 1;
  raw.exposure_s = 1;
  RawLight light{21};
  std::array<double, 3> neutral{};
  for (std::size_t k = 0; k < 3; ++k) {
    raw.channels.push_back(channels[k].name);
    raw.codes.push_back(channels[k].code);
    std::copy_n(channels[k].color.begin(), 3, light.color.begin() + static_cast<std::ptrdiff_t>(3 * k));
    for (std::size_t row = 0; row < 3; ++row) light.forward[3 * row + k] = channels[k].color[row];
    neutral[k] = channels[k].neutral;
  }
  raw.planes = raw.channels;
  raw.lights = {light};
  raw.neutral = neutral;
  return raw;
}

// The same under a pattern of two by two, its filters told by their names.
RawPicture under_mosaic(RawPicture raw, const std::vector<std::string>& pattern) {
  raw.planes = {"raw"};
  raw.width = raw.height = raw.mosaic_width = 2;
  raw.codes = {1, 2, 3, 4};
  for (const std::string& name : pattern)
    raw.mosaic.push_back(static_cast<std::uint8_t>(std::find(raw.channels.begin(), raw.channels.end(), name) -
                                                   raw.channels.begin()));
  return raw;
}

std::string bytes_of_dng(const RawPicture& raw) {
  const auto path = test_folder() / "a.dng";
  write_dng(path, raw);
  return bytes_of(path);
}

RawPicture read_back(const RawPicture& raw) {
  const auto path = test_folder() / "a.dng";
  write_dng(path, raw);
  return read_raw_picture(path);
}

const std::array<std::array<ToldChannel, 3>, 2> kOtherOrders{{{kBlue, kGreen, kRed}, {kGreen, kBlue, kRed}}};
const std::vector<std::string> kBayer{"R", "G", "G", "B"};

// Readers take its channels for red, green and blue in this order, in whichever a sensor has them.
TEST(Dng, IsTheSameWhateverTheOrderOfRedGreenAndBlue) {
  const RawPicture linear = one_pixel({kRed, kGreen, kBlue});
  for (const auto& channels : kOtherOrders) {
    EXPECT_EQ(bytes_of_dng(one_pixel(channels)), bytes_of_dng(linear)) << channels[0].name;
    EXPECT_EQ(bytes_of_dng(under_mosaic(one_pixel(channels), kBayer)),
              bytes_of_dng(under_mosaic(linear, kBayer)))
        << channels[0].name;
  }
}

TEST(Dng, PlanesReadBackAreThoseWritten) {
  RawPicture raw = one_pixel({kBlue, kGreen, kRed});
  raw.metadata = {{"sensor_channels", "B,G,R"}};
  const RawPicture colors = read_back(raw);
  EXPECT_EQ(colors.planes, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(colors.codes, (std::vector<std::uint16_t>{300, 200, 100}));
  raw.planes = raw.channels = {"M", "R", "G"};
  raw.metadata = {{"sensor_channels", "M,R,G"}};
  const RawPicture others = read_back(raw);
  EXPECT_EQ(others.planes, raw.planes);
  EXPECT_EQ(others.codes, raw.codes);
}

TEST(Dng, FiltersOfOtherNamesKeepTheirOwnOrder) {
  RawPicture raw = one_pixel({kGreen, kRed, kBlue});
  raw.channels = {"G", "M", "Y"};
  raw = under_mosaic(raw, {"M", "G", "G", "Y"});
  raw.metadata = {{"mosaic_channels", "G,M,Y"}};
  const RawPicture read = read_back(raw);
  EXPECT_EQ(read.channels, raw.channels);
  EXPECT_EQ(read.mosaic, raw.mosaic);
}

TEST(RawPicture, AResponseCurveIsUndoneByTheTableOfADngAlone) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.codes = {1, 2, 3};
  raw.black_level_dn = 0;
  raw.white_level_dn = 3;
  raw.linear_codes = {0, 2, 4, 7};
  const RawPicture dng = read_back(raw);
  EXPECT_EQ(dng.codes, (std::vector<std::uint16_t>{2, 4, 7}));
  EXPECT_EQ(dng.white_level_dn, 7);
  const auto path = test_folder() / "a.fits";
  write_fits(path, raw);
  const RawPicture fits = read_raw_picture(path);
  EXPECT_EQ(fits.codes, raw.codes);
  EXPECT_EQ(fits.white_level_dn, 3);
}

TEST(Dng, NeedsNoExposureToTell) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.exposure_s.reset();
  EXPECT_FALSE(read_back(raw).exposure_s);
}

}  // namespace
}  // namespace abbe
