// What picture files say of their colours.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <boost/crc.hpp>

#include <cmath>
#include <cstring>

#include "icc_profile.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/picture_codec.h"
#include "test_files.h"

namespace abbe {
namespace {

using test::curve_tag;
using test::icc_profile;
using test::kP3Columns;
using test::kSrgbColumns;
using test::parametric_tag;
using test::primaries_and_curve;
using test::ProfileTags;

/// Encoding, primaries and profile as an image tells them, with bars between them.
std::string told_by(const std::filesystem::path& path) {
  const Image image = read_image(path);
  const auto text = [&image](const char* key) {
    const auto told = image.metadata.find(key);
    return told == image.metadata.end() ? "" : told->second;
  };
  return text(kColorSpace) + "|" + text(kPrimariesKey) + "|" + text(kProfileKey);
}

/// Writes a picture of one pixel by OpenImageIO.
void write_pixel(const std::filesystem::path& path, OIIO::ImageSpec spec) {
  const std::vector<float> pixel(static_cast<std::size_t>(spec.nchannels), 0.5F);
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output && output->open(path.string(), spec) &&
              output->write_image(OIIO::TypeDesc::FLOAT, pixel.data()) && output->close());
}

OIIO::ImageSpec with_profile(const std::string& profile, int channels = 3,
                             const OIIO::TypeDesc& format = OIIO::TypeDesc::UINT8) {
  OIIO::ImageSpec spec(1, 1, channels, format);
  spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                 profile.data());
  return spec;
}

/// What is told by a picture with a profile of those tags, called "p".
std::string told_with(const ProfileTags& tags, const std::string& space = "RGB ", int channels = 3) {
  const auto path = test_folder() / "a.jpg";
  write_pixel(path, with_profile(icc_profile("p", space, tags), channels));
  return told_by(path);
}

std::string encoding_with(const std::string& curve) {
  const std::string told = told_with(primaries_and_curve(kSrgbColumns, curve));
  return told.substr(0, told.find('|'));
}

// x = X/(X + Y + Z) and so on of its columns, and the white of all profiles.
constexpr const char* kP3Text = "0.682076 0.319378 0.284578 0.674588 0.155887 0.0660883 0.3457 0.3585";

TEST(PictureColors, AreThoseOfAProfileInAnyFile) {
  const std::string profile =
      icc_profile("Display P3", "RGB ", primaries_and_curve(kP3Columns, test::srgb_curve()));
  for (const char* const name : {"a.jpg", "a.tif", "a.png"}) {
    const auto path = test_folder() / name;
    write_pixel(path, with_profile(profile));
    EXPECT_EQ(told_by(path), std::string("sRGB|") + kP3Text + "|Display P3") << name;
  }
  EXPECT_EQ(told_with({}).substr(0, 16), "unsupported tone") << "without any of its tags";
}

TEST(PictureColors, AreEncodedByTheCurvesOfAProfile) {
  EXPECT_EQ(encoding_with(test::srgb_curve()), "sRGB");
  EXPECT_EQ(encoding_with(curve_tag({})), "Linear");
  EXPECT_EQ(encoding_with(curve_tag({461})), "Gamma1.80078") << "in 256ths";
  EXPECT_EQ(encoding_with(parametric_tag(0, {2.2})), "Gamma2.2");
  EXPECT_EQ(encoding_with(parametric_tag(1, {2.2, 1, 0})), "Gamma2.2");
  EXPECT_EQ(encoding_with(parametric_tag(4, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045, 0, 0})),
            "sRGB");
  std::vector<std::uint32_t> table;
  for (int i = 0; i <= 40; ++i) {  // as small profiles have it
    const double code = i / 40.0;
    table.push_back(static_cast<std::uint32_t>(
        std::lround(65535 * (code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4)))));
  }
  EXPECT_EQ(encoding_with(curve_tag(table)), "sRGB");
  const std::string other = "unsupported tone curves or primaries";
  EXPECT_EQ(encoding_with(parametric_tag(3, {1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081})), other)
      << "of Rec.709";
  EXPECT_EQ(encoding_with(parametric_tag(2, {2.2, 1, 0, 0.1})), other) << "with black at 0.1";
  EXPECT_EQ(encoding_with("curv"), other);
}

