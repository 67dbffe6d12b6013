#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "sensor/readout/readout.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Films developed to digital numbers, files and pictures.

namespace abbe::test {
namespace {

constexpr const char* kReadout =
    R"({"gain_e_per_dn": 3, "bits": 12, "offset_dn": 50, "full_well_e": 9000, "read_noise_e": 6,
        "dark_e_per_s": 4000, "prnu_percent": 2, "dsnu_e": 4, "serial": 5})";

// A film of 24 x 16 pixels of a dome, which a large ball illuminates unevenly.
std::string uneven_scene(const std::string& name, const std::string& sensor) {
  return scratch()
      .write(name, R"({"abbe": 1, "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 4},
          "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
          "sensor": {"resolution": [24, 16], "pixel_pitch_um": 600, "exposure_s": 0.01, )" +
                       sensor + R"(},
          "materials": {"white": {"diffuse": {"reflectance": 0.5}}},
          "lights": [{"environment": {}, "emission": {"illuminant": "D65", "radiance": 0.00003}}],
          "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.3}, "material": "white"}],
          "render": {"samples": 8}})")
      .string();
}
const std::string kRgb =
    R"("response": "quantum", "fill_factor": 0.5, "channels": {"R": {"band": [600, 700]},
        "G": {"filters": [{"band": [500, 600]}], "exposure_s": 0.04}, "B": {"band": [400, 500]}})";

// Film of that scene.
std::string uneven_film(const std::string& name, const std::string& sensor, const std::string& options = "") {
  return film_of(uneven_scene(name + ".json", sensor), name, options);
}
std::string rgb_film() {
  return uneven_film("rgb", kRgb + ", \"readout\": " + kReadout);
}

Readout readout() {
  Readout r;
  r.gain_e_per_dn = 3;
  r.bits = 12;
  r.offset_dn = 50;
  r.full_well_e = 9000;
  r.read_noise_e = 6;
  r.dark_e_per_s = 4000;
  r.prnu_percent = 2;
  r.dsnu_e = 4;
  r.serial = 5;
  return r;
}
constexpr double kArea = 600e-6 * 600e-6 * 0.5;

// Digital numbers of a plane, computed by the library.
std::vector<float> codes(const Image& film, const std::string& plane, const Exposure& exposure) {
  std::vector<float> electrons;
  for (const float value : film.find(plane)->values) electrons.push_back(static_cast<float>(value * kArea));
  const RawFrame frame = read_out(readout(), electrons, exposure);
  return {frame.dn.begin(), frame.dn.end()};
}
std::vector<float> whole_numbers(const ImageChannel& channel) {
  std::vector<float> numbers;
  for (const float value : channel.values) numbers.push_back(std::round(value * 65535));
  return numbers;
}

TEST(Develop, TheRawFileIsTheReadOutOfTheFilm) {
  const std::string path = rgb_film();
  developed(path + " --seed 9 -o " + file("raw.tif") + " -o " + file("raw.png"));
  const Image rendered = read_exr(path);
  for (const char* name : {"raw.tif", "raw.png"}) {
    const Image raw = read_picture(file(name));
    ASSERT_EQ(raw.channels.size(), 3U);
    EXPECT_EQ(whole_numbers(raw.channels[0]), codes(rendered, "R", {0.01, 9, 0})) << name;
    EXPECT_EQ(whole_numbers(raw.channels[1]), codes(rendered, "G", {0.04, 9, 1})) << name;
    EXPECT_EQ(whole_numbers(raw.channels[2]), codes(rendered, "B", {0.01, 9, 2})) << name;
  }
  EXPECT_EQ(read_picture(file("raw.png")).metadata.at("scene_sha256"), rendered.metadata.at("scene_sha256"));
}

