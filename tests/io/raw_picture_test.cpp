#include "io/raw_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "io/error.h"
#include "test_files.h"
#include "tiff_entries.h"

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

TEST(Dng, OnePlaneHasTheNameOfItsSensorsChannel) {
  RawPicture raw;
  raw.width = raw.height = 1;
  raw.planes = raw.channels = {"mono"};
  raw.codes = {300};
  EXPECT_EQ(read_back(raw).planes, std::vector<std::string>{"raw"}) << "where it tells none";
  raw.metadata = {{"sensor_channels", "mono"}};
  EXPECT_EQ(read_back(raw).planes, raw.planes);
  EXPECT_EQ(read_back(raw).channels, raw.channels);
  raw.metadata = {{"sensor_channels", "M,R,G"}};
  EXPECT_EQ(read_back(raw).planes, std::vector<std::string>{"raw"}) << "of a picture made of three";
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

// Files of other programs: those of ours with tags and cards made others.
std::string refusal_of(const std::filesystem::path& path, const std::string& bytes) {
  put(path, bytes);
  try {
    (void)read_raw_picture(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    return error.what();
  }
  return "accepted";
}

constexpr std::uint16_t kStripOffsets = 273;
constexpr std::uint16_t kStripByteCounts = 279;
constexpr std::uint16_t kPlanarConfiguration = 284;
constexpr std::uint16_t kSoftware = 305;
constexpr std::uint16_t kSampleFormat = 339;
constexpr std::uint16_t kRepeatPatternDim = 33421;
constexpr std::uint16_t kPattern = 33422;
constexpr std::uint16_t kBlackLevel = 50714;
constexpr std::uint16_t kBlackLevelDeltaH = 50715;
constexpr std::uint16_t kBlackLevelDeltaV = 50716;
constexpr std::uint16_t kActiveArea = 50829;

TEST(Dng, PlanesOneAfterTheOtherAreThoseOfPixels) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.width = 2;
  raw.codes = {1, 2, 3, 4, 5, 6};
  test::TiffEntries file{bytes_of_dng(raw)};
  const std::uint32_t at = file.value_of(kStripOffsets);
  file.set_short(kPlanarConfiguration, kPlanarConfiguration, 2);
  file.set_longs(kStripOffsets, {at, at + 4, at + 8});
  file.set_longs(kStripByteCounts, {4, 4, 4});
  const auto path = test_folder() / "a.dng";
  put(path, file.bytes);
  EXPECT_EQ(read_raw_picture(path).codes, (std::vector<std::uint16_t>{1, 3, 5, 2, 4, 6}));
}

TEST(Dng, BlackLevelsThatDifferAreRefused) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.black_level_dn = 64;
  test::TiffEntries file{bytes_of_dng(raw)};
  const auto path = test_folder() / "a.dng";
  EXPECT_EQ(refusal_of(path, file.bytes), "accepted");
  const std::size_t second = file.value_of(kBlackLevel) + 8;
  file.set_number(second, 65);
  file.set_number(second + 4, 1);
  EXPECT_EQ(
      refusal_of(path, file.bytes),
      path.string() + ": filters or planes differ in their black level (got 64 to 65, allowed one value)");
}

TEST(Dng, FiltersOfOtherColoursAreRefused) {
  const auto path = test_folder() / "a.dng";
  test::TiffEntries file{bytes_of_dng(under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer))};
  file.set_longs(kPattern, {0, 1, 2, 2});
  EXPECT_EQ(refusal_of(path, file.bytes), "accepted");
  file.set_longs(kPattern, {0, 1, 1, 3});
  EXPECT_EQ(refusal_of(path, file.bytes),
            path.string() +
                ": the mosaic has filters other than red, green and blue (got number 3, allowed 0 to 2)");
  file.set_longs(kPattern, {0, 1, 1});
  EXPECT_EQ(refusal_of(path, file.bytes),
            path.string() + ": the mosaic pattern is missing (CFARepeatPatternDim, CFAPattern)");
  file.set_short(kRepeatPatternDim, kSoftware, 0);
  EXPECT_EQ(refusal_of(path, file.bytes),
            path.string() + ": the mosaic pattern is missing (CFARepeatPatternDim, CFAPattern)");
}

