#include "develop/linear_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "develop/find_chart.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "sensor/readout/readout.h"
#include "tests/io/dng_opcodes.h"
#include "tests/io/tiff_entries.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

LinearImage image_of(int width, int height, double (*value)(int, int), std::optional<Mosaic> mosaic = {}) {
  LinearImage image{{width, height, {{"raw", {}}}, {}}, {"raw"}, std::move(mosaic), {}, ""};
  if (image.mosaic) image.channels = {"R", "G"};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.image.channels[0].values.push_back(static_cast<float>(value(x, y)));
  return image;
}
double falloff(int x, int y) {
  return 1 - 0.002 * ((x - 30) * (x - 30) + (y - 20) * (y - 20)) / 10;
}
const Mosaic kStripes{2, 1, {0, 1}};
constexpr std::array<Imath::V2d, 4> kSquare{Imath::V2d(0, 0), {60, 0}, {60, 40}, {0, 40}};

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LinearImage, AFlatTakesVignettingAway) {
  LinearImage image = image_of(
      60, 40, [](int x, int y) { return (x % 2 == 0 ? 300 : 100) * falloff(x, y); }, kStripes);
  const LinearImage flat = image_of(
      60, 40, [](int x, int y) { return (x % 2 == 0 ? 7 : 20) * falloff(x, y); }, kStripes);
  flat_field(image, flat, "flat");
  const std::vector<std::string> names{"a", "b", "c", "d", "e", "f"};
  const auto outlines = outlines_between(kSquare, names, 3);
  const std::vector<PatchValues> patches = measure_patches(image.image, image.planes(), outlines);
  ASSERT_EQ(patches.size(), 6U);
  for (const PatchValues& patch : patches) {
    EXPECT_NEAR(patch.channels[0].mean / patch.channels[1].mean, 3, 1e-3)
        << "each channel keeps its own mean";
    EXPECT_NEAR(patch.channels[0].mean, patches[0].channels[0].mean, 1e-3);
    EXPECT_LT(patch.channels[0].deviation.value(), 1e-3);
    EXPECT_EQ(patch.channels[0].pixels, 6U * 12);  // 12 by 12 in the center: 0.6 of 20 by 20
  }
  EXPECT_EQ(refusal([&] { flat_field(image, image_of(60, 39, falloff, kStripes), "f.exr"); }),
            "f.exr: the flat has a different size (got 60 x 39, allowed 60 x 40)");
  EXPECT_EQ(refusal([&] { flat_field(image, image_of(60, 40, falloff), "f.exr"); }),
            "f.exr: the flat has different channels or a different mosaic (got raw, allowed the mosaic R,G)");
  EXPECT_EQ(refusal([&] {
              flat_field(image,
                         image_of(
                             60, 40, [](int, int) { return 0.0; }, kStripes),
                         "f.exr");
            }),
            "f.exr: the flat has no light at pixel 0,0 (got 0)");
}

TEST(LinearImage, AFlatThatIsRefusedLeavesTheImageUnchanged) {
  LinearImage image = image_of(60, 40, falloff);
  const std::vector<float> before = image.image.channels[0].values;
  const LinearImage flat =
      image_of(60, 40, [](int x, int y) { return x == 59 && y == 39 ? 0 : 0.5 + 0.01 * x; });
  EXPECT_EQ(refusal([&] { flat_field(image, flat, "f.exr"); }),
            "f.exr: the flat has no light at pixel 59,39 (got 0)");
  EXPECT_EQ(image.image.channels[0].values, before);
  EXPECT_TRUE(image.exposed.empty());
}

TEST(LinearImage, PatchesCountTheirOwnPixelsAndWhatIsSaturated) {
  LinearImage image = image_of(60, 40, [](int x, int) { return x < 10 ? 100.0 : 50.0 + x % 2; });
  image.saturation = 100;
  const std::vector<std::string> names{"a", "b"};
  const std::vector<PatchValues> patches =
      measure_patches(image.image, image.planes(), outlines_between(kSquare, names, 2));
  EXPECT_EQ(patches[0].channels[0].pixels, 18U * 24);
  EXPECT_EQ(patches[0].channels[0].saturated, 4U * 24);
  EXPECT_DOUBLE_EQ(patches[0].channels[0].mean, (4 * 100 + 14 * 50.5) / 18)
      << "with what the light saturates";
  EXPECT_DOUBLE_EQ(patches[1].channels[0].mean, 50.5);
  EXPECT_NEAR(patches[1].channels[0].deviation.value(), 0.5 * std::sqrt(432.0 / 431), 1e-9);
  EXPECT_EQ(patches[1].channels[0].saturated, 0U);
}

