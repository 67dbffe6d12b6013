#include "calibration/chart/exposure_series.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include "io/exr.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "tests/calibration/response_fixture.h"

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

constexpr int kPatchEdge = 10;

class Photographs : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  // 24 patches in a row through a response with noise, once in each channel with its own gain.
  static Image photograph(const std::string& response, double time_s, double noise, std::uint64_t seed) {
    const PlantedResponse planted(response);
    const std::vector<double> values = chart_values();
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    Image image{24 * kPatchEdge, kPatchEdge, {}, {}};
    for (const auto& [name, gain] : {std::pair{"R", 0.6}, {"G", 1.0}, {"B", 0.8}}) {
      ImageChannel channel{name, {}};
      for (int y = 0; y < kPatchEdge; ++y)
        for (std::size_t i = 0; i < 24; ++i)
          for (int x = 0; x < kPatchEdge; ++x)
            channel.values.push_back(static_cast<float>(
                std::clamp(planted.code(gain * values[i] * time_s) + normal(random), 0.0, 1.0)));
      image.channels.push_back(std::move(channel));
    }
    return image;
  }

  // Writes the photographs and their listing; the extra members come first.
  fs::path list(const std::string& extension, const std::string& members, double noise, double scale = 1) {
    std::string exposures;
    std::uint64_t seed = 1;
    for (const double time : stops(-9, 6, 0.5)) {
      const std::string name = fmt::format("{}{}", seed, extension);
      Image image = photograph("gamma:2.2", time, noise, seed++);
      for (ImageChannel& channel : image.channels)
        for (float& v : channel.values) v *= static_cast<float>(scale);
      if (extension == ".exr")
        write_exr(folder_ / name, image);
      else
        write_picture(folder_ / name, image);
      exposures += fmt::format("{{\"file\": \"{}\", \"exposure_s\": {}}},", name, time);
    }
    std::ofstream(folder_ / "series.json") << "{" << members << "\"exposures\": [" << exposures << "]}";
    return folder_ / "series.json";
  }

  static std::string regions() {
    std::string text = "\"regions\": [";
    for (int i = 0; i < 24; ++i)
      text += fmt::format("[{}, 0, {}, {}],", i * kPatchEdge, (i + 1) * kPatchEdge, kPatchEdge);
    return text + "], ";
  }

  std::optional<PhotographedSeries> read(const fs::path& path) {
    diagnostics_ = {};
    return read_series(path, diagnostics_);
  }
  void expect_complaint(const std::string& json, const std::string& text) {
    std::ofstream(folder_ / "bad.json") << json;
    expect_complaint_of(folder_ / "bad.json", text);
  }
  void expect_complaint_of(const fs::path& listing, const std::string& text) {
    EXPECT_FALSE(read(listing));
    EXPECT_NE(diagnostics_.text().find(text), std::string::npos) << diagnostics_.text();
    EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("abbe_series_" + std::to_string(::getpid()));
  Diagnostics diagnostics_;
};

TEST_F(Photographs, RegionsOfNoisyFloatImages) {
  const auto all = read(list(".exr", regions() + "\"full_scale\": 4, ", 2e-3, 4));
  ASSERT_TRUE(all) << diagnostics_.text();
  ASSERT_EQ(all->channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(all->full_scale.value, 4);
  EXPECT_FALSE(all->full_scale.dn);
  const PlantedResponse planted("gamma:2.2");
  for (const ExposureSeries& series : all->series) {
    ASSERT_EQ(series.codes.size(), 24U);
    ASSERT_EQ(series.times_s.size(), 31U);
    EXPECT_NEAR(series.deviations[18][10], 2e-4, 1e-4) << "a tenth of a pixel's";
    const ResponseFit fit = recover_response(series);
    EXPECT_LT(worst_error(fit, planted), 0.003);
    EXPECT_GT(coverage(fit, planted), 0.6);
    EXPECT_NEAR(fit.noise_scale, 1, 0.25);
  }
}

TEST_F(Photographs, GridOfPixelsOfEightBitPictures) {
  const auto all = read(list(".png", "", 0));
  ASSERT_TRUE(all) << diagnostics_.text();
  EXPECT_EQ(all->series[1].codes.size(), 160U) << "16 columns of ten rows";
  EXPECT_TRUE(all->series[1].deviations.empty());
  EXPECT_LT(worst_error(recover_response(all->series[1]), PlantedResponse("gamma:2.2")), 0.005);
}

TEST_F(Photographs, RoundingIsNoiseTooWhereItIsStated) {
  const auto exact = read(list(".png", regions(), 0));
  const auto rounded = read(list(".png", regions() + "\"bits\": 8, ", 0));
  ASSERT_TRUE(exact && rounded) << diagnostics_.text();
  EXPECT_TRUE(exact->series[0].deviations.empty()) << "no spread at all is no knowledge of it";
  EXPECT_NEAR(rounded->series[0].deviations[20][12], 1 / 255.0 / std::sqrt(12), 1e-9);
}

TEST_F(Photographs, AClippedPixelClipsItsRegion) {
  Image image{4, 1, {{"Y", {0.2F, 0.4F, 0.5F, 1.0F}}}, {}};
  write_exr(folder_ / "a.exr", image);
  std::ofstream(folder_ / "one.json") << R"({"regions": [[0, 0, 2, 1], [2, 0, 4, 1]],
    "exposures": [{"file": "a.exr", "exposure_s": 1}]})";
  const auto all = read(folder_ / "one.json");
  ASSERT_TRUE(all) << diagnostics_.text();
  EXPECT_NEAR(all->series[0].codes[0][0], 0.3, 1e-7);
  EXPECT_NEAR(all->series[0].deviations[0][0], 0.1, 1e-7);
  EXPECT_EQ(all->series[0].codes[1][0], 1);
}

