#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/error.h"
#include "io/raw_picture.h"
#include "test_files.h"

// How FITS files are named, and where in them images and their texts are.

namespace abbe {
namespace {

// A card holds 68 characters of a text.
TEST(Fits, PlanesHaveTheirWholeNames) {
  RawPicture raw;
  raw.width = raw.height = 1;
  for (int name = 450; name <= 700; name += 50) raw.planes.push_back("narrowband-0" + std::to_string(name));
  raw.codes = {1, 2, 3, 4, 5, 6};
  const auto path = test_folder() / "a.fits";
  const auto read = [&] {
    write_fits(path, raw);
    return read_raw_picture(path).planes;
  };
  EXPECT_EQ(read(), raw.planes);
  raw.planes = {std::string(40, 'a'), std::string(40, 'b')};
  raw.codes = {1, 2};
  EXPECT_EQ(read(), raw.planes) << "the last of which a card ends within";
}

// Some programs write 0 where they do not know it.
TEST(Fits, SaturationBelowBlackIsUnknown) {
  RawPicture raw;
  raw.width = raw.height = 1;
  raw.planes = {"mono"};
  raw.codes = {300};
  raw.black_level_dn = 100;
  const auto path = test_folder() / "a.fits";
  for (const double white : {0.0, 100.0, 4000.0}) {
    raw.white_level_dn = white;
    write_fits(path, raw);
    EXPECT_EQ(read_raw_picture(path).white_level_dn, white > 100 ? white : 65535);
  }
}

// Brackets ask most functions of the library for a part of a file.
TEST(Fits, IsReadByItsVeryName) {
  RawPicture raw;
  raw.width = 2;
  raw.height = 1;
  raw.planes = {"mono"};
  raw.codes = {300, 200};
  for (const char* name : {"chart[1].fits", "a.fits[1:1,1:1].fits", "a(b).fits", "[2024].fits"}) {
    const auto path = test_folder() / name;
    write_fits(path, raw);
    EXPECT_EQ(read_raw_picture(path).codes, raw.codes) << name;
  }
}

// A header of these cards, or data, in blocks as FITS has them.
std::string in_blocks(const std::vector<std::string>& cards) {
  constexpr std::size_t kCard = 80;
  constexpr std::size_t kBlock = 2880;
  std::string block;
  for (std::string card : cards) {
    card.resize(kCard, ' ');
    block += card;
  }
  block.resize((block.size() + kBlock - 1) / kBlock * kBlock, ' ');
  return block;
}

// A file of one row of pixels with these bytes, and cards besides those that it needs.
std::string row_of(int bits, const std::string& bytes, const std::vector<std::string>& more) {
  std::vector<std::string> cards{
      "SIMPLE  =                    T", "BITPIX  = " + std::to_string(bits), "NAXIS   = 2",
      "NAXIS1  = " + std::to_string(8 * bytes.size() / static_cast<std::size_t>(bits)), "NAXIS2  = 1"};
  cards.insert(cards.end(), more.begin(), more.end());
  cards.emplace_back("END");
  std::string data = bytes;
  data.resize(2880, '\0');
  return in_blocks(cards) + data;
}

TEST(Fits, CodesEndWhereTheirTypeDoes) {
  const auto path = test_folder() / "a.fits";
  const auto white = [&](int bits, const std::vector<std::string>& more) {
    put(path, row_of(bits, {0, 5, 0, 7}, more));
    return read_raw_picture(path).white_level_dn;
  };
  EXPECT_EQ(white(8, {}), 255);
  EXPECT_EQ(white(16, {}), 32767);
  EXPECT_EQ(white(16, {"BZERO   = 32768"}), 65535);
  EXPECT_EQ(white(8, {"SATURATE= 65535"}), 255);
  EXPECT_EQ(white(8, {"BSCALE  = 2"}), 510);
  EXPECT_EQ(white(8, {"BZERO   = 1"}), 256);
  EXPECT_EQ(white(8, {"BSCALE  = -1", "BZERO   = 255"}), 255);
  EXPECT_EQ(white(8, {"SATURATE= 200"}), 200);
}

// The standard has pixels without a value in whole numbers: those that hold the number of BLANK.
TEST(Fits, PixelsWithoutAValueAreRefused) {
  const auto path = test_folder() / "a.fits";
  const std::string bytes{char(0x80), 0, char(0x80), 7};
  const std::vector<std::string> cards{"BZERO   = 32768", "BLANK   = -32768"};
  put(path, row_of(16, bytes, {cards[0]}));
  EXPECT_EQ(read_raw_picture(path).codes, (std::vector<std::uint16_t>{0, 7}));
  put(path, row_of(16, bytes.substr(2), cards));
  EXPECT_EQ(read_raw_picture(path).codes, std::vector<std::uint16_t>{7}) << "none of which is undefined";
  put(path, row_of(16, bytes, cards));
  try {
    (void)read_raw_picture(path);
    FAIL() << "a pixel has no value";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(),
              path.string() + ": pixels are undefined (they hold the value BLANK; every pixel needs a code)");
  }
}

// Many programs leave the first header empty.
TEST(Fits, TheFirstImageWithPixelsIsRead) {
  const std::string empty =
      in_blocks({"SIMPLE  =                    T", "BITPIX  =                    8",
                 "NAXIS   =                    0", "EXTEND  =                    T", "END"});
  const std::string image =
      in_blocks({"XTENSION= 'IMAGE   '", "BITPIX  =                   16", "NAXIS   =                    2",
                 "NAXIS1  =                    2", "NAXIS2  =                    1",
                 "PCOUNT  =                    0", "GCOUNT  =                    1", "END"});
  std::string data{0, 5, 0, 7};
  data.resize(2880, '\0');
  const auto path = test_folder() / "a.fits";
  put(path, empty + image + data);
  const RawPicture read = read_raw_picture(path);
  EXPECT_EQ(read.width, 2);
  EXPECT_EQ(read.codes, (std::vector<std::uint16_t>{5, 7}));
  put(path, empty);
  try {
    (void)read_raw_picture(path);
    FAIL() << "there is none";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), path.string() + ": not a FITS image, or damaged");
  }
}