TEST(PictureColors, OfProfilesWithoutThreePrimariesAreUnknown) {
  const std::string curve = test::srgb_curve();
  const ProfileTags sound = primaries_and_curve(kSrgbColumns, curve);
  EXPECT_TRUE(told_with(sound).starts_with("sRGB|0.6484"));
  ProfileTags uneven = sound;
  uneven[4].second = curve_tag({461});
  ProfileTags lacking = sound;
  lacking.erase(lacking.begin());
  ProfileTags table = sound;
  table.emplace_back("A2B0", std::string(32, '\0'));
  for (const ProfileTags& tags : {uneven, lacking})
    EXPECT_TRUE(told_with(tags).starts_with("unsupported tone curves or primaries|"));
  EXPECT_TRUE(told_with(table).starts_with("colour lookup tables or L*a*b*|"));
  EXPECT_TRUE(told_with({{"kTRC", curve}}, "GRAY").starts_with("unsupported tone curves")) << "of grey";
}

TEST(PictureColors, OfGreyNeedNoPrimaries) {
  EXPECT_EQ(told_with({{"kTRC", curve_tag({461})}}, "GRAY", 1), "Gamma1.80078||p");
  EXPECT_EQ(told_with(primaries_and_curve(kP3Columns, test::srgb_curve()), "RGB ", 1), "sRGB||p");
}

TEST(PictureColors, OfFloatsAreLinearByTheirProfileToo) {
  const auto path = test_folder() / "a.tif";
  const auto told = [&](const std::string& curve) {
    const std::string profile = icc_profile("p", "RGB ", primaries_and_curve(kSrgbColumns, curve));
    write_pixel(path, with_profile(profile, 3, OIIO::TypeDesc::FLOAT));
    return told_by(path).substr(0, 6);
  };
  EXPECT_EQ(told(curve_tag({})), "Linear");
  EXPECT_EQ(told(test::srgb_curve()), "floats");
}

TEST(PictureColors, OfDamagedProfilesAreUnknown) {
  const auto path = test_folder() / "a.jpg";
  const std::string curve = curve_tag({0, 32768, 65535});
  const std::string profile = icc_profile("p", "RGB ", primaries_and_curve(kSrgbColumns, curve));
  const auto told = [&](const std::string& in_place, std::size_t after, const std::string& bytes) {
    std::string damaged = profile;
    damaged.replace(profile.find(in_place) + after, bytes.size(), bytes);
    write_picture(path, {1, 1, {{"R", {0.5F}}, {"G", {0.5F}}, {"B", {0.5F}}}, {}});
    test::put_profile(path, damaged);
    return told_by(path);
  };
  EXPECT_TRUE(told("rXYZ", 0, "rXYZ").starts_with("Linear|"));
  for (const char* const tag : {"rXYZ", "rTRC"})
    EXPECT_TRUE(told(tag, 8, std::string(4, '\0')).starts_with("unsupported tone curves"))
        << tag << " of no length";
  EXPECT_TRUE(told("curv", 8, "\x7F\xFF\xFF\xFF").starts_with("unsupported tone curves"))
      << "of many numbers";
}

std::string chunk(const std::string& type, const std::string& data) {
  boost::crc_32_type crc;
  crc.process_bytes((type + data).data(), type.size() + data.size());
  return test::in_bytes(static_cast<std::uint32_t>(data.size())) + type + data +
         test::in_bytes(crc.checksum());
}

