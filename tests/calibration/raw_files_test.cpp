#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "calibration/chart/exposure_series.h"
#include "calibration/chart/raw_scale.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "sensor/readout/readout.h"

// DNG and FITS are accepted wherever a raw TIFF is, with the same results.

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr int kFrameWidth = 64;
constexpr int kFrameHeight = 48;

class RawFiles : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  // A grey wedge under a mosaic with this exposure time. The attributes of the film fill several cards of
  // FITS.
  static RawPicture wedge(double exposure_s, bool with_metadata = true) {
    RawPicture raw;
    raw.width = kFrameWidth;
    raw.height = kFrameHeight;
    raw.planes = {"raw"};
    raw.channels = {"R", "G", "B"};
    raw.mosaic_width = 2;
    raw.mosaic = {0, 1, 1, 2};
    raw.black_level_dn = 50;
    raw.white_level_dn = 4000;
    raw.exposure_s = exposure_s;
    for (int i = 0; i < kFrameWidth * kFrameHeight; ++i)
      raw.codes.push_back(static_cast<std::uint16_t>(50 + exposure_s * (1 + i % kFrameWidth) * 40));
    if (with_metadata)
      raw.metadata = {
          {"exposure_s", fmt::format("{}", exposure_s)},
          {"mosaic", "R,G/G,B"},
          {"mosaic_channels", "R,G,B"},
          {"white_level_dn", "4000"},
          {"sensor",
           fmt::format(R"({{"name":"{}","readout":{{"bits":12,"offset_dn":50,"saturation_dn":4000}}}})",
                       std::string(97, 'x') + " ends beyond a card")}};
    return raw;
  }

  fs::path write(const std::string& name, const RawPicture& raw) const {
    const fs::path path = folder_ / name;
    if (path.extension() == ".dng") write_dng(path, raw);
    if (path.extension() == ".fits") write_fits(path, raw);
    if (path.extension() == ".tif") {
      Image image{kFrameWidth, kFrameHeight, {{"raw", {raw.codes.begin(), raw.codes.end()}}}, raw.metadata};
      write_raw_picture(path, image);
    }
    return path;
  }

  // Writes a file of Abbe ("own...") or of another program. The sensor's well is full at the code of column
  // 48, below the highest code.
  fs::path write_full_well(const std::string& name) const {
    RawPicture raw = wedge(1, name.starts_with("own"));
    raw.white_level_dn = 2010;
    if (!raw.metadata.empty()) raw.metadata["white_level_dn"] = "2010";
    return write(name, raw);
  }
  static constexpr std::array kKinds{"own.dng", "own.fits", "own.tif", "plain.dng", "plain.fits"};

  PhotographedSeries series(const std::string& end) const {
    std::string listing;
    for (const double t : {0.25, 0.5, 1.0}) {
      const std::string name = fmt::format("{}{}", t, end);
      (void)write(name, wedge(t));
      listing += fmt::format(R"({}{{"file": "{}"}})", listing.empty() ? "" : ", ", name);
    }
    std::ofstream(folder_ / "series.json") << R"({"exposures": [)" << listing << "]}";
    Diagnostics diagnostics;
    const auto read = read_series(folder_ / "series.json", diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << end;
    return read.value_or(PhotographedSeries{});
  }

  // Series of one photograph, with these members in its listing.
  std::optional<PhotographedSeries> listed_series(const std::string& name, std::string members) {
    if (members.find("regions") == std::string::npos) members += R"(, "regions": [[46, 0, 48, 2]])";
    std::ofstream(folder_ / "one.json")
        << R"({"exposures": [{"file": ")" << name << R"("}], )" << members << "}";
    diagnostics_ = {};
    return read_series(folder_ / "one.json", diagnostics_);
  }

  Diagnostics diagnostics_;
  fs::path folder_ = fs::path(testing::TempDir()) / ("abbe_raw_files_" + std::to_string(::getpid()));
};

TEST_F(RawFiles, ASeriesOfAnyKindHasTheNumbersOfTiff) {
  const PhotographedSeries tiff = series(".tif");
  ASSERT_EQ(tiff.channels, (std::vector<std::string>{"R", "G", "B"}));
  for (const char* end : {".dng", ".fits"}) {
    const PhotographedSeries other = series(end);
    ASSERT_EQ(other.channels, tiff.channels) << end;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(other.series[k].codes, tiff.series[k].codes) << end;
      EXPECT_EQ(other.series[k].times_s, tiff.series[k].times_s) << end;
    }
  }
}

