// DNG files as other programs write them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dng_opcodes.h"
#include "io/error.h"
#include "io/raw_picture.h"
#include "test_files.h"
#include "tiff_entries.h"

namespace abbe {
namespace {

constexpr std::uint16_t kSubfileType = 254;
constexpr std::uint16_t kPhotometric = 262;
constexpr std::uint16_t kWriter = 305;
constexpr std::uint16_t kSubFolders = 330;

// One red pixel beside one green, of a second.
test::TiffEntries raw_file() {
  RawPicture raw;
  raw.width = 2;
  raw.height = 1;
  raw.channels = {"R", "G", "B"};
  raw.planes = {"raw"};
  raw.mosaic_width = 2;
  raw.mosaic = {0, 1, 1, 2};
  raw.codes = {300, 200};
  raw.black_level_dn = 16;
  raw.exposure_s = 1;
  const auto path = test_folder() / "a.dng";
  write_dng(path, raw);
  return {bytes_of(path)};
}

std::string refusal_of(const std::string& bytes) {
  const auto path = test_folder() / "a.dng";
  put(path, bytes);
  try {
    (void)read_raw_picture(path);
  } catch (const Error& error) {
    return std::string(error.what()).substr(path.string().size());
  }
  return "it was read";
}

// The same with a first picture of one pixel of 8 bits, a preview, beside which what is in the others stands.
test::TiffEntries behind_a_preview(test::TiffEntries file) {
  const std::uint32_t raw = file.first_folder();
  file.put_first({{kSubfileType, 1},
                  {256, 1},
                  {257, 1},
                  {258, 8},
                  {259, 1},
                  {kPhotometric, 1},
                  {273, 8},
                  {278, 1},
                  {279, 1},
                  {kSubFolders, raw}});
  return file;
}

// A preview shows colours and tones as a converter makes them.
TEST(Dng, PicturesThatAreNotRawAreRefused) {
  constexpr std::uint16_t kLayout = 50711;
  const auto told = [&](std::uint16_t tag, std::uint16_t as, std::uint16_t value) {
    test::TiffEntries file = raw_file();
    file.set_short(tag, as, value);
    return refusal_of(file.bytes);
  };
  EXPECT_EQ(told(kSubfileType, kSubfileType, 1),
            ": no raw picture in the file (got NewSubfileType 1 and PhotometricInterpretation 32803 first, "
            "allowed 0 "
            "and 32803 or 34892, or such a picture among its SubIFDs)");
  EXPECT_NE(told(kPhotometric, kPhotometric, 2).find("PhotometricInterpretation 2 first"), std::string::npos);
  EXPECT_EQ(told(kWriter, kLayout, 2), ": the mosaic filters are staggered (got CFALayout 2, allowed 1)");
}

// As most converters write them.
TEST(Dng, TheRawPictureBehindAPreviewIsRead) {
  const auto path = test_folder() / "a.dng";
  put(path, behind_a_preview(raw_file()).bytes);
  const RawPicture read = read_raw_picture(path);
  EXPECT_EQ(read.codes, (std::vector<std::uint16_t>{300, 200}));
  EXPECT_EQ(read.mosaic, (std::vector<std::uint8_t>{0, 1, 1, 2}));
  EXPECT_EQ(read.black_level_dn, 16);
  test::TiffEntries two_previews = raw_file();
  two_previews.set_short(kSubfileType, kSubfileType, 1);
  EXPECT_NE(refusal_of(behind_a_preview(two_previews).bytes).find("no raw picture in the file"),
            std::string::npos);
}

TEST(Dng, CompressionThatIsNotReadIsToldAsSuch) {
  constexpr std::uint16_t kCompression = 259;
  test::TiffEntries file = raw_file();
  file.set_short(kCompression, kCompression, 34892);  // of lossy JPEG
  EXPECT_EQ(refusal_of(file.bytes),
            ": the raw picture is damaged or has an unsupported compression (got Compression 34892); convert "
            "it to an uncompressed DNG with a raw converter");
}

// The file of one row with an opcode list of that tag.
RawPicture with_opcodes(std::uint16_t tag, const std::string& list) {
  test::TiffEntries file = raw_file();
  file.set_bytes(kWriter, tag, list);
  const auto path = test_folder() / "a.dng";
  put(path, file.bytes);
  return read_raw_picture(path);
}

std::string opcode_refusal(std::uint16_t tag, const std::string& list) {
  test::TiffEntries file = raw_file();
  file.set_bytes(kWriter, tag, list);
  return refusal_of(file.bytes);
}

// Pixel centres lie at a quarter and three quarters of the width, the points of the map at its ends.
TEST(DngOpcodes, AGainMapMultipliesByABilinearGrid) {
  const RawPicture even = with_opcodes(test::kOpcodeList2, test::gain_map({2}));
  EXPECT_EQ(even.codes, (std::vector<std::uint16_t>{300, 200}));
  EXPECT_EQ(even.corrected, (std::vector<float>{2 * 284, 2 * 184}));
  const RawPicture sloped = with_opcodes(test::kOpcodeList2, test::gain_map({1, 3}));
  EXPECT_EQ(sloped.corrected, (std::vector<float>{284 * 1.5F, 184 * 2.5F}));
  ASSERT_EQ(sloped.opcodes.size(), 1U);
  EXPECT_EQ(sloped.opcodes[0].text(), "GainMap of OpcodeList2");
  EXPECT_TRUE(sloped.opcodes[0].is_applied);
  EXPECT_EQ(with_opcodes(test::kOpcodeList2, test::gain_map({2}, 0, 1, true)).corrected, even.corrected)
      << "an optional one";
}

// The list behind demosaicking counts the channels of the filters as planes: the second pixel is green.
TEST(DngOpcodes, TheThirdListKnowsTheChannelsOfAMosaic) {
  EXPECT_EQ(with_opcodes(test::kOpcodeList3, test::gain_map({2}, 1)).corrected,
            (std::vector<float>{284, 2 * 184}));
  EXPECT_EQ(with_opcodes(test::kOpcodeList2, test::gain_map({2}, 1)).corrected,
            (std::vector<float>{284, 184}))
      << "a mosaic has one plane";
}

// The first list works on stored codes, the second on values that are 1 at white, 65535 - 16 above black.
TEST(DngOpcodes, AMapPolynomialTakesTheValuesOfItsList) {
  const RawPicture first = with_opcodes(test::kOpcodeList1, test::map_polynomial({10, 2}));
  EXPECT_EQ(first.codes, (std::vector<std::uint16_t>{610, 410}));
  EXPECT_TRUE(first.corrected.empty());
  const RawPicture second = with_opcodes(test::kOpcodeList2, test::map_polynomial({0, 0.5, 4}));
  for (const std::size_t i : {0U, 1U}) {
    const double x = (i == 0 ? 284 : 184) / 65519.0;
    EXPECT_NEAR(static_cast<double>(second.corrected[i]), 65519 * (0.5 * x + 4 * x * x), 1e-4) << i;
  }
}

TEST(DngOpcodes, MandatoryOnesThatAreNotAppliedAreRefusedByName) {
  const std::string parameters(48, '\0');
  for (const auto& [id, name] : {std::pair{1U, "WarpRectilinear"},
                                 {3U, "FixVignetteRadial"},
                                 {5U, "FixBadPixelsList"},
                                 {13U, "ScalePerColumn"},
                                 {99U, "number 99"}}) {
    EXPECT_EQ(opcode_refusal(test::kOpcodeList3, test::opcode_list(id, parameters)),
              ": a mandatory correction is not supported (got the opcode " + std::string(name) +
                  " of OpcodeList3, allowed GainMap and MapPolynomial); convert the file to a linear picture "
                  "with a raw converter");
    const RawPicture read = with_opcodes(test::kOpcodeList3, test::opcode_list(id, parameters, true));
    ASSERT_EQ(read.opcodes.size(), 1U);
    EXPECT_EQ(read.opcodes[0].name, name);
    EXPECT_FALSE(read.opcodes[0].is_applied);
    EXPECT_TRUE(read.corrected.empty());
  }
}

TEST(DngOpcodes, DamagedListsAreRefused) {
  const std::string sound = test::gain_map({1, 3});
  EXPECT_EQ(opcode_refusal(test::kOpcodeList2, sound.substr(0, sound.size() - 1)),
            ": OpcodeList2 is damaged: it ends within an opcode");
  std::string larger = sound;
  larger.at(sound.size() - 49) = 9;  // the last byte of the number of rows
  EXPECT_EQ(opcode_refusal(test::kOpcodeList2, larger),
            ": OpcodeList2 is damaged: a GainMap does not have the declared size");
  EXPECT_EQ(opcode_refusal(test::kOpcodeList1, test::map_polynomial({1, std::nan("")})),
            ": OpcodeList1 is damaged: a number is not finite");
}

}  // namespace
}  // namespace abbe
