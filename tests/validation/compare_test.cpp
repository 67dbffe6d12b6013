// `abbe compare`: maps, patches, formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/chart/patches.h"
#include "cli/compare.h"
#include "description/load.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "io/picture.h"
#include "report/chart_difference.h"
#include "report/display_color.h"
#include "report/image_difference.h"
#include "report/maps.h"
#include "results/rendered_film.h"
#include "sensor/film/crop.h"
#include "sensor/film/recorded_attributes.h"
#include "spectral/rgb.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

namespace abbe::test {
namespace {

Image grey(const std::vector<float>& values) {
  return {static_cast<int>(values.size()), 1, {{"R", values}, {"G", values}, {"B", values}}, {}};
}

std::filesystem::path saved(const std::string& name, const Image& image) {
  write_exr(scratch() / name, image);
  return scratch() / name;
}

TEST(Compare, LooksAtPixelsThatBothFilmsHave) {
  const auto cropped = [](std::vector<float> values, const std::string& crop) {
    Image film = grey(values);
    film.metadata[kCropKey] = crop;
    return film;
  };
  const auto compared = [](const Image& image, const Image& reference) {
    return json_output(cli::compare, {saved("part.exr", image), saved("whole.exr", reference)});
  };
  const Image whole = grey({9, 2, 2, 9});
  const Image part = cropped({0, 1, 2, 0}, "1,0,3,1");
  const json expected = compared(grey({1, 2}), grey({2, 2}));
  for (const Image& reference : {whole, cropped({0, 2, 2, 9}, "1,0,4,1")}) {
    json found = compared(part, reference);
    EXPECT_EQ(found["crop"], json::array({1, 0, 3, 1}));
    found.erase("crop");
    EXPECT_EQ(found, expected);
  }
  EXPECT_FALSE(compared(whole, whole).contains("crop"));
  const cli::CompareOptions apart{saved("part.exr", part),
                                  saved("other.exr", cropped({5, 0, 0, 0}, "0,0,1,1"))};
  EXPECT_EQ(fault([&] { cli::compare(apart); }, "no pixel in common (got crops 1,0,3,1 and 0,0,1,1)"),
            ErrorCode::input);
}

// The films were merged from several parts.
TEST(Compare, LooksAtPixelsOfAllAreasThatBothFilmsHave) {
  Image gaps = grey({1, 0, 2, 0});
  gaps.metadata[kAreasKey] = "0,0,1,1=0:8 2,0,3,1=0:4";
  const auto image = saved("gaps.exr", gaps);
  const auto whole = saved("whole.exr", grey({2, 9, 2, 9}));
  json found = json_output(cli::compare, {image, whole});
  EXPECT_EQ(found["areas"], json::parse("[[0, 0, 1, 1], [2, 0, 3, 1]]"));
  found.erase("areas");
  EXPECT_EQ(found, json_output(cli::compare, {saved("a.exr", grey({1, 2})), saved("b.exr", grey({2, 2}))}));
  EXPECT_EQ(fault(
                [&] {
                  cli::compare({image, whole, DeltaE::cie2000, {}, scratch() / "m"});
                },
                "--maps: needs films whose common pixels form one rectangle (got the areas 0,0,1,1 2,0,3,1)"),
            ErrorCode::usage);
}

TEST(Compare, AUnitThatOneImageTellsIsWarnedOf) {
  Image film = grey({1, 2});
  film.metadata["channel.G"] = "energy, response-weighted J per m^2";
  const auto told = saved("told.exr", film);
  const auto untold = saved("untold.exr", grey({1, 2}));
  const auto said = [](const cli::CompareOptions& options) {
    testing::internal::CaptureStderr();
    (void)json_output(cli::compare, options);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(said({told, untold}).find("only one of the images declares the unit of channel G"),
            std::string::npos);
  EXPECT_EQ(said({told, told}), "");
  EXPECT_EQ(said({untold, untold}), "");
}

TEST(Compare, ChannelsThatOneImageAloneHasAreWarnedOf) {
  Image red = grey({1, 2});
  for (const char* channel : {"red", "Variance.red", "A"}) red.channels.push_back({channel, {1, 2}});
  const auto more = saved("more.exr", red);
  const auto less = saved("less.exr", grey({1, 2}));
  for (const cli::CompareOptions& options :
       {cli::CompareOptions{more, less}, cli::CompareOptions{less, more}}) {
    testing::internal::CaptureStderr();
    (void)json_output(cli::compare, options);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "abbe: warning: channels that only one of the images has are not compared: red\n");
  }
}

TEST(DifferenceMaps, ColoursAndScaleFollowTheValues) {
  const Image a = grey({1, 1.1F, 1});
  const Image b = grey({1, 1, 1});
  const auto maps = difference_maps(relative_errors(a, b), color_difference(a, b), 3, 1);
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].name, "relative_error");
  EXPECT_EQ(maps[0].high, 0.1) << "0.0995 of relative error";
  EXPECT_EQ(maps[1].name, "delta_e");
  EXPECT_NEAR(maps[0].map.channels[0].values[0], map_color(0)[0], 1e-6);
  EXPECT_NEAR(maps[0].map.channels[0].values[1], map_color(0.995)[0], 0.02);
  EXPECT_EQ(maps[0].map.channels[2].values[2], maps[0].map.channels[2].values[0]);
}