TEST_F(Photographs, RegionsOfOnePixelTellNoNoise) {
  write_exr(folder_ / "a.exr", {3, 1, {{"Y", {0.2F, 0.4F, 0.5F}}}, {}});
  const auto deviations = [&](const std::string& regions) {
    std::ofstream(folder_ / "one.json")
        << R"({"bits": 8, "exposures": [{"file": "a.exr", "exposure_s": 1}], "regions": )" << regions << "}";
    const auto all = read(folder_ / "one.json");
    EXPECT_TRUE(all) << diagnostics_.text();
    return all ? all->series.at(0).deviations : std::vector<std::vector<double>>{};
  };
  EXPECT_EQ(deviations("[[0, 0, 2, 1], [1, 0, 3, 1]]").size(), 2U);
  EXPECT_TRUE(deviations("[[0, 0, 2, 1], [2, 0, 3, 1]]").empty());
}

// Attributes that `develop` records about its read-out.
std::map<std::string, std::string> told_by_develop(double exposure_s) {
  return {{"exposure_s", fmt::format("{}", exposure_s)},
          {"mosaic", "R,G/G,B"},
          {"mosaic_channels", "R,G,B"},
          {"white_level_dn", "4095"},
          {"sensor", R"({"resolution":[8,8],"readout":{"gain_e_per_dn":2,"bits":12,"offset_dn":100}})"}};
}

TEST_F(Photographs, RawFilesTellTheirOwnScale) {
  for (const char* extension : {".tif", ".png"}) {
    std::string exposures;
    for (const int stop : {0, 1}) {
      // R 200, G 400, B 800 DN above black in the first, twice that in the second.
      Image raw{8, 8, {{"raw", {}}}, told_by_develop(0.01 * (stop + 1))};
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
          raw.channels[0].values.push_back(static_cast<float>(
              100 + (stop + 1) * (y % 2 == 0 ? (x % 2 == 0 ? 200 : 400) : (x % 2 == 0 ? 400 : 800))));
      const std::string name = fmt::format("raw{}{}", stop, extension);
      write_raw_picture(folder_ / name, raw);
      exposures += fmt::format("{{\"file\": \"{}\"}},", name);
    }
    std::ofstream(folder_ / "raw.json")
        << "{\"exposures\": [" << exposures << "], \"regions\": [[1, 1, 7, 6]]}";
    const auto all = read(folder_ / "raw.json");
    ASSERT_TRUE(all) << diagnostics_.text();
    ASSERT_EQ(all->channels, (std::vector<std::string>{"R", "G", "B"})) << extension;
    const double full = 4095 - 100;
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t stop : {0U, 1U}) {
        EXPECT_NEAR(all->series[k].codes[0][stop], static_cast<double>((stop + 1) * (200U << k)) / full, 1e-7)
            << extension << k;
        EXPECT_NEAR(all->series[k].times_s[stop], 0.01 * static_cast<double>(stop + 1), 1e-12);
      }
    EXPECT_NEAR(all->series[0].deviations[0][0], 1 / full / std::sqrt(12), 1e-9) << "rounding alone";
  }
}