// A cube of so many planes of one pixel, with these cards added.
std::string cube_of(std::size_t planes, const std::vector<std::string>& more = {}) {
  std::vector<std::string> cards{
      "SIMPLE  =                    T",     "BITPIX  = 16", "NAXIS   = 3", "NAXIS1  = 1", "NAXIS2  = 1",
      "NAXIS3  = " + std::to_string(planes)};
  cards.insert(cards.end(), more.begin(), more.end());
  cards.emplace_back("END");
  return in_blocks(cards) + std::string(2880, '\1');
}

// An image of three by two 32-bit floats.
std::string floats(const std::vector<float>& values, const std::vector<std::string>& more = {}) {
  std::vector<std::string> cards{"SIMPLE  = T", "BITPIX  = -32", "NAXIS   = 2",
                                 "NAXIS1  = 3", "NAXIS2  = 2",   "PEDESTAL= 100"};
  cards.insert(cards.end(), more.begin(), more.end());
  cards.emplace_back("END");
  std::string bytes;
  for (const float value : values)
    for (int shift = 24; shift >= 0; shift -= 8)
      bytes += static_cast<char>(std::bit_cast<std::uint32_t>(value) >> static_cast<unsigned>(shift) & 0xFFU);
  bytes.resize(2880);
  return in_blocks(cards) + bytes;
}

TEST(Fits, FloatsAreCodesOrKeepTheirFractions) {
  const auto path = test_folder() / "f.fits";
  put(path, floats({100, 300, 4095, 0, 1, 2}, {"SATURATE= 4095"}));
  const RawPicture whole = read_raw_picture(path);
  EXPECT_EQ(whole.codes, (std::vector<std::uint16_t>{100, 300, 4095, 0, 1, 2}));
  EXPECT_TRUE(whole.corrected.empty());
  EXPECT_EQ(whole.white_level_dn, 4095);
  put(path, floats({100.25F, 300, 4095, -3, 1, 2}, {"ROWORDER= 'BOTTOM-UP'"}));
  const RawPicture calibrated = read_raw_picture(path);
  EXPECT_EQ(calibrated.codes, (std::vector<std::uint16_t>{0, 1, 2, 100, 300, 4095}));
  EXPECT_EQ(calibrated.corrected, (std::vector<float>{-103, -99, -98, 0.25F, 200, 3995}));
}

TEST(Fits, FloatsThatAreNoCodesAreRefused) {
  const auto path = test_folder() / "f.fits";
  const auto fault = [&](const std::vector<float>& values) {
    put(path, floats(values));
    try {
      static_cast<void>(read_raw_picture(path));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(fault({0, 0.5F, 1, 0, 0, 0}).find("got 1, allowed above 1"), std::string::npos);
  EXPECT_NE(fault({0, 70000, 1, 0, 0, 0}).find("got 70000"), std::string::npos);
  EXPECT_NE(fault({0, NAN, 1, 0, 0, 0}).find("not finite"), std::string::npos);
}

TEST(Fits, ThreePlanesWithoutNamesAreRedGreenAndBlue) {
  const auto path = test_folder() / "a.fits";
  const auto planes = [&](const std::string& bytes) {
    put(path, bytes);
    return read_raw_picture(path).planes;
  };
  EXPECT_EQ(planes(cube_of(3)), (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(planes(cube_of(3, {"PLANES  = 'Ha,OIII,SII'"})), (std::vector<std::string>{"Ha", "OIII", "SII"}));
  EXPECT_EQ(planes(cube_of(2)), (std::vector<std::string>{"0", "1"}));
}

}  // namespace
}  // namespace abbe