TEST(Dng, RowsAndColumnsHaveNoBlackLevelOfTheirOwn) {
  const auto path = test_folder() / "a.dng";
  const std::string bytes = bytes_of_dng(under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer));
  const auto with = [&](std::uint16_t tag, const std::vector<std::uint32_t>& deltas) {
    test::TiffEntries file{bytes};
    file.set_longs(kSoftware, tag, deltas);
    return refusal_of(path, file.bytes);
  };
  const std::string refusal = path.string() +
                              ": rows or columns differ in their black level (BlackLevelDeltaV or "
                              "BlackLevelDeltaH; allowed one value)";
  for (const std::uint16_t tag : {kBlackLevelDeltaH, kBlackLevelDeltaV}) {
    EXPECT_EQ(with(tag, {0, 0, 0}), "accepted") << tag;
    EXPECT_EQ(with(tag, {0, 0, 3}), refusal) << tag;
  }
}

// Cameras have masked pixels around the lit ones, and tell the pattern from where these begin.
TEST(Dng, OnlyTheActiveAreaIsRead) {
  RawPicture raw = under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer);
  raw.width = 4;
  raw.height = 3;
  raw.codes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  test::TiffEntries file{bytes_of_dng(raw)};
  file.set_longs(kSoftware, kActiveArea, {1, 1, 3, 4});
  const auto path = test_folder() / "a.dng";
  put(path, file.bytes);
  const RawPicture lit = read_raw_picture(path);
  EXPECT_EQ(lit.width, 3);
  EXPECT_EQ(lit.height, 2);
  EXPECT_EQ(lit.codes, (std::vector<std::uint16_t>{6, 7, 8, 10, 11, 12}));
  EXPECT_EQ(lit.mosaic, raw.mosaic);
  file.set_longs(kActiveArea, {1, 1, 3, 5});
  EXPECT_EQ(refusal_of(path, file.bytes), path.string() + ": the ActiveArea is not inside the image");
}

TEST(Dng, CodesThatAreFloatsAreRefused) {
  test::TiffEntries file{bytes_of_dng(under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer))};
  file.set_short(kSoftware, kSampleFormat, 3);
  const auto path = test_folder() / "a.dng";
  EXPECT_EQ(
      refusal_of(path, file.bytes),
      path.string() + ": the raw picture is not stored as unsigned integers (got SampleFormat 3, allowed 1)");
}

std::string bytes_of_fits(const RawPicture& raw) {
  const auto path = test_folder() / "a.fits";
  write_fits(path, raw);
  return bytes_of(path);
}

// The file with another card in place of that of a key.
std::string with_card(std::string bytes, const std::string& key, std::string card) {
  constexpr std::size_t kCard = 80;
  card.resize(kCard, ' ');
  for (std::size_t at = 0; at + kCard <= bytes.size(); at += kCard)
    if (bytes.substr(at, 9) == key + std::string(8 - key.size(), ' ') + "=")
      return bytes.replace(at, kCard, card);
  ADD_FAILURE() << "no card " << key;
  return bytes;
}

RawPicture read_fits_bytes(const std::string& bytes) {
  const auto path = test_folder() / "b.fits";
  put(path, bytes);
  return read_raw_picture(path);
}

// Cards tell the pattern of the picture as one sees it, whichever row is the first.
TEST(Fits, RowsFromTheBottomAreTurned) {
  const std::string bytes = bytes_of_fits(under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer));
  const RawPicture read = read_fits_bytes(with_card(bytes, "ROWORDER", "ROWORDER= 'BOTTOM-UP'"));
  EXPECT_EQ(read.codes, (std::vector<std::uint16_t>{3, 4, 1, 2}));
  EXPECT_EQ(read.mosaic, (std::vector<std::uint8_t>{0, 1, 1, 2}));
  RawPicture planes = one_pixel({kRed, kGreen, kBlue});
  planes.height = 3;
  planes.codes = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(read_fits_bytes(with_card(bytes_of_fits(planes), "ROWORDER", "ROWORDER= 'BOTTOM-UP'")).codes,
            (std::vector<std::uint16_t>{7, 8, 9, 4, 5, 6, 1, 2, 3}));
}

TEST(Fits, OffsetsShiftThePattern) {
  const std::string bytes = bytes_of_fits(under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer));
  const auto shifted = [&](int x, int y) {
    return read_fits_bytes(with_card(with_card(bytes, "EGAIN", "XBAYROFF= " + std::to_string(x)), "RDNOISE",
                                     "YBAYROFF= " + std::to_string(y)))
        .mosaic;
  };
  using Pattern = std::vector<std::uint8_t>;
  EXPECT_EQ(shifted(0, 2), (Pattern{0, 1, 1, 2})) << "RGGB";
  EXPECT_EQ(shifted(1, 0), (Pattern{1, 0, 2, 1})) << "GRBG";
  EXPECT_EQ(shifted(0, -1), (Pattern{1, 2, 0, 1})) << "GBRG";
  EXPECT_EQ(shifted(3, 1), (Pattern{2, 1, 1, 0})) << "BGGR";
}