TEST(DifferenceMaps, HistogramBarsAreAsHighAsTheirShares) {
  const Image picture = histogram_picture({0, 0, 0, 0, 9.9, 9.9, 12}, 10);
  const auto drawn = [&](double share) {  // pixels of the bar's column that are not white
    const int x = 36 + static_cast<int>(share * 64) * 8 + 3;
    int count = 0;
    for (int y = 0; y < 200 + 12; ++y)
      count += picture.channels[0].values[static_cast<std::size_t>(y * picture.width + x)] < 0.999F ||
               picture.channels[2].values[static_cast<std::size_t>(y * picture.width + x)] < 0.999F;
    return count;
  };
  EXPECT_EQ(drawn(0), 200);
  EXPECT_EQ(drawn(0.5), 0);
  EXPECT_EQ(drawn(0.99), 150) << "what is beyond counts at the end";
}

TEST(CompareCommand, KeysOfTheContractAndOfTheChoice) {
  const auto a = saved("a.exr", grey({1, 0.5F}));
  const auto b = saved("b.exr", grey({1, 0.25F}));
  const json plain = json_output(cli::compare, {a, b});
  for (const char* key : {"relMSE", "rmse", "mean_ratio", "dE00_mean", "dE00_p95", "dE00_max"})
    EXPECT_TRUE(plain.contains(key)) << key;
  EXPECT_EQ(plain.size(), 6U);
  const json other = json_output(cli::compare, {a, b, DeltaE::cie76});
  EXPECT_EQ(other["dE00_max"], plain["dE00_max"]);
  EXPECT_NEAR(other["dE76_max"].get<double>(), 116 * (std::cbrt(0.5) - std::cbrt(0.25)), 1e-5);
}

TEST(CompareCommand, MapsAreWritten) {
  const auto a = saved("a.exr", grey({1, 0.5F}));
  const auto b = saved("b.exr", grey({1, 0.25F}));
  const std::filesystem::path folder = scratch() / "maps" / "deep";
  const json answer = json_output(cli::compare, {a, b, DeltaE::cie2000, {}, folder});
  ASSERT_EQ(answer["maps"].size(), 2U);
  for (const auto& map : answer["maps"]) {
    EXPECT_EQ(read_picture(folder / map["map"].get<std::string>()).width, 2);
    EXPECT_GT(read_picture(folder / map["histogram"].get<std::string>()).width, 500);
  }
}

// A film with exactly the values of the chart's spectra times 3, except for the first patch, which is
// brighter.
Image planted_film(const Scene& scene, double brighter, std::size_t lamp = 0) {
  Image film{scene.camera.width, scene.camera.height, {}, film_attributes(scene)};
  for (const Channel& channel : scene.channels) film.channels.push_back({channel.name, {}});
  const Curve light = scene.lights[lamp].emission.curve();
  for (ImageChannel& channel : film.channels) channel.values.assign(film.pixels(), 0);
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      // The camera looks perpendicularly at the center of the chart: 64 pixels are 2 x 1000 tan(0.125
      // degrees).
      const double scale = 2000 * std::tan(0.125 * M_PI / 180) / 64;
      const double column = ((x + 0.5 - 48) * scale + 3);
      const double row = ((y + 0.5 - 32) * scale + 2);
      if (column < 0 || column >= 6 || row < 0 || row >= 4) continue;
      const auto patch = static_cast<std::size_t>(row) * 6 + static_cast<std::size_t>(column);
      const auto& material = scene.materials[scene.shapes[patch].material];
      const std::vector<double> seen =
          camera_raw(scene.channels, light, std::get<DiffuseMaterial>(material.model).reflectance.curve());
      for (std::size_t c = 0; c < seen.size(); ++c)
        film.channels[c].values[static_cast<std::size_t>(y * film.width + x)] =
            static_cast<float>(3 * seen[c] * (patch == 0 ? brighter : 1));
    }
  return film;
}