TEST(PictureColors, OfPngsAreThoseOfTheirChunks) {
  const auto path = test_folder() / "a.png";
  const Image image{1, 1, {{"R", {60}}, {"G", {40}}, {"B", {20}}}, {}};
  const auto told = [&](const std::string& chunks) {
    const std::string png = bytes_of(path);
    constexpr std::size_t kAfterHeader = 33;
    put(path, png.substr(0, kAfterHeader) + chunks + png.substr(kAfterHeader));
    return told_by(path);
  };
  std::string primaries;
  for (const std::uint32_t n : {31270U, 32900U, 68000U, 32000U, 26500U, 69000U, 15000U, 6000U})
    primaries += test::in_bytes(n);
  write_raw_picture(path, image);
  EXPECT_EQ(told(chunk("cHRM", primaries)), "Linear|0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329|");
  write_raw_picture(path, image);
  EXPECT_EQ(told(chunk("cICP", {12, 13, 0, 1})), "cICP 12 13 0 1||");
  write_raw_picture(path, image);
  EXPECT_EQ(told(chunk("cICP", {1, 13, 0, 1})), "sRGB||");
  write_raw_picture(path, image);
  EXPECT_EQ(told(chunk("iCCP", std::string("p\0\0damaged", 10))), "an ICC profile that cannot be read||");
}

/// What is told by a PNG of one pixel that OpenImageIO writes, with those chunks.
std::string told_with_chunks(const std::string& chunks, int channels = 3) {
  const auto path = test_folder() / "a.png";
  write_pixel(path, OIIO::ImageSpec(1, 1, channels, OIIO::TypeDesc::UINT8));
  const std::string png = bytes_of(path);
  EXPECT_EQ(png.find("gAMA"), std::string::npos);
  EXPECT_EQ(png.find("sRGB"), std::string::npos);
  constexpr std::size_t kAfterHeader = 33;
  put(path, png.substr(0, kAfterHeader) + chunks + png.substr(kAfterHeader));
  return told_by(path);
}

/// Of white, red, green and blue.
std::string primaries_chunk(const std::vector<std::uint32_t>& numbers) {
  std::string data;
  for (const std::uint32_t number : numbers) data += test::in_bytes(number);
  return chunk("cHRM", data);
}

TEST(PictureColors, OfPngsWithTheGammaOfSrgbAreSrgb) {
  const std::string gamma = chunk("gAMA", test::in_bytes(45455));
  const std::string rec709 = primaries_chunk({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000});
  EXPECT_EQ(told_with_chunks(gamma), "sRGB||");
  EXPECT_EQ(told_with_chunks(gamma, 1), "sRGB||");
  EXPECT_EQ(told_with_chunks(gamma + rec709), "sRGB|0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329|");
  EXPECT_EQ(told_with_chunks(chunk("gAMA", test::in_bytes(50000))), "Gamma2||") << "1/0.5";
}

TEST(PictureColors, OfPngsAreNotThoseOfChunksThatReadersLeaveOut) {
  const std::string profile = chunk("iCCP", std::string("p\0\0damaged", 10));
  EXPECT_EQ(told_with_chunks(chunk("sRGB", {0}) + profile), "sRGB||");
  EXPECT_EQ(told_with_chunks(profile, 1), "sRGB||") << "of grey";
  EXPECT_EQ(told_with_chunks(profile), "an ICC profile that cannot be read||");
  EXPECT_EQ(told_with_chunks(primaries_chunk({0, 0, 0, 0, 0, 0, 0, 0})), "sRGB||");
  EXPECT_EQ(told_with_chunks(primaries_chunk({31270, 32900})), "sRGB||");
  EXPECT_EQ(told_with_chunks(primaries_chunk({31270, 32900, 0xFFFFFFFBU, 33000, 30000, 60000, 15000, 6000})),
            "sRGB||")
      << "of -5 as red's x";
  EXPECT_EQ(told_with_chunks(primaries_chunk({31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600})),
            "sRGB|0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329|")
      << "of Rec.2020, whose red is at the edge of what is";
}