TEST(ChartCorners, PerspectiveIsSeen) {
  const std::vector<std::string> names{"a", "b", "c", "d"};
  // A square on a floor, lower in the picture where it is nearer. Its center is where the diagonals cross.
  const std::array<Imath::V2d, 4> floor{Imath::V2d(-50, 0), {50, 0}, {100, 100}, {-100, 100}};
  const auto outlines = outlines_between(floor, std::vector<std::string>{"all"}, 1);
  const Imath::V2d a = outlines[0].corners[2] - outlines[0].corners[0];
  const Imath::V2d b = outlines[0].corners[3] - outlines[0].corners[1];
  const double t = (outlines[0].corners[1] - outlines[0].corners[0]).cross(b) / a.cross(b);
  EXPECT_NEAR((outlines[0].corners[0] + a * t).x, 0, 1e-12);
  EXPECT_NEAR((outlines[0].corners[0] + a * t).y, 100.0 / 3, 1e-9);
  EXPECT_NE(refusal([&] {
              (void)outlines_between({Imath::V2d(0, 0), {10, 10}, {10, 0}, {0, 10}}, names, 2);
            }).find("--corners: expected the corners of a convex quadrilateral"),
            std::string::npos);
}

// Planes other than the film's own are not measured, and a mosaic remains one.
TEST(LinearImage, OfAFilmItsPlanesAlone) {
  const fs::path path = fs::path(testing::TempDir()) / ("abbe_planes_" + std::to_string(::getpid()) + ".exr");
  write_exr(path, {2,
                   1,
                   {{"raw", {1, 2}}, {"Coverage", {1, 1}}, {"Id", {1, 1}}, {"light.key.raw", {1, 2}}},
                   {{"sensor_channels", "raw"}, {"mosaic", "R,G"}, {"mosaic_channels", "R,G"}}});
  const LinearImage mosaic = read_linear_image(path);
  EXPECT_EQ(mosaic.channels, (std::vector<std::string>{"R", "G"}));
  ASSERT_TRUE(mosaic.mosaic);
  EXPECT_EQ(mosaic.image.channels.size(), 1U);
  write_exr(path, {1, 1, {{"B", {3}}, {"G", {2}}, {"Id", {1}}, {"R", {1}}}, {{"sensor_channels", "R,G,B"}}});
  EXPECT_EQ(read_linear_image(path).channels, (std::vector<std::string>{"R", "G", "B"}));
  const fs::path capitals = fs::path(path).replace_extension(".EXR");
  fs::rename(path, capitals);
  EXPECT_EQ(read_linear_image(capitals).unit, "film values");
  fs::remove(capitals);
}

// A 2 x 2 sensor with a nonlinear response curve, under filters that have no letters in FITS.
RawPicture curved_picture() {
  Readout readout;
  readout.bits = 12;
  readout.gain_e_per_dn = 2;
  readout.offset_dn = 100;
  readout.full_well_e = 7500;
  readout.response_curve = MonotoneCurve({{0, 0}, {0.5, 0.8}, {1, 1}});
  RawPicture raw;
  raw.width = raw.height = raw.mosaic_width = 2;
  raw.planes = {"raw"};
  raw.channels = {"G", "M", "Y"};
  raw.mosaic = {1, 0, 0, 2};
  raw.codes = {100, 1000, 3900, 4050};
  raw.exposure_s = 1;
  raw.black_level_dn = readout.offset_dn;
  raw.white_level_dn = white_level(readout);
  raw.linear_codes = linear_codes(readout);
  raw.metadata = {{"sensor_channels", "raw"},
                  {"mosaic", "M,G/G,Y"},
                  {"mosaic_channels", "G,M,Y"},
                  {"black_level_dn", "100"},
                  {"white_level_dn", std::to_string(white_level(readout))},
                  {"sensor", R"({"readout": {"gain_e_per_dn": 2, "bits": 12, "offset_dn": 100,)"
                             R"( "full_well_e": 7500, "response_curve": [[0, 0], [0.5, 0.8], [1, 1]]}})"}};
  return raw;
}