std::filesystem::path chart_file() {
  return data_directory() / "scenes" / "validation" / "colorchecker.json";
}

// The scene of the chart with the given sensor and light.
Scene chart_scene(const std::string& sensor = R"({"observer": "1931", "resolution": [96, 64]})",
                  const std::string& illuminant = "D65") {
  Diagnostics diagnostics;
  const std::vector<Override> overrides{{"/sensor", sensor}, {"/lights/0/emission/illuminant", illuminant}};
  auto scene = load_scene(chart_file(), overrides, diagnostics);
  EXPECT_TRUE(scene) << diagnostics.text();
  return *std::move(scene);
}

constexpr const char* kNikon = R"({"camera": "Nikon_D5100", "resolution": [96, 64]})";

double mean_delta_e(const std::vector<PatchDifference>& patches) {
  double sum = 0;
  for (const PatchDifference& patch : patches) sum += patch.delta_e.value();
  return sum / static_cast<double>(patches.size());
}

TEST(CompareChart, PatchesAreComparedWithTheirSpectra) {
  const Scene scene = chart_scene();
  for (const PatchDifference& patch : compare_chart(scene, planted_film(scene, 1), nullptr, DeltaE::cie2000))
    EXPECT_LT(patch.delta_e.value(), 1e-4) << patch.name;
  const auto off = compare_chart(scene, planted_film(scene, 1.1), nullptr, DeltaE::cie76);
  EXPECT_GT(off[0].delta_e.value(), 1);
  EXPECT_GT(off[0].image.value()[0], off[0].reference.value()[0] + 1);
  EXPECT_LT(off[5].delta_e.value(), 0.2) << "only the common factor moves the others";
}

// A film of another camera may show none of the patches: no factor then equates their Y.
TEST(CompareChart, AFilmThatIsDarkInAllPatchesIsAnError) {
  const Scene scene = chart_scene();
  Image dark = planted_film(scene, 1);
  for (ImageChannel& channel : dark.channels) std::ranges::fill(channel.values, 0.0F);
  EXPECT_EQ(fault([&] { static_cast<void>(compare_chart(scene, dark, nullptr, DeltaE::cie2000)); },
                  "no light in its patches"),
            ErrorCode::input);
}

TEST(CompareChart, PatchesAreSeenByTheFilmsObserver) {
  const Scene wide = chart_scene(R"({"observer": "1964", "resolution": [96, 64]})", "FL11");
  const Scene narrow = chart_scene(R"({"observer": "1931", "resolution": [96, 64]})", "FL11");
  const Image film = planted_film(wide, 1);
  for (const Scene* scene : {&wide, &narrow})
    for (const PatchDifference& patch : compare_chart(*scene, film, nullptr, DeltaE::cie2000))
      EXPECT_LT(patch.delta_e.value(), 1e-4) << patch.name;
  const Image other = planted_film(narrow, 1);
  EXPECT_EQ(fault([&] { static_cast<void>(compare_chart(wide, film, &other, DeltaE::cie2000)); },
                  "only one film records the CIE 1964 observer"),
            ErrorCode::input);
  EXPECT_EQ(fault([&] { static_cast<void>(compare_images(film, other)); }, "photometric of CIE 1964"),
            ErrorCode::input);
}

TEST(CompareChart, AFilmOfACameraIsReadByItsOwnMatrix) {
  for (const char* illuminant : {"D65", "A"}) {
    const Scene scene = chart_scene(kNikon, illuminant);
    const Image film = planted_film(scene, 1);
    EXPECT_LT(mean_delta_e(compare_chart(scene, film, nullptr, DeltaE::cie2000)), 1.5) << illuminant;
    const Scene seen = chart_scene(R"({"observer": "1931", "resolution": [96, 64]})", illuminant);
    const Image reference = planted_film(seen, 1);
    EXPECT_LT(mean_delta_e(compare_chart(seen, film, &reference, DeltaE::cie2000)), 1.5) << illuminant;
  }
}

TEST(CompareChart, TheMatrixTakesTheSensorsOrderOfChannels) {
  const Scene scene = chart_scene(kNikon);
  Image film = planted_film(scene, 1);
  const double before = mean_delta_e(compare_chart(scene, film, nullptr, DeltaE::cie2000));
  Matrix3 m = parse_matrix3(film.metadata["to_xyz_d65"]).value();
  for (int row = 0; row < 3; ++row) std::swap(m[row][0], m[row][2]);
  film.metadata["to_xyz_d65"] = to_text(m);
  film.metadata["sensor_channels"] = "B,G,R";
  EXPECT_NEAR(mean_delta_e(compare_chart(scene, film, nullptr, DeltaE::cie2000)), before, 1e-9);
}