TEST(Develop, PartsHoldEveryStepAndDevelopAgain) {
  const std::string path = rgb_film();
  developed(path + " -o " + file("parts.exr") + " -o " + file("once.png"));
  const Image rendered = read_exr(path);
  const std::vector<ExrPart> parts = read_exr_parts(file("parts.exr"));
  std::vector<std::string> names;
  for (const ExrPart& part : parts) names.push_back(part.name);
  ASSERT_EQ(names, (std::vector<std::string>{"exposure", "variance", "electrons", "dn", "preview"}));
  EXPECT_EQ(parts[0].image.find("G")->values, rendered.find("G")->values);
  EXPECT_EQ(parts[0].image.find("Variance.G"), nullptr);
  EXPECT_EQ(parts[1].image.find("Variance.G")->values, rendered.find("Variance.G")->values);
  EXPECT_FLOAT_EQ(parts[2].image.find("G")->values[5],
                  static_cast<float>(rendered.find("G")->values[5] * kArea));
  EXPECT_EQ(parts[3].image.find("B")->values, codes(rendered, "B", {0.01, 0, 2}));
  EXPECT_EQ(parts[0].image.metadata.at("data_sha256"), rendered.metadata.at("data_sha256"));
  const std::vector<float>& green = parts[3].image.find("G")->values;
  const std::vector<float>& full = parts[3].image.find("Saturated.G")->values;
  for (std::size_t i = 0; i < green.size(); ++i)
    if (green[i] < 3000) {
      EXPECT_EQ(full[i], 0) << "a well is full at 3050 codes";
    }
  developed(file("parts.exr") + " -o " + file("again.png"));
  EXPECT_EQ(read_file(file("once.png")), read_file(file("again.png")));
}

TEST(Develop, NoiseBelongsToTheSeedWhichIsTheRendersUnlessGiven) {
  const std::string sensor = kRgb + ", \"readout\": " + kReadout;
  const std::string first = uneven_film("seeded", sensor, "--seed 3");
  developed(first + " -o " + file("default.png"));
  developed(first + " --seed 3 -o " + file("three.png"));
  developed(first + " --seed 4 -o " + file("four.png"));
  EXPECT_EQ(read_file(file("default.png")), read_file(file("three.png")));
  EXPECT_NE(read_file(file("three.png")), read_file(file("four.png")));
}

