#include "io/picture.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "io/error.h"
#include "io/exr.h"
#include "io/text.h"
#include "test_files.h"

namespace abbe {
namespace {

TEST(Picture, CodeValuesAreClampedAndRounded) {
  const auto path = test_folder() / "a.png";
  Image image{4, 1, {}, {{"Software", "Abbe"}}};
  image.channels.push_back({"R", {0, 0.5F, 1, 2}});
  image.channels.push_back({"G", {-1, 0.25F, std::numeric_limits<float>::quiet_NaN(), 0.001F}});
  image.channels.push_back(
      {"B", {1.4F / 255, 1.6F / 255, 254.4F / 255, std::numeric_limits<float>::infinity()}});
  image.channels.push_back({"ignored", {0, 0, 0, 0}});
  write_picture(path, image);
  const Image read = read_picture(path);
  ASSERT_EQ(read.channels.size(), 3U);
  const float expected[3][4] = {{0, 128, 255, 255}, {0, 64, 0, 0}, {1, 2, 254, 255}};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_FLOAT_EQ(read.channels[c].values[i], expected[c][i] / 255) << c << i;
  EXPECT_EQ(read.channels[0].name, "R");
  EXPECT_EQ(read.metadata.at("oiio:ColorSpace"), "sRGB");
  EXPECT_EQ(read.metadata.at("Software"), "Abbe");
}

TEST(Picture, OneChannelIsGreyAndTheExtensionChoosesTheFormat) {
  const auto folder = test_folder();
  const Image image{2, 1, {{"Y", {0, 1}}}, {{"Software", "Abbe"}, {"abbe:seed", "7"}}};
  for (const char* name : {"a.png", "a.tif", "a.jpg"}) write_picture(folder / name, image);
  EXPECT_EQ(bytes_of(folder / "a.png").substr(1, 3), "PNG");
  EXPECT_EQ(bytes_of(folder / "a.tif").substr(0, 2), "II");
  EXPECT_EQ(bytes_of(folder / "a.jpg").substr(0, 2), "\xFF\xD8");
  for (const char* name : {"a.png", "a.tif"}) {
    const Image read = read_picture(folder / name);
    ASSERT_EQ(read.channels.size(), 1U);
    EXPECT_EQ(read.channels[0].values, image.channels[0].values);
  }
}

// A plain text of a PNG is Latin-1, an international one UTF-8.
TEST(Picture, ATextOfAPngIsOfAnyLanguage) {
  const auto path = test_folder() / "a.png";
  const std::map<std::string, std::string> texts{{"scene", "Prüfling Nr. 3.json"}, {"lamp", "灯"}};
  write_picture(path, {1, 1, {{"Y", {0}}}, texts});
  const Image read = read_picture(path);
  for (const auto& [key, text] : texts) {
    EXPECT_EQ(read.metadata.at(key), text);
    EXPECT_NE(bytes_of(path).find("iTXt" + key), std::string::npos);
  }
}

TEST(Picture, RowsRunFromTheTopLeft) {
  const auto path = test_folder() / "a.png";
  write_picture(path, {2, 2, {{"Y", {0, 0.2F, 0.4F, 0.6F}}}, {}});
  const Image read = read_picture(path);
  EXPECT_EQ(read.width, 2);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_FLOAT_EQ(read.channels[0].values[i], 0.2F * static_cast<float>(i));
}

TEST(Picture, UnknownFormatIsAnOutputErrorAndLeavesNothing) {
  const auto folder = test_folder();
  try {
    write_picture(folder / "a.unknown", {1, 1, {{"Y", {0}}}, {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Picture, BrokenFilesAreInputErrors) {
  const auto folder = test_folder();
  Image noise{16, 16, {{"Y", {}}}, {}};
  for (std::size_t i = 0; i < 256; ++i)
    noise.channels[0].values.push_back(static_cast<float>(i * 89 % 256) / 255);
  write_picture(folder / "a.png", noise);
  put(folder / "cut.png", bytes_of(folder / "a.png").substr(0, 200));
  put(folder / "text.png", "no image");
  // Of a strip that a TIFF lacks the library tells, and says that it has read it.
  Image raw{32, 128, {{"raw", {}}}, {}};
  for (std::size_t i = 0; i < raw.pixels(); ++i)
    raw.channels[0].values.push_back(static_cast<float>(i * i % 16381));
  write_raw_picture(folder / "a.tif", raw);
  const std::string strips = bytes_of(folder / "a.tif");
  put(folder / "cut.tif", strips.substr(0, strips.size() / 2));
  for (const char* name : {"cut.png", "cut.tif", "text.png", "none.png", ""}) {
    try {
      const Image image = read_picture(folder / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input) << name;
    }
  }
}

// Whose library would tell of it on stderr.
TEST(Picture, DamagedPngsAreToldOfByOneSentence) {
  const auto path = test_folder() / "damaged.png";
  write_picture(path, {64, 64, {{"Y", std::vector<float>(64 * 64, 0.3F)}}, {}});
  const std::string sound = bytes_of(path);
  std::string flipped = sound;
  flipped[sound.find("IDAT") + 10] ^= 1;
  std::string header = sound;
  header[20] ^= 16;
  for (const std::string& bytes : {sound.substr(0, sound.size() / 2), sound.substr(0, 40),
                                   sound.substr(0, sound.size() - 1), flipped, header}) {
    put(path, bytes);
    testing::internal::CaptureStderr();
    std::string said;
    try {
      static_cast<void>(read_picture(path));
    } catch (const Error& error) {
      said = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_NE(said.find("damaged.png: truncated or corrupt"), std::string::npos) << said;
  }
}

TEST(Picture, FullDiskIsAnOutputErrorAndKeepsTheOldFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // threads of libraries do not survive a fork
  const auto folder = test_folder();
  const Image image{64, 64, {{"Y", std::vector<float>(4096, 0.5F)}}, {}};
  for (const char* name : {"a.png", "a.jpg"}) {
    write_picture(folder / name, image);
    const std::string old = bytes_of(folder / name);
    EXPECT_EXIT(write_on_full_disk(old.size() - 1, [&] { write_picture(folder / name, image); }),
                testing::ExitedWithCode(5), "");
    EXPECT_EQ(bytes_of(folder / name), old);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2);
}

/// The file announces 70000 x 1 pixels and holds none.
TEST(Picture, LimitsHoldBeforeAllocation) {
  const auto path = test_folder() / "wide.ppm";
  put(path, "P5 70000 1 255\n");
  try {
    const Image image = read_picture(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::resource) << error.what();
  }
}

TEST(Picture, FilesOfFloatsAreLinearWhateverTheirNames) {
  const auto folder = test_folder();
  const float value = 0.5F;
  OIIO::ImageSpec spec(1, 1, 1, OIIO::TypeDesc::FLOAT);
  for (const char* name : {"a.tif", "a.hdr"}) {
    spec.nchannels = name == std::string("a.hdr") ? 3 : 1;
    const std::vector<float> pixel(static_cast<std::size_t>(spec.nchannels), value);
    const auto output = OIIO::ImageOutput::create((folder / name).string());
    ASSERT_TRUE(output->open((folder / name).string(), spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixel.data()) && output->close())
        << name;
  }
  write_exr(folder / "a.exr", {1, 1, {{"R", {value}}}, {}});
  std::filesystem::copy(folder / "a.exr", folder / "b.EXR");
  write_picture(folder / "a.png", {1, 1, {{"Y", {value}}}, {}});
  for (const char* name : {"a.tif", "a.hdr", "a.exr", "b.EXR"}) {
    EXPECT_EQ(read_image(folder / name).metadata.at("oiio:ColorSpace"), "Linear") << name;
    EXPECT_NEAR(read_image(folder / name).channels[0].values[0], value, 2e-3) << name;
  }
  EXPECT_NE(read_image(folder / "a.png").metadata.at("oiio:ColorSpace"), "Linear");
}

TEST(Picture, RawCodesComeBackExactly) {
  const auto folder = test_folder();
  Image raw{4, 2, {}, {{"seed", "7"}, {"data_sha256", "ab"}}};
  raw.channels.push_back({"R", {0, 1, 2, 255, 256, 4095, 65534, 65535}});
  raw.channels.push_back({"G", {7, 6, 5, 4, 3, 2, 1, 0}});
  raw.channels.push_back({"B", {1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000}});
  for (const char* name : {"a.tif", "a.png"}) {
    write_raw_picture(folder / name, raw);
    const auto input = OIIO::ImageInput::open((folder / name).string());
    ASSERT_TRUE(input) << name;
    EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT16) << name;
    EXPECT_NE(input->spec().get_string_attribute("oiio:ColorSpace"), "sRGB") << name;
    std::vector<std::uint16_t> codes(24);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT16, codes.data()));
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(codes[3 * i + c], raw.channels[c].values[i]) << name << c << i;
  }
  EXPECT_EQ(read_picture(folder / "a.png").metadata.at("seed"), "7");
  EXPECT_EQ(read_picture(folder / "a.tif").metadata.at("ImageDescription"), "data_sha256: ab\nseed: 7\n");
}

TEST(Picture, ARawTiffHoldsAnyNumberOfPlanes) {
  const auto folder = test_folder();
  for (const std::size_t planes : {1U, 2U, 4U, 7U}) {
    Image raw{2, 1, {}, {}};
    for (std::size_t c = 0; c < planes; ++c)
      raw.channels.push_back({"c" + std::to_string(c), {static_cast<float>(10 * c), 60000}});
    write_raw_picture(folder / "a.tif", raw);
    const Image read = read_picture(folder / "a.tif");
    ASSERT_EQ(read.channels.size(), planes);
    EXPECT_EQ(OIIO::ImageInput::open((folder / "a.tif").string())->spec().alpha_channel, -1) << planes;
    for (std::size_t c = 0; c < planes; ++c)
      EXPECT_EQ(std::lround(65535 * read.channels[c].values[0]), 10 * static_cast<long>(c)) << planes;
    if (planes == 1) continue;
    try {
      write_raw_picture(folder / "a.png", raw);
      ADD_FAILURE() << planes;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::output);
      EXPECT_NE(std::string(error.what()).find("a .tif stores any number"), std::string::npos);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

/// Writes one row of red, green, blue and perhaps alpha in 8 bits, by OpenImageIO.
void write_codes(const std::filesystem::path& path, OIIO::ImageSpec spec,
                 const std::vector<std::uint8_t>& codes) {
  spec.set_format(OIIO::TypeDesc::UINT8);
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output->open(path.string(), spec) && output->write_image(OIIO::TypeDesc::UINT8, codes.data()) &&
              output->close());
}

TEST(Picture, ColoursBesideAlphaAreReadAsStored) {
  const auto path = test_folder() / "a.png";
  OIIO::ImageSpec spec(1, 1, 4);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const std::vector<std::uint8_t> pixel{200, 100, 50, 51};
  write_codes(path, spec, pixel);
  const Image read = read_image(path);
  ASSERT_EQ(read.channels.size(), 4U);
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_FLOAT_EQ(read.channels[c].values[0], static_cast<float>(pixel[c]) / 255) << c;
}

TEST(Picture, FilesOfIntegersSayHowTheyAreEncoded) {
  const auto folder = test_folder();
  const auto space = [&](const char* name) {
    const auto metadata = read_image(folder / name).metadata;
    const auto told = metadata.find("oiio:ColorSpace");
    return told == metadata.end() ? "" : told->second;
  };
  write_raw_picture(folder / "raw.png", {1, 1, {{"Y", {130}}}, {}});
  EXPECT_EQ(space("raw.png"), "Linear");
  OIIO::ImageSpec spec(1, 1, 3);
  spec.attribute("oiio:ColorSpace", "GammaCorrected");
  spec.attribute("oiio:Gamma", 2.22F);
  write_codes(folder / "gamma.png", spec, {130, 130, 130});
  EXPECT_EQ(space("gamma.png"), "Gamma2.22");
  put(folder / "a.ppm", "P6 1 1 255\nabc");
  EXPECT_EQ(space("a.ppm"), "") << "which says nothing";
}

/// The rows of an image that has one digit for each pixel.
std::string rows_of(const Image& image) {
  std::string rows;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (i > 0 && i % static_cast<std::size_t>(image.width) == 0) rows += "/";
    rows += std::to_string(std::lround(image.channels[0].values[i] * 255));
  }
  return rows;
}

TEST(Picture, IsTurnedUprightAsItsFileSays) {
  const auto path = test_folder() / "a.tif";
  const std::vector<std::uint8_t> codes{0, 1, 2, 3, 4, 5};
  const std::array<const char*, 8> upright_rows{"012/345",  "210/543",  "543/210",  "345/012",
                                                "03/14/25", "30/41/52", "52/41/30", "25/14/03"};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    OIIO::ImageSpec spec(3, 2, 1);
    spec.attribute(kOrientation, orientation);
    write_codes(path, spec, codes);
    const Image stored = read_image(path);
    EXPECT_EQ(rows_of(stored), "012/345") << orientation;
    EXPECT_EQ(stored.metadata.contains(kOrientation), orientation > 1) << orientation;
    const Image turned = apply_orientation(stored);
    EXPECT_EQ(rows_of(turned), upright_rows.at(static_cast<std::size_t>(orientation) - 1)) << orientation;
    EXPECT_FALSE(turned.metadata.contains(kOrientation)) << orientation;
  }
  EXPECT_EQ(rows_of(apply_orientation({2, 1, {{"Y", {0, 1.0F / 255}}}, {{kOrientation, "9"}}})), "01");
}

/// A Radiance picture of grey pixels, each this many parts of 128.
std::string radiance_file(const std::string& lines, const std::string& resolution, const std::string& parts) {
  std::string bytes = "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n";
  for (const char part : parts) bytes += std::string(3, part) + '\x81';
  return bytes;
}

// X counts to the right and Y upwards; the first of them runs from scan line to scan line.
TEST(Picture, OfRadianceIsTurnedUprightAsItsResolutionSays) {
  const auto path = test_folder() / "a.hdr";
  const std::string picture = "\x90\xa0\xb0\xc0\xd0\xe0";  // two rows of three from the top left
  for (const char* const resolution : {"-Y 2 +X 3", "-Y 2 -X 3", "+Y 2 +X 3", "+Y 2 -X 3", "+X 3 -Y 2",
                                       "+X 3 +Y 2", "-X 3 +Y 2", "-X 3 -Y 2"}) {
    const std::string axes = resolution;
    std::string stored;
    for (std::size_t i = 0; i < 6; ++i) {
      std::size_t x = axes[1] == 'X' ? i / 2 : i % 3;
      std::size_t y = axes[1] == 'X' ? i % 2 : i / 3;
      if (axes.find("-X") != std::string::npos) x = 2 - x;
      if (axes.find("+Y") != std::string::npos) y = 1 - y;
      stored += picture[3 * y + x];
    }
    put(path, radiance_file("", axes, stored));
    const Image turned = apply_orientation(read_image(path));
    ASSERT_EQ(turned.width, 3) << axes;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(turned.channels[0].values[i], static_cast<std::uint8_t>(picture[i]) / 128.0F) << axes << i;
  }
}

TEST(Picture, OfRadianceIsWhatItsLinesSay) {
  const auto path = test_folder() / "a.hdr";
  const auto read = [&](const std::string& lines) {
    put(path, radiance_file(lines, "-Y 1 +X 1", "\x80"));
    return read_image(path);
  };
  EXPECT_EQ(read("").channels[0].values[0], 1);
  const Image scaled = read("EXPOSURE=2\n# EXPOSURE=8\nCOLORCORR= 1 .5 4\nEXPOSURE= 2.5\n");
  EXPECT_FLOAT_EQ(scaled.channels[0].values[0], 0.2F);
  EXPECT_FLOAT_EQ(scaled.channels[1].values[0], 0.4F);
  EXPECT_FLOAT_EQ(scaled.channels[2].values[0], 0.05F);
  EXPECT_EQ(read("PRIMARIES= .7347 .2653 0 1 .0001 -.077 .32168 .33767\n").metadata.at(kPrimariesKey),
            "0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767");
  EXPECT_FALSE(read("GAMMA=1.0\nPRIMARIES=0 0 0 0 0 0 0 0\n").metadata.contains(kPrimariesKey));
  for (const auto& [line, said] :
       {std::pair("GAMMA=2.2", "values are not linear (got \"GAMMA=2.2\", allowed GAMMA=1)"),
        {"EXPOSURE=0", "factors of the pixels must be positive (got \"EXPOSURE=0\", allowed > 0)"},
        {"EXPOSURE=bright", "wrong count of numbers (got \"EXPOSURE=bright\", allowed 1)"},
        {"PRIMARIES=.64 .33", "wrong count of numbers (got \"PRIMARIES=.64 .33\", allowed 8)"}})
    try {
      static_cast<void>(read(std::string(line) + "\n"));
      ADD_FAILURE() << line;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input);
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
}

TEST(Picture, CapitalsNameTheSameKindOfFile) {
  const auto folder = test_folder();
  const Image image{2, 1, {{"raw", {7, 60000}}}, {{"seed", "7"}}};
  for (const char* ends : {".tif", ".png"}) {
    const std::string capitals = ends == std::string(".tif") ? ".TIF" : ".PNG";
    write_raw_picture(folder / ("a" + std::string(ends)), image);
    write_raw_picture(folder / ("a" + capitals), image);
    const Image read = read_picture(folder / ("a" + capitals));
    EXPECT_EQ(read.channels[0].values, read_picture(folder / ("a" + std::string(ends))).channels[0].values);
    EXPECT_EQ(read.metadata.contains("ImageDescription"), capitals == ".TIF");
  }
  EXPECT_EQ(extension_of(folder / "a.DNG"), ".dng");
  EXPECT_NO_THROW(require_extension("a.TIF", {".png", ".tif"}));
  EXPECT_THROW(require_extension("a.TIF", {".png"}), Error);
}

TEST(Picture, ARawCodeThatIsNoWholeNumberIsABug) {
  for (const float bad : {-1.0F, 0.5F, 65536.0F, std::numeric_limits<float>::quiet_NaN()}) try {
      write_raw_picture(test_folder() / "a.tif", {1, 1, {{"raw", {bad}}}, {}});
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::internal);
    }
}

}  // namespace
}  // namespace abbe