// The ends of the scale are not exact in single precision, unlike pixels.
TEST_F(Photographs, TheEndsOfAnyScaleAreReached) {
  std::ofstream(folder_ / "ends.json") << R"({"exposures": [{"file": "ends.tif", "exposure_s": 1}],
    "regions": [[0, 0, 1, 1], [1, 0, 2, 1], [2, 0, 3, 1], [3, 0, 4, 1]]})";
  const auto expect_ends = [&](int black, int full, const std::string& levels) {
    Image raw{4,
              1,
              {{"raw", {}}},
              {{"white_level_dn", fmt::format("{}", full)},
               {"sensor", R"({"readout":{"offset_dn":)" + fmt::format("{}", black) + levels}}};
    for (const int code : {black, black + 1, full - 1, full})
      raw.channels[0].values.push_back(static_cast<float>(code));
    write_raw_picture(folder_ / "ends.tif", raw);
    const auto all = read(folder_ / "ends.json");
    ASSERT_TRUE(all) << diagnostics_.text();
    const std::vector<std::vector<double>>& codes = all->series[0].codes;
    EXPECT_EQ(codes[0][0], 0) << black;
    EXPECT_NEAR(codes[1][0], 1.0 / (full - black), 1e-5) << black;
    EXPECT_NEAR(codes[2][0], 1 - 1.0 / (full - black), 1e-5) << full;
    EXPECT_EQ(codes[3][0], 1) << full;
  };
  for (int bits = 3; bits <= 16; ++bits)
    expect_ends(bits, (1 << bits) - 1, fmt::format(R"(,"bits":{}}}}})", bits));
  for (int saturation = 16000; saturation <= 16383; ++saturation)
    expect_ends(600, saturation, fmt::format(R"(,"bits":14,"saturation_dn":{}}}}})", saturation));
}

// Pictures of `develop`, films and pictures converted by others record a sensor's read-out but do not hold
// its codes.
TEST_F(Photographs, PicturesThatTellOfASensorAreNoCodesOfIt) {
  std::map<std::string, std::string> told{{"sensor", R"({"readout":{"bits":12,"offset_dn":100}})"}};
  const Image shown{3, 1, {{"Y", {500, 30000, 65535}}}, told};
  write_raw_picture(folder_ / "shown.tif", shown);
  write_exr(folder_ / "film.exr", {3, 1, {{"Y", {500 / 65535.0F, 30000 / 65535.0F, 1}}}, told});
  told["white_level_dn"] = "4095";
  write_raw_picture(folder_ / "converted.tif", {3, 1, shown.channels, told});
  for (const char* name : {"shown.tif", "film.exr", "converted.tif"})
    for (const char* listed : {"", R"("full_scale": 1, )"}) {
      std::ofstream(folder_ / "one.json") << "{" << listed << R"("regions": [[0, 0, 1, 1], [1, 0, 2, 1],
        [2, 0, 3, 1]], "exposures": [{"exposure_s": 1, "file": ")"
                                          << name << R"("}]})";
      const auto all = read(folder_ / "one.json");
      ASSERT_TRUE(all) << diagnostics_.text();
      EXPECT_NEAR(all->series[0].codes[0][0], 500 / 65535.0, 1e-7) << name << listed;
      EXPECT_NEAR(all->series[0].codes[1][0], 30000 / 65535.0, 1e-7) << name << listed;
      EXPECT_EQ(all->series[0].codes[2][0], 1) << name << listed;
      EXPECT_EQ(all->full_scale.value, 1) << name;
      EXPECT_FALSE(all->full_scale.dn) << name;
    }
}

// Values above the codes of the sensor reveal that a photograph was converted; smaller values do not.
TEST_F(Photographs, RawFilesAmongConvertedOnesAreReported) {
  const std::map<std::string, std::string> told{{"white_level_dn", "4095"},
                                                {"sensor", R"({"readout":{"bits":12,"offset_dn":100}})"}};
  write_raw_picture(folder_ / "dark.tif", {2, 1, {{"Y", {500, 3000}}}, told});
  write_raw_picture(folder_ / "bright.tif", {2, 1, {{"Y", {8000, 48000}}}, told});
  const auto series = [&](const std::string& first, const std::string& second) {
    std::ofstream(folder_ / "two.json")
        << R"({"exposures": [{"exposure_s": 1, "file": ")" << first
        << R"(.tif"}, {"exposure_s": 2, "file": ")" << second << R"(.tif"}]})";
    return folder_ / "two.json";
  };
  expect_complaint_of(series("dark", "bright"), "bright.tif has no codes of a sensor, but the first has");
  expect_complaint_of(series("bright", "dark"), "dark.tif has codes of its sensor, but the first has other");
  EXPECT_TRUE(read(series("bright", "bright"))) << diagnostics_.text();
}