TEST_F(RawFiles, TellWhatTheFilmToldOnAnyNumberOfCards) {
  for (const char* name : {"wedge.dng", "wedge.fits", "wedge.tif"}) {
    const RawImage read = read_raw_image(write(name, wedge(0.5)));
    ASSERT_TRUE(read.scale) << name;
    EXPECT_EQ(read.scale->bits, 12) << name;
    EXPECT_EQ(read.scale->exposure_s, 0.5) << name;
    EXPECT_EQ(read.scale->highest(), 4000) << name;
  }
}

// A DNG has a table that undoes the curve.
TEST_F(RawFiles, AResponseCurveIsUndoneWhereTheyAreRead) {
  RawPicture raw = wedge(0.5);
  raw.linear_codes.resize(4001);
  for (std::size_t code = 50; code < raw.linear_codes.size(); ++code)
    raw.linear_codes[code] = static_cast<std::uint16_t>(std::lround(
        50 +
        3950 * MonotoneCurve({{0, 0}, {0.1, 0.4}, {1, 1}}).inverse(static_cast<double>(code - 50) / 3950)));
  raw.white_level_dn = 3000;
  raw.metadata["white_level_dn"] = "3000";
  raw.metadata["sensor"] =
      R"({"readout": {"gain_e_per_dn": 2, "bits": 12, "offset_dn": 50, "saturation_dn": 4000,)"
      R"( "response_curve": [[0, 0], [0.1, 0.4], [1, 1]]}})";
  for (const char* name : {"curve.dng", "curve.fits", "curve.tif"}) {
    const RawImage read = read_raw_image(write(name, raw));
    ASSERT_EQ(read.scale->highest(), 4000) << name;
    EXPECT_EQ(white_dn(read.image, *read.scale), raw.linear_codes[3000]) << name;
    const auto series = listed_series(name, R"("full_scale": 0.0381475)");
    ASSERT_TRUE(series) << diagnostics_.text();
    EXPECT_EQ(series->full_scale.dn, raw.linear_codes[2500] - 50) << name << ": of the file's codes";
    for (std::size_t i = 0; i < raw.codes.size(); i += 7)
      ASSERT_EQ(code_of(read.image.channels[0].values[i]), raw.linear_codes[raw.codes[i]]) << name << i;
  }
}

// Code 1 of a series is the code at which the camera clips.
TEST_F(RawFiles, TheWhiteLevelClipsASeries) {
  for (const char* name : kKinds) {
    (void)write_full_well(name);
    const auto read = listed_series(name, R"("regions": [[46, 0, 48, 2], [48, 0, 50, 2]])");
    ASSERT_TRUE(read) << diagnostics_.text();
    EXPECT_EQ(read->full_scale.dn, 2010 - 50) << name;
    ASSERT_EQ(read->series.size(), 3U) << name;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(read->series[k].codes[0][0], (1880 + 20 * static_cast<double>(k)) / 1960, 1e-6) << name;
      EXPECT_EQ(read->series[k].codes[1][0], 1) << name;
    }
  }
}

// The listing overrides the same value in the files, and nothing else.
TEST_F(RawFiles, BlackIsTheirsWhateverTheListingSays) {
  for (const char* name : kKinds) {
    (void)write_full_well(name);
    for (const auto& [listed, full] :
         {std::pair{R"("bits": 12)", 2010}, {R"("full_scale": 0.0309758)", 2030}}) {
      const auto read = listed_series(name, listed);
      ASSERT_TRUE(read) << diagnostics_.text();
      EXPECT_EQ(read->full_scale.dn, full - 50) << name << listed;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(read->series[k].codes[0][0], (1880 + 20 * static_cast<double>(k)) / (full - 50), 1e-6)
            << name << listed;
    }
  }
}

// The clipping code must be a code of the file, above its black.
TEST_F(RawFiles, AFullScaleThatTheyCannotReachIsNamed) {
  for (const char* name : {"own.tif", "own.dng"}) {
    (void)write_full_well(name);
    for (const auto& [listed, fault] : {std::pair{R"("full_scale": 1)", "(got 1, which is code 65535"},
                                        {R"("full_scale": 0.0007)", "(got 0.0007, which is code 46"}}) {
      EXPECT_FALSE(listed_series(name, listed)) << name << listed;
      EXPECT_NE(
          diagnostics_.text().find(fmt::format(
              "{} has codes from 50, its black, to 4095, and \"full_scale\" is outside {}", name, fault)),
          std::string::npos)
          << diagnostics_.text();
      EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
    }
  }
}

