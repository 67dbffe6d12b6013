#include "io/exr.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <limits>

#include "io/error.h"
#include "test_files.h"

namespace abbe {
namespace {

Image sample_image() {
  Image image{3, 2, {}, {{"abbe:seed", "7"}, {"comments", "λ\nsecond line"}}};
  image.channels.push_back({"R", {0, -0.0F, 1.5F, -2, 3e38F, 1e-40F}});
  image.channels.push_back(
      {"Variance.R",
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 4, 5, 6, 7}});
  return image;
}

ErrorCode reading_error(const std::filesystem::path& path, std::string* message = nullptr) {
  try {
    const Image image = read_exr(path);
  } catch (const Error& error) {
    if (message) *message = error.what();
    return error.code;
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::internal;
}

TEST(Exr, EveryBitAndTheMetadataSurvive) {
  const auto path = test_folder() / "a.exr";
  const Image image = sample_image();
  write_exr(path, image);
  const Image read = read_exr(path);
  EXPECT_EQ(read.width, 3);
  EXPECT_EQ(read.height, 2);
  EXPECT_EQ(read.metadata, image.metadata);
  ASSERT_EQ(read.channels.size(), 2U);
  for (const ImageChannel& channel : image.channels)
    for (std::size_t i = 0; i < image.pixels(); ++i)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(read.find(channel.name)->values[i]),
                std::bit_cast<std::uint32_t>(channel.values[i]))
          << channel.name << i;
}

// Two pixels of a channel of halves and one of integers, as a data window of that display window.
Image two_pixels(const Imath::Box2i& display, const Imath::Box2i& data) {
  const auto path = test_folder() / "half.exr";
  Imf::Header header(display, data);
  header.channels().insert("H", Imf::Channel(Imf::HALF));
  header.channels().insert("U", Imf::Channel(Imf::UINT));
  half halves[2] = {half(0.5F), half(-2.0F)};
  unsigned integers[2] = {3, 70000};
  Imf::FrameBuffer buffer;
  buffer.insert("H", Imf::Slice::Make(Imf::HALF, halves, header.dataWindow()));
  buffer.insert("U", Imf::Slice::Make(Imf::UINT, integers, header.dataWindow()));
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  return read_exr(path);
}

TEST(Exr, HalfAndIntegerChannelsBecomeFloat) {
  const Imath::Box2i window({5, -3}, {6, -3});
  const Image image = two_pixels(window, window);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.find("H")->values, (std::vector<float>{0.5F, -2}));
  EXPECT_EQ(image.find("U")->values, (std::vector<float>{3, 70000}));
}

// The display window is the picture: black where there are no data, and without those beyond it.
TEST(Exr, APictureIsItsDisplayWindow) {
  const Image within = two_pixels({{0, 0}, {2, 1}}, {{1, 1}, {2, 1}});
  EXPECT_EQ(within.width, 3);
  EXPECT_EQ(within.height, 2);
  EXPECT_EQ(within.find("U")->values, (std::vector<float>{0, 0, 0, 0, 3, 70000}));
  const Image over = two_pixels({{0, 0}, {1, 0}}, {{-1, 0}, {0, 0}});
  EXPECT_EQ(over.find("U")->values, (std::vector<float>{70000, 0}));
  const Image beside = two_pixels({{0, 0}, {0, 1}}, {{5, -3}, {6, -3}});
  EXPECT_EQ(beside.find("U")->values, (std::vector<float>{0, 0}));
}

TEST(Exr, EveryTruncationIsAnInputError) {
  const auto path = test_folder() / "a.exr";
  write_exr(path, sample_image());
  const std::string bytes = bytes_of(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    put(path, bytes.substr(0, size));
    EXPECT_EQ(reading_error(path), ErrorCode::input) << size << " of " << bytes.size();
  }
}

TEST(Exr, MissingAndForeignFilesAreInputErrors) {
  const auto folder = test_folder();
  std::string message;
  EXPECT_EQ(reading_error(folder / "none.exr", &message), ErrorCode::input);
  EXPECT_EQ(message, (folder / "none.exr").string() + ": no such file");
  EXPECT_EQ(reading_error(folder), ErrorCode::input);
  put(folder / "text.exr", "no image");
  EXPECT_EQ(reading_error(folder / "text.exr"), ErrorCode::input);
}

/// A file of a few hundred bytes that announces `width` x `height` pixels in `channels` channels.
void put_announcement(const std::filesystem::path& path, int width, int height, int channels) {
  Imf::Header header(width, height);
  for (int i = 0; i < channels; ++i)
    header.channels().insert("C" + std::to_string(i), Imf::Channel(Imf::FLOAT));
  const Imf::OutputFile file(path.c_str(), header);
}

TEST(Exr, AFileWithoutAllItsPixelsIsTruncated) {
  const auto path = test_folder() / "begun.exr";
  std::string message;
  put_announcement(path, 4, 4, 1);
  EXPECT_EQ(reading_error(path, &message), ErrorCode::input);
  EXPECT_EQ(message, path.string() + ": truncated");
}