TEST(Fits, APixelBelowZeroIsToldOf) {
  const std::string bytes = bytes_of_fits(one_pixel({kRed, kGreen, kBlue}));
  const auto path = test_folder() / "b.fits";
  EXPECT_EQ(refusal_of(path, with_card(bytes, "BZERO", "BZERO   =                  0.0")),
            path.string() + ": a pixel is below 0 (got -32668, allowed 0 to 65535)");
}

TEST(Fits, APatternIsReadInSmallLettersAndRefusedIfItIsUnknown) {
  const RawPicture raw = under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer);
  const auto path = test_folder() / "b.fits";
  const std::string bytes = bytes_of_fits(raw);
  EXPECT_EQ(read_fits_bytes(with_card(bytes, "BAYERPAT", "BAYERPAT= 'bggr    '")).mosaic,
            (std::vector<std::uint8_t>{2, 1, 1, 0}));
  EXPECT_EQ(
      refusal_of(path, with_card(bytes, "BAYERPAT", "BAYERPAT= 'CYGM    '")),
      path.string() + ": BAYERPAT is not a 2 x 2 pattern of R, G and B (got \"CYGM\", for example \"RGGB\")");
  RawPicture own = raw;
  own.channels = {"M", "G", "Y"};
  own.metadata = {{"mosaic", "M,G/G,Y"}};
  EXPECT_EQ(read_fits_bytes(bytes_of_fits(own)).codes, own.codes) << "whose history tells it";
}

TEST(Fits, APedestalBelowZeroIsRefused) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.black_level_dn = 0.5;
  const auto path = test_folder() / "b.fits";
  const std::string bytes = bytes_of_fits(raw);
  EXPECT_EQ(read_fits_bytes(bytes).black_level_dn, 0.5);
  EXPECT_EQ(refusal_of(path, with_card(bytes, "PEDESTAL", "PEDESTAL=               -100.0")),
            path.string() +
                ": PEDESTAL is negative, which programs interpret differently (got -100, allowed the code "
                "without light, 0 or more)");
}

// Channels have letters, digits, - and _ in their names.
TEST(Fits, TheHistoryTellsOfChannelsByAnyName) {
  RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  raw.metadata = {{"black_level_dn", "100"},   {"channel.O-III", "digital numbers"},
                  {"exposure_s", "0.01"},      {"exposure_s.2_b-", "4"},
                  {"exposure_s.Ha", "1"},      {"exposure_s.O-III", "2"},
                  {"mosaic_channels", "O-III"}};
  const auto path = test_folder() / "a.fits";
  write_fits(path, raw);
  EXPECT_EQ(read_raw_picture(path).metadata, raw.metadata);
}

// Readers take it for two rows of two.
TEST(Fits, ABayerPatternIsToldOfTwoByTwoFiltersWithLettersAlone) {
  const auto tells = [](const RawPicture& raw) {
    return bytes_of_fits(raw).find("BAYERPAT") != std::string::npos;
  };
  RawPicture raw = under_mosaic(one_pixel({kRed, kGreen, kBlue}), kBayer);
  EXPECT_TRUE(tells(raw));
  raw.channels[0] = "IR";
  EXPECT_FALSE(tells(raw));
  raw.channels[0] = "R";
  raw.mosaic_width = raw.width = 4;
  raw.height = 1;
  EXPECT_FALSE(tells(raw));
}

TEST(RawPicture, CapitalsNameTheSameKindOfFile) {
  const RawPicture raw = one_pixel({kRed, kGreen, kBlue});
  const auto folder = test_folder();
  write_dng(folder / "a.DNG", raw);
  write_fits(folder / "a.FITS", raw);
  write_fits(folder / "a.FIT", raw);
  for (const char* name : {"a.DNG", "a.FITS", "a.FIT"}) {
    EXPECT_TRUE(is_raw_picture(folder / name)) << name;
    EXPECT_EQ(read_raw_picture(folder / name).codes, raw.codes) << name;
  }
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