TEST(CompareCommand, FilmsOfASensorWithoutAMatrixHaveNoColours) {
  Image film = planted_film(chart_scene(kNikon), 1);
  const auto whole = saved("whole.exr", film);
  film.metadata.erase("to_xyz_d65");
  const auto bare = saved("bare.exr", film);
  film.metadata["to_xyz_d65"] = "1 0 0 0 1 0 0 0";
  const auto broken = saved("broken.exr", film);
  EXPECT_EQ(json_output(cli::compare, {whole, whole})["dE00_mean"], 0);
  for (const auto& other : {bare, broken}) {
    const json answer = json_output(cli::compare, {other, whole, DeltaE::cie2000, chart_file()});
    for (const char* key : {"dE00_mean", "dE00_p95", "dE00_max", "patches_dE00_mean", "patches_dE00_max"})
      EXPECT_TRUE(answer.contains(key) && answer[key].is_null()) << key << " of " << other;
    EXPECT_EQ(answer["relMSE"], 0);
    ASSERT_EQ(answer["patches"].size(), 24U);
    EXPECT_TRUE(answer["patches"][0]["Lab"].is_null());
    EXPECT_TRUE(answer["patches"][0]["dE00"].is_null());
    EXPECT_TRUE(answer["patches"][0]["reference_Lab"].is_array());
  }
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(cli::compare({bare, {}, DeltaE::cie2000, chart_file()}));
  EXPECT_NE(testing::internal::GetCapturedStdout().find("patches_dE00_mean  -"), std::string::npos);
}

TEST(ColorDifference, EachFilmGoesByItsOwnMatrix) {
  Image a = grey({1, 0.5F});
  Image b = a;
  a.metadata = {{"channel.R", "quantum, electrons per m^2"}, {"sensor_channels", "R,G,B"}};
  a.metadata["to_xyz_d65"] = "0.95 0 0 0 1 0 0 0 1.09";
  b.metadata = a.metadata;
  b.metadata["to_xyz_d65"] = "0.95 0 0 0 2 0 0 0 1.09";
  const Lab white = xyz_to_lab(XYZ{0.475, 0.5, 0.545}, unit_xyz(kD65));
  const Lab green = xyz_to_lab(XYZ{0.475, 1, 0.545}, unit_xyz(kD65));
  EXPECT_NEAR(color_difference(a, b, DeltaE::cie76)->pixels[0], delta_e(DeltaE::cie76, green, white), 1e-9)
      << "the reference's Y of 2 is 100";
  EXPECT_EQ(color_difference(a, a)->max, 0);
}

TEST(ColorDifference, ImagesOfNoSensorAreRec709) {
  Image a = grey({1, 0.5F});
  a.metadata["to_xyz_d65"] = "1 0 0 0 0 0 0 0 0";
  EXPECT_NEAR(tristimuli(a)[0][0], unit_xyz(kD65)[0], 1e-6);
  EXPECT_NEAR(tristimuli(a)[0][1], 1, 1e-6);
}

TEST(ColorDifference, TheObserversChannelsAreTakenAsTheyAre) {
  const Image film = planted_film(chart_scene(R"({"observer": "1931", "resolution": [96, 64]})", "A"), 1);
  ASSERT_TRUE(film.metadata.contains("to_xyz_d65"));
  const std::size_t middle = film.pixels() / 2 + 30;
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(tristimuli(film)[middle][c], film.channels[c].values[middle]);
}

// The position of a negligible light in the list must not determine the white.
TEST(CompareChart, IsSeenInTheMainLightNotInTheFirst) {
  for (const char* sensor : {R"({"observer": "1931", "resolution": [96, 64]})", kNikon}) {
    const auto with = [&](const std::string& lights) {
      Diagnostics diagnostics;
      const std::vector<Override> overrides{{"/sensor", sensor}, {"/lights", lights}};
      return load_scene(chart_file(), overrides, diagnostics).value();
    };
    const std::string faint =
        R"({"name": "faint", "point": {"at": [0, 0, 900]}, "emission": {"illuminant": "A", "luminous_intensity": 0.001}})";
    const std::string dome =
        R"({"name": "dome", "environment": {}, "emission": {"illuminant": "D65", "luminance": 1}})";
    const Scene first = with("[" + faint + "," + dome + "]");
    const Scene last = with("[" + dome + "," + faint + "]");
    const Image film = planted_film(first, 1, 1);
    EXPECT_EQ(film.metadata.at("white"), "dome");
    EXPECT_EQ(film.metadata.at("to_xyz_d65"), planted_film(last, 1).metadata.at("to_xyz_d65"));
    EXPECT_LT(mean_delta_e(compare_chart(first, film, nullptr, DeltaE::cie2000)), 1.5) << sensor;
    EXPECT_LT(color_difference(film, planted_film(last, 1))->max, 1e-6);
  }
}