TEST(Exr, LimitsHoldBeforeAllocation) {
  const auto path = test_folder() / "large.exr";
  std::string message;
  put_announcement(path, 65537, 1, 1);
  EXPECT_EQ(reading_error(path, &message), ErrorCode::resource);
  EXPECT_EQ(message,
            path.string() +
                ": image too large (got 65537 x 1 pixels, allowed edges of 65536 and 268435456 in all)");
  put_announcement(path, 32768, 16384, 1);
  EXPECT_EQ(reading_error(path), ErrorCode::resource);
  put_announcement(path, 16384, 16384, 9);
  EXPECT_EQ(reading_error(path, &message), ErrorCode::resource);
  EXPECT_EQ(message, path.string() +
                         ": image too large (got 9 channels of 268435456 pixels, allowed 8589934592 bytes)");
}

TEST(Exr, FullDiskIsAnOutputErrorAndKeepsTheOldFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // threads of libraries do not survive a fork
  const auto path = test_folder() / "a.exr";
  write_exr(path, sample_image());
  const std::string old = bytes_of(path);
  for (const std::size_t space : {std::size_t{100}, old.size() - 1})
    EXPECT_EXIT(write_on_full_disk(space, [&] { write_exr(path, sample_image()); }),
                testing::ExitedWithCode(5), "")
        << space;
  EXPECT_EXIT(write_on_full_disk(old.size(), [&] { write_exr(path, sample_image()); }),
              testing::ExitedWithCode(0), "");
  EXPECT_EQ(bytes_of(path), old);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
}

TEST(Exr, UnwritablePlacesAreOutputErrors) {
  try {
    write_exr("/nonexistent/a.exr", sample_image());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
  }
}

TEST(Exr, PartsKeepTheirNamesPixelsAndMetadata) {
  const auto path = test_folder() / "parts.exr";
  const std::vector<ExrPart> parts{{"exposure", sample_image()},
                                   {"dn", {3, 2, {{"R", {12, 65535, 0, 1, 2, 3}}}, {{"comments", "codes"}}}}};
  write_exr(path, parts);
  const std::vector<ExrPart> read = read_exr_parts(path);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].name, "exposure");
  EXPECT_EQ(read[0].image.metadata, parts[0].image.metadata);
  EXPECT_EQ(read[0].image.find("R")->values, parts[0].image.find("R")->values);
  EXPECT_EQ(read[1].name, "dn");
  EXPECT_EQ(read[1].image.height, 2);
  EXPECT_EQ(read[1].image.metadata.at("comments"), "codes");
  EXPECT_EQ(read[1].image.find("R")->values, (std::vector<float>{12, 65535, 0, 1, 2, 3}));
  std::string message;
  EXPECT_EQ(reading_error(path, &message), ErrorCode::input);
  EXPECT_EQ(message, path.string() + ": has 2 parts (allowed 1)");
}

TEST(Exr, EveryTruncationOfPartsIsAnInputError) {
  const auto path = test_folder() / "a.exr";
  write_exr(path, std::vector<ExrPart>{{"a", sample_image()}, {"b", sample_image()}});
  const std::string bytes = bytes_of(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    put(path, bytes.substr(0, size));
    try {
      (void)read_exr_parts(path);
      ADD_FAILURE() << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input) << size;
    }
  }
}

TEST(Exr, ASinglePartReadsAsPartsToo) {
  const auto path = test_folder() / "a.exr";
  write_exr(path, sample_image());
  const std::vector<ExrPart> read = read_exr_parts(path);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].image.channels.size(), 2U);
}

TEST(Exr, PartsOfOneNameAreAnOutputError) {
  const auto path = test_folder() / "a.exr";
  try {
    write_exr(path, std::vector<ExrPart>{{"a", sample_image()}, {"a", sample_image()}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

// OpenEXR defines expTime as a number; what is no number stays text.
TEST(Exr, StandardAttributesAreNumbers) {
  const auto path = test_folder() / "a.exr";
  Image image{1, 1, {{"Y", {1}}}, {}};
  image.metadata = {
      {"expTime", "0.02"}, {"aperture", "3.3333333333333335"}, {"isoSpeed", "unknown"}, {"exposure", "0.02"}};
  write_exr(path, image);
  const Image read = read_exr(path);
  EXPECT_EQ(
      read.metadata,
      (std::map<std::string, std::string>{
          {"aperture", "3.3333333"}, {"expTime", "0.02"}, {"exposure", "0.02"}, {"isoSpeed", "unknown"}}));
  const Imf::InputFile file(path.c_str());
  ASSERT_NE(file.header().findTypedAttribute<Imf::FloatAttribute>("expTime"), nullptr);
  EXPECT_EQ(file.header().typedAttribute<Imf::FloatAttribute>("expTime").value(), 0.02F);
  EXPECT_NE(file.header().findTypedAttribute<Imf::StringAttribute>("exposure"), nullptr);
}

TEST(Exr, PartsShareTheLimit) {
  const auto path = test_folder() / "large.exr";
  std::vector<Imf::Header> headers(9, Imf::Header(16384, 16384));
  for (std::size_t i = 0; i < headers.size(); ++i) {
    headers[i].setName(std::to_string(i));
    headers[i].setType(Imf::SCANLINEIMAGE);
    headers[i].channels().insert("Y", Imf::Channel(Imf::FLOAT));
  }
  { const Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 9); }
  try {
    (void)read_exr_parts(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::resource) << error.what();
  }
}

}  // namespace
}  // namespace abbe