TEST(Develop, TheReportSetsTheSensorsNoiseBesideTheRenders) {
  const std::string path = rgb_film();
  const nlohmann::json report = developed(path);
  const Image rendered = read_exr(path);
  const auto mean = [&rendered](const char* channel) {
    const std::vector<float>& values = rendered.find(channel)->values;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_EQ(report["planes"], (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_NEAR(report["mean_e"][0], mean("R") * kArea, 1e-3);
  const TemporalNoise noise = temporal_noise(readout(), report["mean_e"][1], 0.04);
  EXPECT_EQ(report["photon_noise_e"][1], noise.photon_e);
  EXPECT_EQ(report["dark_noise_e"][1], noise.dark_e);
  EXPECT_NEAR(report["dark_noise_e"][0], std::sqrt(40.0), 1e-9);
  EXPECT_EQ(report["read_noise_e"][2], 6);
  EXPECT_EQ(report["quantisation_noise_e"][2], noise.quantisation_e);
  EXPECT_EQ(report["sensor_noise_e"][1], noise.total_e);
  EXPECT_NEAR(report["render_error_e"][2], std::sqrt(mean("Variance.B")) * kArea, 1e-3);
  EXPECT_GT(report["render_error_e"][2], 0);
  EXPECT_NEAR(report["iso_speed"], std::stod(rendered.metadata.at("isoSpeed")),
              1e-4 * report["iso_speed"].get<double>());
  // Two wells collect twice the electrons.
  const nlohmann::json deep = developed(path + " --set /readout/full_well_e=1000 --set /readout/bits=16");
  const nlohmann::json deeper = developed(path + " --set /readout/full_well_e=2000 --set /readout/bits=16");
  EXPECT_NEAR(deep["iso_speed"].get<double>() / deeper["iso_speed"].get<double>(), 2, 1e-9);
  EXPECT_EQ(developed(path + " --set /readout/full_well_e=1")["saturated_share"][0], 1);
}

TEST(Develop, OneSampleTellsNoErrorOfTheRender) {
  const std::string sensor = kRgb + ", \"readout\": " + kReadout;
  for (const char* options : {"--spp 1", "--spp 64 --sample-range 0:1"}) {
    const nlohmann::json error = developed(uneven_film("one", sensor, options))["render_error_e"];
    EXPECT_EQ(error, nlohmann::json::array({nullptr, nullptr, nullptr})) << options;
  }
  EXPECT_TRUE(developed(uneven_film("bare_one", kRgb, "--spp 1"))["render_error"][0].is_null());
}

TEST(Develop, TheFilmTellsWhatItIs) {
  const Image rendered = read_exr(rgb_film());
  EXPECT_EQ(rendered.metadata.at("expTime"), "0.01");
  EXPECT_EQ(rendered.metadata.at("aperture"), "4");
  EXPECT_EQ(rendered.metadata.at("exposure_s.G"), "0.04");
  EXPECT_NEAR(std::stod(rendered.metadata.at("gathering_area_m2")), kArea, 1e-15);
  const nlohmann::json sensor = nlohmann::json::parse(rendered.metadata.at("sensor"));
  EXPECT_EQ(sensor["channels"]["G"]["filters"][0]["band"][0], 500);
  EXPECT_EQ(sensor["readout"]["gain_e_per_dn"], 3);
  EXPECT_EQ(read_exr(uneven_film("plain", kRgb)).metadata.count("isoSpeed"), 0U);
}

TEST(Develop, TheElectronicsMayBeVariedAndNothingElse) {
  const std::string bare = uneven_film("bare", kRgb);
  const Outcome none = abbe("develop " + bare + " -o " + file("no.png"));
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("needs a film with a readout"), std::string::npos) << none.err;
  developed(bare + " --set '/readout=" + kReadout + "' -o " + file("given.png"));
  developed(rgb_film() + " -o " + file("own.png"));
  EXPECT_EQ(read_picture(file("given.png")).channels[1].values,
            read_picture(file("own.png")).channels[1].values);
  const Outcome used = abbe("develop " + bare + " --set /exposure_s=2");
  EXPECT_EQ(used.code, 2);
  EXPECT_NE(used.err.find("(got /exposure_s, allowed /readout and keys below it, /output/white)"),
            std::string::npos)
      << used.err;
  const Outcome wrong = abbe("develop " + rgb_film() + " --set /readout/bits=99");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_NE(wrong.err.find("/readout/bits: error: expected an integer (got 99, allowed [1, 16])"),
            std::string::npos)
      << wrong.err;
  const std::string energy = uneven_film("energy", R"("channels": {"all": 1})");
  const Outcome uncounted = abbe("develop " + energy + " --set '/readout=" + kReadout + "'");
  EXPECT_EQ(uncounted.code, 4);
  EXPECT_NE(uncounted.err.find("channel \"all\" counts no electrons"), std::string::npos) << uncounted.err;
}

TEST(Develop, WithoutAReadOutThePictureIsTheRenders) {
  for (const auto& [name, sensor] :
       {std::pair{"shown", kRgb}, std::pair{"observer", std::string(R"("observer": "1931")")},
        std::pair{"mosaic", kRgb + R"(, "mosaic": [["R", "G"], ["G", "B"]])"}}) {
    for (const char* exposure : {"", " --set /output/exposure=1e12"}) {
      const std::string path = uneven_film(name, sensor, "--display " + file("rendered.png") + exposure);
      const nlohmann::json report = developed(path + " --display " + file("developed.png"));
      EXPECT_EQ(report["mean"].size(), report["planes"].size());
      EXPECT_EQ(report["render_error"].size(), report["planes"].size());
      const Image rendered = read_picture(file("rendered.png"));
      const Image shown = read_picture(file("developed.png"));
      ASSERT_EQ(shown.channels.size(), 3U) << name;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(shown.channels[k].values, rendered.channels[k].values) << name;
    }
  }
}

// The picture of a raw file with negligible noise equals that of its film within the steps of its codes.
TEST(Develop, TheRawFileMakesThePictureOfTheFilm) {
  for (const char* mosaic : {"", R"(, "mosaic": [["R", "G"], ["G", "B"]])"}) {
    const std::string path = uneven_film("fine", kRgb + mosaic, "--display " + file("film.png"));
    developed(
        path +
        R"( --set '/readout={"gain_e_per_dn": 1, "bits": 16, "offset_dn": 300, "dark_e_per_s": 100000}' --display )" +
        file("raw_picture.png"));
    const Image a = read_picture(file("film.png"));
    const Image b = read_picture(file("raw_picture.png"));
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < a.pixels(); ++i)
        EXPECT_NEAR(a.channels[k].values[i], b.channels[k].values[i], 0.12) << mosaic << k << ' ' << i;
  }
}

TEST(Develop, AMosaicIsOnePlane) {
  const std::string path =
      uneven_film("bayer", kRgb + R"(, "mosaic": [["R", "G"], ["G", "B"]], "readout": )" + kReadout);
  developed(path + " -o " + file("bayer.tif") + " -o " + file("bayer_parts.exr"));
  const Image raw = read_picture(file("bayer.tif"));
  ASSERT_EQ(raw.channels.size(), 1U);
  std::vector<double> seconds;  // G, on odd diagonals, has its own exposure time
  for (int y = 0; y < raw.height; ++y)
    for (int x = 0; x < raw.width; ++x) seconds.push_back((x + y) % 2 == 1 ? 0.04 : 0.01);
  EXPECT_EQ(whole_numbers(raw.channels[0]), codes(read_exr(path), "raw", {0.01, 0, 0, 0, seconds}));
  const std::vector<ExrPart> parts = read_exr_parts(file("bayer_parts.exr"));
  EXPECT_EQ(parts.back().name, "preview");
  EXPECT_EQ(parts.back().image.channels.size(), 3U);
}

// The preview is the picture before the curve of the display, if no colour had to be moved into its gamut.
TEST(Develop, ThePreviewIsLinear) {
  const std::string path = uneven_film("linear", R"("observer": "1931")");
  developed(path + " -o " + file("linear_parts.exr") + " --display " + file("linear.png"));
  const std::vector<ExrPart> parts = read_exr_parts(file("linear_parts.exr"));
  ASSERT_EQ(parts.back().name, "preview");
  const Image& preview = parts.back().image;
  const Image picture = read_picture(file("linear.png"));
  const auto decoded = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  int compared = 0;
  for (std::size_t i = 0; i < preview.pixels(); ++i) {
    std::array<double, 3> rgb{};
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = preview.channels[2 - k].values[i];  // sorted by name
    if (*std::max_element(rgb.begin(), rgb.end()) > 1 || *std::min_element(rgb.begin(), rgb.end()) < 0)
      continue;
    ++compared;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(rgb[k], decoded(picture.channels[k].values[i]), 0.006) << i << k;
  }
  EXPECT_GT(compared, 50);
}

// The attributes of the preview do not change how a comparison reads its colours.
TEST(Develop, ThePreviewIsComparedAsRec709) {
  developed(rgb_film() + " -o " + file("told_parts.exr"));
  Image told = read_exr_parts(file("told_parts.exr")).back().image;
  Image brighter = told;
  for (float& value : brighter.channels.at(1).values) value *= 1.1F;
  const auto difference = [&](const std::string& name) {
    write_exr(file(name + "_a.exr"), brighter);
    write_exr(file(name + "_b.exr"), told);
    return abbe("compare " + file(name + "_a.exr") + " " + file(name + "_b.exr") + " --json")
        .json()["dE00_mean"];
  };
  const auto of_preview = difference("told");
  told.metadata.clear();
  brighter.metadata.clear();
  EXPECT_EQ(of_preview, difference("bare"));
}

TEST(Develop, MergedPartsDevelopLikeTheirWhole) {
  const std::string text = uneven_scene("halves.json", kRgb + ", \"readout\": " + kReadout);
  for (const char* range : {"0:4", "4:8"})
    EXPECT_EQ(abbe("render " + text + " --quiet --sample-range " + range + " -o " +
                   file(std::string(range).substr(0, 1) + ".abbepart"))
                  .code,
              0);
  EXPECT_EQ(abbe("merge " + file("0.abbepart") + " " + file("4.abbepart") + " -o " + file("merged.exr")).code,
            0);
  developed(file("merged.exr") + " -o " + file("merged.png"));
  EXPECT_EQ(abbe("render " + text + " --quiet -o " + file("halves.exr")).code, 0);
  developed(file("halves.exr") + " -o " + file("whole.png"));
  EXPECT_EQ(read_file(file("merged.png")), read_file(file("whole.png")));
}

}  // namespace
}  // namespace abbe::test