TEST(PictureColors, OfJpegsWithoutAllOfTheirProfileAreUnknown) {
  const auto path = test_folder() / "a.jpg";
  write_pixel(path, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::UINT8));
  const std::string plain = bytes_of(path);
  const std::string profile = icc_profile("p", "RGB ", primaries_and_curve(kP3Columns, test::srgb_curve()));
  const auto told = [&](const std::string& data, const std::string& fill = "") {
    const std::string size = test::in_bytes(static_cast<std::uint32_t>(data.size() + 2), 2);
    put(path, plain.substr(0, 2) + fill + "\xFF\xE2" + size + data + plain.substr(2));
    return told_by(path);
  };
  const auto segment = [](char count) { return std::string("ICC_PROFILE\0\1", 13) + count; };
  EXPECT_TRUE(told(segment(1) + profile).ends_with("|p"));
  EXPECT_EQ(told(segment(2) + profile.substr(0, 200)), "an ICC profile that cannot be read||");
  EXPECT_EQ(told(segment(2) + profile.substr(0, 200), "\xFF\xFF"), "an ICC profile that cannot be read||");
  EXPECT_EQ(told(segment(1)), "an ICC profile that cannot be read||") << "of no bytes";
  EXPECT_EQ(told("MPF and more of that"), "sRGB||");
}

TEST(PictureColors, OfWhatAbbeWritesAreSrgbsOrUntold) {
  const auto folder = test_folder();
  const Image image{1, 1, {{"R", {0.5F}}, {"G", {0.5F}}, {"B", {0.5F}}}, {}};
  const Image codes{1, 1, {{"R", {60}}, {"G", {40}}, {"B", {20}}}, {}};
  for (const char* const name : {"a.png", "a.jpg", "a.tif"}) write_picture(folder / name, image);
  EXPECT_EQ(told_by(folder / "a.png"), "sRGB||");
  EXPECT_EQ(told_by(folder / "a.jpg"), "sRGB||");
  EXPECT_EQ(told_by(folder / "a.tif"), "||");
  for (const char* const name : {"raw.png", "raw.tif"}) write_raw_picture(folder / name, codes);
  EXPECT_EQ(told_by(folder / "raw.png"), "Linear||");
  EXPECT_EQ(told_by(folder / "raw.tif"), "||");
  write_exr(folder / "a.exr", image);
  EXPECT_EQ(told_by(folder / "a.exr"), "Linear||");
}

template <typename Number>
std::string little_endian(std::initializer_list<Number> numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), std::data(numbers), bytes.size());
  return bytes;
}

/// A TIFF of one pixel of so many samples, with the tags of numbers above 279 as 10000ths.
std::string tiff(std::uint32_t photometric, std::uint32_t samples,
                 const std::vector<std::pair<std::uint16_t, std::vector<std::uint32_t>>>& rationals) {
  const auto count = static_cast<std::uint32_t>(9 + rationals.size());
  std::uint32_t at = 10 + 12 * count + 4;
  std::string entries;
  std::string data;
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t numbers, std::uint32_t value) {
    entries += little_endian<std::uint16_t>({tag, type}) + little_endian<std::uint32_t>({numbers, value});
  };
  const auto append = [&](const std::string& bytes) {
    data += bytes;
    at += static_cast<std::uint32_t>(bytes.size());
  };
  constexpr std::uint16_t kShort = 3;
  constexpr std::uint16_t kRational = 5;
  entry(256, kShort, 1, 1);
  entry(257, kShort, 1, 1);
  entry(258, kShort, samples, at);
  append(little_endian<std::uint16_t>({8, 8, 8, 8}));
  entry(259, kShort, 1, 1);
  entry(262, kShort, 1, photometric);
  entry(273, kShort, 1, at);
  append("abcd");
  entry(277, kShort, 1, samples);
  entry(278, kShort, 1, 1);
  entry(279, kShort, 1, samples);
  for (const auto& [tag, numbers] : rationals) {
    entry(tag, kRational, static_cast<std::uint32_t>(numbers.size()), at);
    for (const std::uint32_t number : numbers) append(little_endian<std::uint32_t>({number, 10000}));
  }
  return "II" + little_endian<std::uint16_t>({42, 8, 0, static_cast<std::uint16_t>(count)}) + entries +
         std::string(4, '\0') + data;
}