// Other programs record where codes clip, for example as a limit of linearity, but not where they end.
TEST_F(RawFiles, AnyCodeMayBeTheFullScaleOfOtherPrograms) {
  for (const char* name : {"plain.dng", "plain.fits"}) {
    (void)write(name, wedge(0.5, false));
    const auto read = listed_series(name, R"("full_scale": 0.0762951)");
    ASSERT_TRUE(read) << diagnostics_.text();
    EXPECT_EQ(read->full_scale.dn, 5000 - 50) << name;
  }
}

TEST_F(RawFiles, CodesEndAtTheWhiteLevelThatIsTold) {
  for (const char* name : kKinds) {
    const auto end = clipping_level(read_raw_image(write_full_well(name)));
    ASSERT_TRUE(end) << name;
    EXPECT_EQ(end->dn, 2010) << name;
    EXPECT_TRUE(end->is_declared) << name;
  }
}

// A converter copies the description but writes planes and codes of its own.
TEST_F(RawFiles, CodesOfOtherPicturesEndWhereSomeAreTheHighest) {
  RawPicture raw = wedge(1);
  raw.metadata["white_level_dn"] = "2010";
  raw.codes.back() = 4001;
  EXPECT_FALSE(clipping_level(read_raw_image(write("bright.tif", raw)))) << "of another scale";
  ImageChannel plane{"R", std::vector<float>(raw.codes.size(), 3000)};
  const auto converted = [&] {
    write_raw_picture(
        folder_ / "rgb.tif",
        {kFrameWidth, kFrameHeight, {plane, {"G", plane.values}, {"B", plane.values}}, raw.metadata});
    return clipping_level(read_raw_image(folder_ / "rgb.tif"));
  };
  EXPECT_FALSE(converted()) << "of other planes";
  plane.values[5] = 65535;
  ASSERT_TRUE(converted());
  EXPECT_EQ(converted()->dn, 65535);
  EXPECT_FALSE(converted()->is_declared);
  const auto of_values = [](float darker) { return clipping_level({{2, 1, {{"Y", {darker, 1}}}, {}}, {}}); };
  EXPECT_TRUE(of_values(static_cast<float>(85 / 255.0))) << "eight bits";
  EXPECT_FALSE(of_values(0.12345F)) << "floats";
}

TEST_F(RawFiles, TellTheExposureOfAChannelsOwn) {
  RawPicture raw = wedge(0.5);
  raw.exposure_s.reset();
  raw.metadata["exposure_s.R"] = "5";
  for (const char* name : {"own.dng", "own.fits", "own.tif"}) {
    const RawImage read = read_raw_image(write(name, raw));
    EXPECT_EQ(read.scale->exposure_of("R"), 5) << name;
    EXPECT_EQ(read.scale->exposure_of("G"), 0.5) << name;
  }
}

TEST_F(RawFiles, PlanesOfTiffHaveTheNamesOfTheSensor) {
  Image image{1, 1, {{"B", {1}}, {"G", {2}}, {"R", {3}}}, wedge(0.5).metadata};
  image.metadata.insert({{"sensor_channels", "B,G,R"}, {"white_level_dn", "4000"}});
  write_raw_picture(folder_ / "planes.tif", image);
  const Image read = read_raw_image(folder_ / "planes.tif").image;
  EXPECT_EQ(code_of(read.find("R")->values[0]), 3);
}

TEST_F(RawFiles, OfOtherProgramsTellLevelsPatternAndExposure) {
  for (const char* name : {"plain.dng", "plain.fits"}) {
    const RawImage read = read_raw_image(write(name, wedge(0.5, false)));
    ASSERT_TRUE(read.scale) << name;
    EXPECT_EQ(read.scale->bits, 12) << name;
    EXPECT_EQ(read.scale->offset_dn, 50) << name;
    EXPECT_EQ(read.scale->highest(), 4000) << name;
    EXPECT_EQ(read.scale->exposure_s, 0.5) << name;
    ASSERT_TRUE(read.scale->mosaic) << name;
    EXPECT_EQ(read.scale->channels, (std::vector<std::string>{"R", "G", "B"})) << name;
    RawPicture untold = wedge(0.5, false);
    untold.exposure_s.reset();
    untold.f_number = 4;
    EXPECT_FALSE(read_raw_image(write(name, untold)).scale->exposure_s) << name;
  }
}

}  // namespace
}  // namespace abbe