// The white affects how films are viewed, and is no difference between them.
TEST(ColorDifference, FilmsAreSeenInOneWhite) {
  const std::string observer = R"({"observer": "1931", "resolution": [96, 64]})";
  Scene scene = chart_scene(observer, "A");
  const Image own = planted_film(scene, 1);
  const Image dim = planted_film(scene, 1.2);
  scene.output.white = White{"D65", "asked for", kD65, Curve(1.0)};
  const Image other = planted_film(scene, 1);
  EXPECT_EQ(other.metadata.at("white"), "D65");
  EXPECT_LT(color_difference(other, own)->max, 1e-6);
  const double in_own = color_difference(dim, own)->mean;
  EXPECT_DOUBLE_EQ(color_difference(dim, other, DeltaE::cie2000, recorded_white(own))->mean, in_own);
  EXPECT_GT(std::abs(color_difference(dim, other)->mean / in_own - 1), 1e-4) << "white tells the colours";
  Image untold = other;
  untold.metadata.erase("white_xy");
  EXPECT_GT(color_difference(own, untold)->max, 5) << "one of them relative to D65 already";
}

TEST(CompareCommand, AWhiteIsNamedByALightAnIlluminantOrItsCoordinates) {
  const Image film = planted_film(chart_scene(R"({"observer": "1931", "resolution": [96, 64]})", "A"), 1);
  const auto a = saved("white_a.exr", film);
  const auto b = saved(
      "white_b.exr", planted_film(chart_scene(R"({"observer": "1931", "resolution": [96, 64]})", "A"), 1.2));
  const auto mean = [&](const std::string& white) {
    cli::CompareOptions options{b, a};
    options.white = white;
    return json_output(cli::compare, options)["dE00_mean"].get<double>();
  };
  EXPECT_DOUBLE_EQ(mean("light 0"), mean(""));
  EXPECT_NEAR(mean("A"), mean(""), 1e-9);
  EXPECT_NEAR(mean("[0.447576, 0.407440]"), mean(""), 1e-5);
  EXPECT_GT(std::abs(mean("D65") / mean("") - 1), 1e-4);
  cli::CompareOptions wrong{b, a};
  wrong.white = "D56";
  EXPECT_EQ(fault([&] { cli::compare(wrong); }, "unknown light or illuminant \"D56\""), ErrorCode::usage);
  wrong.white = "[0.7, 0.29]";
  EXPECT_EQ(fault([&] { cli::compare(wrong); }, "chromatic adaptation to this white is impossible"),
            ErrorCode::usage);
}

TEST(CompareChart, TwoFilmsAreScaledAlike) {
  const Scene scene = chart_scene();
  const Image reference = planted_film(scene, 1);
  const auto patches = compare_chart(scene, planted_film(scene, 1.1), &reference, DeltaE::cie76);
  EXPECT_GT(patches[0].delta_e.value(), 1);
  for (std::size_t i = 1; i < patches.size(); ++i)
    EXPECT_LT(patches[i].delta_e.value(), 1e-4) << patches[i].name;
  const json answer =
      json_output(cli::compare, {saved("film.exr", planted_film(scene, 1.1)), saved("other.exr", reference),
                                 DeltaE::cie2000, chart_file()});
  EXPECT_EQ(answer["patches"].size(), 24U);
  EXPECT_EQ(answer["patches"][0]["patch"], "dark skin");
  EXPECT_EQ(answer["patches_dE00_max"], answer["patches"][0]["dE00"]);
  EXPECT_TRUE(answer.contains("relMSE"));
}

TEST(CompareFaults, SomethingToCompareWithIsNeeded) {
  const auto a = saved("a.exr", grey({1, 0.5F}));
  EXPECT_EQ(fault([&] { cli::compare({a, {}}); }, "needs a reference or --chart"), ErrorCode::usage);
  const auto furnace = data_directory() / "scenes" / "furnace.json";
  EXPECT_EQ(fault([&] { cli::compare({a, {}, DeltaE::cie2000, furnace}); }, "no chart"), ErrorCode::input);
  EXPECT_EQ(fault(
                [&] {
                  cli::compare({a, {}, DeltaE::cie2000, furnace, scratch() / "m"});
                },
                "needs a reference"),
            ErrorCode::usage);
}

}  // namespace
}  // namespace abbe::test