TEST(PictureColors, OfTiffsAreThoseOfTheirTags) {
  constexpr std::uint32_t kRgb = 2;
  constexpr std::uint32_t kInks = 5;
  const auto path = test_folder() / "a.tif";
  const auto told = [&](const std::string& bytes) {
    put(path, bytes);
    return told_by(path);
  };
  const std::vector<std::uint32_t> p3{6800, 3200, 2650, 6900, 1500, 600};
  EXPECT_EQ(told(tiff(kRgb, 3, {})), "||");
  EXPECT_EQ(told(tiff(kRgb, 3, {{318, {3127, 3290}}, {319, p3}})),
            "|0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329|");
  EXPECT_EQ(told(tiff(kRgb, 3, {{319, p3}})), "|0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329|");
  EXPECT_EQ(told(tiff(kRgb, 3, {{318, {3457, 3585}}})), "|0.64 0.33 0.3 0.6 0.15 0.06 0.3457 0.3585|");
  EXPECT_EQ(told(tiff(kRgb, 3, {{319, {0, 0, 0, 0, 0, 0}}})), "||") << "of a writer that knows none";
  EXPECT_EQ(told(tiff(kRgb, 3, {{318, {0, 0}}, {319, p3}})), "|0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329|");
  EXPECT_EQ(told(tiff(kInks, 4, {})), "CMYK||");
}

TEST(PictureColors, OfJpegsThatExifCallsAnythingButSrgbAreUnknown) {
  const auto path = test_folder() / "a.jpg";
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Exif:ColorSpace", 65535);
  write_pixel(path, spec);
  EXPECT_EQ(told_by(path), "uncalibrated||");
  spec.attribute("Exif:ColorSpace", 2);
  write_pixel(path, spec);
  EXPECT_EQ(told_by(path), "number 2 of Exif||") << "as some write Adobe RGB";
  spec.attribute("Exif:ColorSpace", 1);
  write_pixel(path, spec);
  EXPECT_EQ(told_by(path), "sRGB||");
}

// The library reads such files, but not their profiles.
TEST(PictureColors, OfWebpsWithAProfileAreUnknown) {
  const auto path = test_folder() / "a.webp";
  if (!OIIO::ImageOutput::create(path.string())) GTEST_SKIP() << "OpenImageIO without WebP";
  write_pixel(path, OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::UINT8));
  EXPECT_EQ(told_by(path), "sRGB||");
  const std::string plain = bytes_of(path);
  const std::string pixels = plain.substr(plain.find("VP8", 8 + 4));
  const std::string extended = "WEBPVP8X" + little_endian<std::uint32_t>({10, 0x20}) + std::string(6, '\0') +
                               "ICCP" + little_endian<std::uint32_t>({4}) + "none" + pixels;
  put(path, "RIFF" + little_endian<std::uint32_t>({static_cast<std::uint32_t>(extended.size())}) + extended);
  EXPECT_EQ(told_by(path), "an ICC profile that cannot be read||");
}

// Of a display with the primaries of P3 and a gamma of 2.6, and of one that nobody knows.
TEST(PictureColors, APngTellsHowItsCodesAreRead) {
  const auto path = test_folder() / "a.png";
  const Image image{1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}};
  const auto written = [&](const std::map<std::string, std::string>& told) {
    Image picture = image;
    picture.metadata = told;
    write_picture(path, picture);
    return read_picture(path).metadata;
  };
  const std::string p3 = "0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329";
  const auto told = written({{kColorSpace, "Gamma2.6"}, {kPrimariesKey, p3}});
  EXPECT_EQ(told.at(kPrimariesKey), p3);
  EXPECT_NEAR(std::stod(told.at(kColorSpace).substr(std::string_view(kGamma).size())), 2.6, 1e-3);
  const auto unknown = written({{kColorSpace, "that of a projector"}});
  EXPECT_FALSE(unknown.contains(kPrimariesKey));
  for (const char* chunk : {"gAMA", "cHRM", "sRGB"})
    EXPECT_EQ(bytes_of(path).find(chunk), std::string::npos) << chunk;
}

}  // namespace
}  // namespace abbe