// "A" is a channel of this sensor; in other files it is the opacity of pixels.
TEST_F(Photographs, PlanesOfTheSensorAreSeries) {
  const auto channels_of = [&](const std::string& name) {
    std::ofstream(folder_ / "planes.json")
        << R"({"exposures": [{"exposure_s": 1, "file": ")" << name << R"("}]})";
    const auto all = read(folder_ / "planes.json");
    EXPECT_TRUE(all) << diagnostics_.text();
    return all ? all->channels : std::vector<std::string>{};
  };
  const std::vector<std::string> sensor{"L", "A", "B"};
  const std::map<std::string, std::string> told{{"sensor_channels", "L,A,B"},
                                                {"white_level_dn", "4095"},
                                                {"sensor", R"({"readout":{"bits":12,"offset_dn":100}})"}};
  write_raw_picture(folder_ / "a.tif", {1, 1, {{"L", {300}}, {"A", {200}}, {"B", {400}}}, told});
  EXPECT_EQ(channels_of("a.tif"), (std::vector<std::string>{"B", "L", "A"})) << "B before others";
  RawPicture raw;
  raw.width = raw.height = 1;
  raw.planes = raw.channels = sensor;
  raw.codes = {300, 200, 400};
  raw.metadata = told;
  write_dng(folder_ / "a.dng", raw);
  write_fits(folder_ / "a.fits", raw);
  for (const char* name : {"a.dng", "a.fits"})
    EXPECT_EQ(channels_of(name), (std::vector<std::string>{"B", "L", "A"})) << name;
  Image film{1, 1, {{"A", {0.2F}}, {"B", {0.4F}}, {"L", {0.3F}}, {"Variance.L", {0}}}, {}};
  write_exr(folder_ / "a.exr", film);
  EXPECT_EQ(channels_of("a.exr"), (std::vector<std::string>{"B", "L"}));
  film.metadata["sensor_channels"] = "L,A,B";
  film.channels.push_back({"Coverage", {1}});
  write_exr(folder_ / "a.exr", film);
  EXPECT_EQ(channels_of("a.exr"), (std::vector<std::string>{"B", "A", "L"}));
  film.channels = {{"A", {1}}, {"B", {0.4F}}, {"G", {0.4F}}, {"R", {0.3F}}};
  write_exr(folder_ / "a.exr", film);
  EXPECT_EQ(channels_of("a.exr"), (std::vector<std::string>{"R", "G", "B"}))
      << "a picture made of such a film";
}

TEST_F(Photographs, SaysWhatIsWrong) {
  write_exr(folder_ / "a.exr", {4, 1, {{"Y", {0, 0, 0, 0}}}, {}});
  write_exr(folder_ / "b.exr", {2, 1, {{"Y", {0, 0}}}, {}});
  write_exr(folder_ / "c.exr", {4, 1, {{"Z", {0, 0, 0, 0}}}, {}});
  expect_complaint("{", "bad.json:1:2");
  expect_complaint("{}", "missing key \"exposures\"");
  expect_complaint(R"({"exposures": []})",
                   "/exposures: error: expected an array of exposures (got 0 of them, allowed [1, inf))");
  expect_complaint(R"({"exposures": [{"file": "a.exr"}]})",
                   "a.exr records no exposure time: \"exposure_s\" is needed here");
  expect_complaint(R"({"exposures": [{"file": "a.exr", "exposure_s": 0}]})",
                   "/exposures/0/exposure_s: error: expected a number (got 0, allowed (0, inf))");
  expect_complaint(
      R"({"exposures": [{"file": "a.exr", "exposure_s": 1}, {"file": "b.exr", "exposure_s": 1}]})",
      "b.exr has 2 x 1 pixels, the first 4 x 1");
  expect_complaint(
      R"({"exposures": [{"file": "a.exr", "exposure_s": 1}, {"file": "c.exr", "exposure_s": 1}]})",
      "c.exr has other channels than the first");
  expect_complaint(R"({"regions": [[0, 0, 5, 1]], "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "region [0, 0, 5, 1] exceeds its 4 x 1 pixels");
  expect_complaint(R"({"regions": [[2, 0, 2, 1]], "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "/regions/0: error: expected pixels x0, y0, x1, y1 with x0 < x1 and y0 < y1");
  expect_complaint(R"({"regions": [[0, 0, 1.5, 1]], "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "/regions/0/2: error: expected an integer (got 1.5");
  expect_complaint(R"({"regions": [[0, 0, 1]], "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "/regions/0: error: wrong number of elements (got 3, allowed 4)");
  expect_complaint(R"({"full_scale": 0, "bits": 17, "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "/bits: error: expected an integer (got 17, allowed [0, 16])");
  expect_complaint(R"({"exposure": [], "exposures": [{"file": "a.exr", "exposure_s": 1}]})",
                   "unknown key \"exposure\"; did you mean \"exposures\"?");
}

}  // namespace
}  // namespace abbe::test
