// DNG files as other programs write them.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

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
  EXPECT_EQ(
      told(kSubfileType, kSubfileType, 1),
      ": it holds no raw picture (got NewSubfileType 1 and PhotometricInterpretation 32803 first, allowed 0 "
      "and 32803 or 34892, or such a picture among its SubIFDs)");
  EXPECT_NE(told(kPhotometric, kPhotometric, 2).find("PhotometricInterpretation 2 first"), std::string::npos);
  EXPECT_EQ(told(kWriter, kLayout, 2),
            ": the filters of its mosaic are staggered (got CFALayout 2, allowed 1)");
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
  EXPECT_NE(refusal_of(behind_a_preview(two_previews).bytes).find("it holds no raw picture"),
            std::string::npos);
}

TEST(Dng, CompressionThatIsNotReadIsToldAsSuch) {
  constexpr std::uint16_t kCompression = 259;
  test::TiffEntries file = raw_file();
  file.set_short(kCompression, kCompression, 34892);  // of lossy JPEG
  EXPECT_EQ(refusal_of(file.bytes),
            ": its raw picture is damaged, or compressed as is not read here (got Compression 34892); a raw "
            "converter can make an uncompressed DNG of it");
}

}  // namespace
}  // namespace abbe