TEST(LinearImage, OfARawFileOfAnyKindIsTheSame) {
  const fs::path folder = fs::path(testing::TempDir()) / ("abbe_kinds_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const RawPicture raw = curved_picture();
  write_dng(folder / "a.dng", raw);
  write_fits(folder / "a.fits", raw);
  write_dng(folder / "b.DNG", raw);
  write_fits(folder / "b.FIT", raw);
  for (const char* name : {"a.tif", "a.png", "b.TIF", "b.PNG"})
    write_raw_picture(folder / name, {2, 2, {{"raw", {raw.codes.begin(), raw.codes.end()}}}, raw.metadata});
  std::vector<float> linear;
  for (const std::uint16_t code : raw.codes)
    linear.push_back(static_cast<float>(raw.linear_codes[code] - 100));
  for (const char* name : {"a.dng", "a.fits", "a.tif", "a.png", "b.DNG", "b.FIT", "b.TIF", "b.PNG"}) {
    const LinearImage read = read_linear_image(folder / name);
    EXPECT_EQ(read.channels, (std::vector<std::string>{"G", "M", "Y"})) << name;
    EXPECT_EQ(read.mosaic, (Mosaic{2, 2, {1, 0, 0, 2}})) << name;
    ASSERT_EQ(read.image.channels.size(), 1U) << name;
    EXPECT_EQ(read.image.channels[0].values, linear) << name;
    EXPECT_EQ(read.saturation, 3750) << name << ": the full well over the gain";
  }
  fs::remove_all(folder);
}

// Black between two codes, as with dark signals, which tags would round.
TEST(LinearImage, BlackIsTheSameInEveryKindOfRawFile) {
  const fs::path folder = fs::path(testing::TempDir()) / ("abbe_black_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  RawPicture raw = curved_picture();
  raw.black_level_dn = 100 + 1.0 / 3;
  raw.metadata["black_level_dn"] = fmt::format("{}", raw.black_level_dn);
  write_dng(folder / "a.dng", raw);
  write_fits(folder / "a.fits", raw);
  write_raw_picture(folder / "a.tif", {2, 2, {{"raw", {raw.codes.begin(), raw.codes.end()}}}, raw.metadata});
  std::vector<float> linear;
  for (const std::uint16_t code : raw.codes)
    linear.push_back(static_cast<float>(raw.linear_codes[code] - raw.black_level_dn));
  for (const char* name : {"a.dng", "a.fits", "a.tif"}) {
    const LinearImage read = read_linear_image(folder / name);
    EXPECT_EQ(read.image.channels[0].values, linear) << name;
    EXPECT_EQ(read.saturation, static_cast<double>(static_cast<float>(3850 - raw.black_level_dn))) << name;
  }
  raw.metadata.erase("black_level_dn");
  write_dng(folder / "a.dng", raw);
  EXPECT_NEAR(static_cast<double>(read_linear_image(folder / "a.dng").image.channels[0].values[0]),
              static_cast<double>(linear[0]), 1e-4)
      << "as other programs tell it";
  fs::remove_all(folder);
}

// Black between two codes makes rounded numbers of all codes.
TEST(LinearImage, TheCodeOfWhiteIsSaturatedWhateverBlackIs) {
  const fs::path path = fs::path(testing::TempDir()) / ("abbe_white_" + std::to_string(::getpid()) + ".tif");
  for (int tenths = 0; tenths < 10; ++tenths) {
    const double black = 600 + tenths / 10.0;
    write_raw_picture(path, {2,
                             1,
                             {{"raw", {16382, 16383}}},
                             {{"sensor_channels", "raw"},
                              {"black_level_dn", fmt::format("{}", black)},
                              {"white_level_dn", "16383"}}});
    LinearImage read = read_linear_image(path);
    const PatchOutline all{"all", {Imath::V2d(0, 0), {2, 0}, {2, 1}, {0, 1}}};
    EXPECT_EQ(measure_patches(read.image, read.planes(), std::array{all})[0].channels[0].saturated, 1U)
        << black;
    const LinearImage flat = read;
    EXPECT_EQ(refusal([&] { flat_field(read, flat, "f.tif"); }),
              "f.tif: the flat is saturated (got 50 % of its pixels, allowed 1 %): expose it less")
        << black;
  }
  fs::remove(path);
}

// A TIFF of four planes whose fourth is tagged as alpha: 1 for associated, 2 for unassociated.
LinearImage with_alpha(const Image& codes, std::uint16_t alpha) {
  constexpr std::uint16_t kExtraSamples = 338;
  const fs::path path = fs::path(testing::TempDir()) / ("abbe_alpha_" + std::to_string(::getpid()) + ".tif");
  write_raw_picture(path, codes);
  std::ifstream written(path, std::ios::binary);
  test::TiffEntries file{{std::istreambuf_iterator<char>(written), {}}};
  file.set_short(kExtraSamples, kExtraSamples, alpha);
  std::ofstream(path, std::ios::binary) << file.bytes;
  LinearImage read = read_linear_image(path);
  fs::remove(path);
  return read;
}

TEST(LinearImage, APlaneOfTheSensorIsNoAlpha) {
  Image codes{1,
              1,
              {{"R", {101}}, {"G", {102}}, {"B", {103}}, {"IR", {104}}},
              {{"sensor_channels", "R,G,B,IR"}, {"black_level_dn", "100"}, {"white_level_dn", "4095"}}};
  const LinearImage read = with_alpha(codes, 1);
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B", "IR"}));
  ASSERT_EQ(read.image.channels.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(read.image.channels[k].name, read.channels[k]);
    EXPECT_EQ(read.image.channels[k].values[0], static_cast<float>(k + 1)) << k;
  }
  codes.metadata["sensor_channels"] = "B,G,R";
  EXPECT_EQ(with_alpha(codes, 1).channels, (std::vector<std::string>{"B", "G", "R"}))
      << "a file to which another program has given an alpha channel";
}

// The gain doubles values, also above the white level, but does not change which pixels are saturated.
TEST(LinearImage, OpcodesOfADngChangeValuesButNotWhatIsSaturated) {
  constexpr std::uint16_t kWriter = 305;
  const fs::path path =
      fs::path(testing::TempDir()) / ("abbe_opcodes_" + std::to_string(::getpid()) + ".dng");
  RawPicture raw;
  raw.width = 3;
  raw.height = 1;
  raw.planes = raw.channels = {"raw"};
  raw.codes = {100, 3000, 4000};
  raw.black_level_dn = 100;
  raw.white_level_dn = 4000;
  for (const float gain : {2.0F, 0.5F}) {
    write_dng(path, raw);
    std::ifstream written(path, std::ios::binary);
    test::TiffEntries file{{std::istreambuf_iterator<char>(written), {}}};
    file.set_bytes(kWriter, test::kOpcodeList2, test::gain_map({gain}));
    std::ofstream(path, std::ios::binary) << file.bytes;
    LinearImage read = read_linear_image(path);
    EXPECT_EQ(read.image.channels[0].values, (std::vector<float>{0, gain * 2900, gain * 3900}));
    const PatchOutline all{"all", {Imath::V2d(0, 0), {3, 0}, {3, 1}, {0, 1}}};
    EXPECT_EQ(measure_patches(read.image, read.planes(), std::array{all})[0].channels[0].saturated, 1U);
    const LinearImage flat = image_of(3, 1, [](int, int) { return 1.0; });
    flat_field(read, flat, "flat");
    EXPECT_EQ(measure_patches(read.image, read.planes(), std::array{all})[0].channels[0].saturated, 1U);
  }
  fs::remove(path);
}

TEST(LinearImage, OptionalOpcodesThatAreNotAppliedAreReported) {
  constexpr std::uint16_t kWriter = 305;
  const fs::path path =
      fs::path(testing::TempDir()) / ("abbe_optional_" + std::to_string(::getpid()) + ".dng");
  RawPicture raw;
  raw.width = raw.height = 1;
  raw.planes = raw.channels = {"raw"};
  raw.codes = {100};
  write_dng(path, raw);
  std::ifstream written(path, std::ios::binary);
  test::TiffEntries file{{std::istreambuf_iterator<char>(written), {}}};
  file.set_bytes(kWriter, test::kOpcodeList3, test::opcode_list(3, std::string(56, '\0'), true));
  std::ofstream(path, std::ios::binary) << file.bytes;
  EXPECT_EQ(
      read_linear_image(path).warnings,
      std::vector{path.string() + ": the optional opcode FixVignetteRadial of OpcodeList3 is not applied"});
  fs::remove(path);
}

TEST(LinearImage, CodeValuesBesideAlphaAreThoseOfTheFile) {
  const LinearImage read =
      with_alpha({1, 1, {{"R", {40000}}, {"G", {30000}}, {"B", {20000}}, {"A", {32768}}}, {}}, 2);
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_FLOAT_EQ(read.image.channels[k].values[0], static_cast<float>(40000 - 10000 * k) / 65535) << k;
}

TEST(LinearImage, ASaturatedFlatIsRefused) {
  LinearImage image = image_of(60, 40, falloff);
  LinearImage flat = image_of(60, 40, [](int x, int y) { return x == 5 && y < 24 ? 1 : 0.5; });
  flat.saturation = 1;
  flat_field(image, flat, "f.exr");  // hot pixels
  flat.image.channels[0].values.back() = 1;
  EXPECT_EQ(refusal([&] { flat_field(image, flat, "f.exr"); }),
            "f.exr: the flat is saturated (got 1.04 % of its pixels, allowed 1 %): expose it less");
}

TEST(LinearImage, APixelThatIsNoNumberIsRefused) {
  const auto path =
      std::filesystem::temp_directory_path() / ("abbe_nan_" + std::to_string(::getpid()) + ".pfm");
  std::ofstream(path, std::ios::binary) << "Pf\n2 1\n-1.0\n" << std::string("\0\0\0\0\0\0\xc0\x7f", 8);
  EXPECT_EQ(refusal([&] { (void)read_linear_image(path); }),
            path.string() + ": channel \"Y\" has a value that is not finite at pixel 1,0 (got nan)");
  std::filesystem::remove(path);
}

TEST(LinearImage, APictureIsMeasuredAsItStandsInItsFile) {
  const auto path =
      std::filesystem::temp_directory_path() / ("abbe_mirrored_" + std::to_string(::getpid()) + ".hdr");
  std::ofstream(path, std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 -X 2\n\x80\x80\x80\x7f\x80\x80\x80\x80";
  EXPECT_EQ(read_linear_image(path).image.channels[0].values, (std::vector<float>{0.25F, 0.5F}));
  std::filesystem::remove(path);
}

// A damaged strip may decode to any number, but a sensor can only give its codes.
TEST(LinearImage, ACodeThatTheSensorCannotGiveIsRefused) {
  const auto path =
      std::filesystem::temp_directory_path() / ("abbe_codes_" + std::to_string(::getpid()) + ".tif");
  Image raw{2,
            2,
            {{"raw", {0, 100, 4095, 3000}}},
            {{"sensor_channels", "raw"},
             {"black_level_dn", "64"},
             {"white_level_dn", "4095"},
             {"sensor", R"({"readout": {"bits": 12}})"}}};
  write_raw_picture(path, raw);
  EXPECT_EQ(read_linear_image(path).image.channels[0].values[2], 4095 - 64);
  raw.channels[0].values[3] = 4096;
  write_raw_picture(path, raw);
  EXPECT_EQ(refusal([&] { (void)read_linear_image(path); }),
            path.string() +
                ": damaged, or from another sensor than it declares: channel \"raw\" has code 4096 at "
                "pixel 1,1 (allowed 0 to 4095)");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace abbe
