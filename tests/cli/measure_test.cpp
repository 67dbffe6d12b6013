#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "io/exr.h"
#include "io/table.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"
#include "tests/tier.h"

// Charts in films, raw files and pictures.

namespace abbe::test {
namespace {

std::string chart_scene(const std::string& name, const std::string& sensor, double corner = -3,
                        const std::string& illuminant = "D65") {
  return scratch()
      .write(name + ".json", fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 0.25, "f_number": 1}}, "from": [0, 0, 1000], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [96, 64], {}}},
      "lights": [{{"point": {{"at": [0, 0, 10000]}}, "emission": {{"illuminant": "{}", "luminous_flux_lm": 1.2e9}}}}],
      "shapes": [{{"name": "chart", "chart": {{"reflectances": "colorchecker24_babelcolor_average",
                   "corner": [{}, -2, 0], "edge_u": [6, 0, 0], "edge_v": [0, 4, 0]}}}}],
      "render": {{"samples": 16}}}})",
                                         sensor, illuminant, corner))
      .string();
}
const std::string kBayer = R"("model": "dslr_apsc_bayer_14bit", "exposure_s": 0.4)";

// Film of a chart through a mosaic, with its scene.
struct Shot {
  std::string scene;
  std::string film;
};
Shot shot(const std::string& name, const std::string& sensor, const std::string& illuminant = "D65") {
  const std::string scene = chart_scene(name, sensor, -3, illuminant);
  return {scene, film_of(scene, name)};
}

nlohmann::json measured(const std::string& arguments) {
  const Outcome run = abbe("measure " + arguments + " --json");
  EXPECT_EQ(run.code, 0) << arguments << '\n' << run.err;
  return run.code == 0 ? run.json() : nlohmann::json();
}

TEST(Measure, EveryRawFileHasTheSamePatches) {
  const auto [scene, film] = shot("raw", kBayer);
  std::string outputs;
  std::string files;
  for (const char* end : {"dng", "fits", "tif", "png"}) {
    outputs += " -o " + file(std::string("raw.") + end);
    files += file(std::string("raw.") + end) + " ";
  }
  ASSERT_EQ(abbe("develop " + film + outputs).code, 0);
  const nlohmann::json all = measured(files + film + " --chart " + scene);
  ASSERT_EQ(all.size(), 5U);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(all[i]["channels"], (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(all[i]["patches"], all[0]["patches"]) << all[i]["image"];
  }
  // The raw file has the values of the film within its noise.
  const nlohmann::json& expected = all[4]["patches"];
  const nlohmann::json& found = all[0]["patches"];
  ASSERT_EQ(found.size(), 24U);
  double unit = 0;
  for (std::size_t i = 0; i < 24; ++i)
    unit += found[i]["mean"][1].get<double>() / expected[i]["mean"][1].get<double>() / 24;
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double pixels = found[i]["pixels"][k];
      const double error = found[i]["deviation"][k].get<double>() / std::sqrt(pixels);
      EXPECT_GE(pixels, 9);
      EXPECT_NEAR(found[i]["mean"][k], expected[i]["mean"][k].get<double>() * unit, 6 * error + 1)
          << found[i]["patch"];
    }
}

TEST(Measure, CornersByHandFindWhatTheSceneSays) {
  const auto [scene, film] = shot("hand", R"("observer": "1931")");
  const double half = 32 / std::tan(0.125 * 3.14159265358979 / 180) / 1000;  // pixels per metre
  const std::string corners =
      fmt::format("{},{},{},{},{},{},{},{}", 48 - 3 * half, 32 - 2 * half, 48 + 3 * half, 32 - 2 * half,
                  48 + 3 * half, 32 + 2 * half, 48 - 3 * half, 32 + 2 * half);
  const nlohmann::json by_scene = measured(film + " --chart " + scene);
  const nlohmann::json by_hand =
      measured(film + " --chart colorchecker24_babelcolor_average --corners " + corners);
  EXPECT_EQ(by_hand["patches"], by_scene["patches"]);
  const nlohmann::json compared = abbe("compare " + film + " --chart " + scene + " --json").json();
  EXPECT_EQ(compared["patches"][3]["pixels"], by_scene["patches"][3]["pixels"][0]) << "the same code";
}

// Each channel counts its own pixels. Together they are all pixels of the patch.
TEST(Measure, CompareReadsAMosaicByTheSameCode) {
  const auto [scene, film] = shot("mosaic", kBayer);
  const nlohmann::json patches = measured(film + " --chart " + scene)["patches"];
  const Outcome run = abbe("compare " + film + " --chart " + scene + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json compared = run.json();
  ASSERT_EQ(compared["patches"].size(), 24U);
  for (std::size_t i = 0; i < 24; ++i) {
    std::size_t pixels = 0;
    for (const std::size_t of_channel : patches[i]["pixels"]) pixels += of_channel;
    EXPECT_EQ(compared["patches"][i]["pixels"], pixels) << i;
  }
  EXPECT_GT(compared["patches_dE00_mean"], 0.1);
  EXPECT_LT(compared["patches_dE00_mean"], 2.5) << "what the camera errs by";
}

TEST(Measure, TheTableIsWhatCalibrateTakes) {
  const auto [scene, film] = shot("loop", kBayer);
  ASSERT_EQ(abbe("develop " + film + " -o " + file("loop.dng")).code, 0);
  const Outcome run =
      abbe("measure " + file("loop.dng") + " --chart " + scene + " -o " + file("patches.csv"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Outcome calibrated = abbe("calibrate --measured " + file("patches.csv") +
                                  " --chart colorchecker24_babelcolor_average --illuminant D65 --json");
  ASSERT_EQ(calibrated.code, 0) << calibrated.err;
}

// A raw converter shows the patches in the same colours, up to demosaicking and its rounding to 1/10000.
TEST(Measure, LibRawMakesTheSameColoursOfADng) {
  if (shell("command -v dcraw_emu").code != 0) GTEST_SKIP() << "libraw-bin is not installed";
  const auto [scene, film] = shot("colours", kBayer);
  ASSERT_EQ(abbe("develop " + film + " -o " + file("colours.dng") + " -o " + file("parts.exr")).code, 0);
  const Outcome run = shell("dcraw_emu -w -o 1 -4 -g 1 1 -W -q 0 -T " + file("colours.dng"));
  ASSERT_EQ(run.code, 0) << run.err;
  for (const ExrPart& part : read_exr_parts(file("parts.exr")))
    if (part.name == "preview")
      write_exr(file("preview.exr"), {part.image.width, part.image.height, part.image.channels, {}});
  const nlohmann::json theirs = measured(file("colours.dng.tiff") + " --chart " + scene)["patches"];
  const nlohmann::json ours = measured(file("preview.exr") + " --chart " + scene)["patches"];
  const auto mean = [](const nlohmann::json& patches, std::size_t patch, std::size_t channel) {
    return patches[patch]["mean"][channel].get<double>();
  };
  const double scale = mean(theirs, 21, 1) / mean(ours, 21, 1);  // neutral 5
  for (std::size_t patch = 0; patch < 24; ++patch) {
    const double brightest = std::max({mean(ours, patch, 0), mean(ours, patch, 1), mean(ours, patch, 2)});
    for (std::size_t k = 0; k < 3; ++k) {
      if (mean(ours, patch, k) <= 0) continue;  // the converter clips colours outside its gamut
      EXPECT_NEAR(mean(theirs, patch, k) / scale, mean(ours, patch, k), 0.01 * brightest)
          << ours[patch]["patch"] << ' ' << k;
    }
  }
}

// Colour matrix that LibRaw reads from a file, by rows.
std::array<double, 9> told_matrix(const std::string& told) {
  std::array<double, 9> matrix{};
  const std::string title = "DNG color matrix 1:\n";
  const std::size_t at = told.find(title);
  EXPECT_NE(at, std::string::npos) << told;
  if (at == std::string::npos) return matrix;
  std::istringstream numbers(told.substr(at + title.size()));
  for (double& element : matrix) numbers >> element;
  return matrix;
}

// Under illuminant A the matrix is that for A. It maps the white of A, without adaptation, to the values of
// the greys, which the white balance determines.
TEST(Measure, ADngOfAWarmLightTellsTheCameraInThatLight) {
  if (shell("command -v dcraw_emu").code != 0) GTEST_SKIP() << "libraw-bin is not installed";
  const auto [scene, film] = shot("warm", R"("model": "dslr_apsc_bayer_14bit", "exposure_s": 2)", "A");
  const std::string dng = file("warm.dng");
  ASSERT_EQ(abbe("develop " + film + " -o " + dng).code, 0);
  const std::string told = shell("raw-identify -v " + dng).out;
  EXPECT_NE(told.find("DNG Illuminant 1: Illuminant A"), std::string::npos) << told;
  const std::array<double, 9> matrix = told_matrix(told);
  constexpr std::array<double, 3> kWhiteA{1.09850, 1, 0.35585};
  std::array<double, 3> white{};
  for (std::size_t i = 0; i < 9; ++i) white[i / 3] += matrix[i] * kWhiteA[i % 3];
  const nlohmann::json grey = measured(dng + " --chart " + scene)["patches"][19]["mean"];
  for (const std::size_t k : {0U, 2U})
    EXPECT_NEAR(white[k] / white[1], grey[k].get<double>() / grey[1].get<double>(), 0.03 * white[k]) << k;
  ASSERT_EQ(shell("dcraw_emu -w -o 1 -4 -g 1 1 -W -q 0 -T " + dng).code, 0);
  const nlohmann::json shown = measured(dng + ".tiff --chart " + scene)["patches"][19]["mean"];
  for (const std::size_t k : {0U, 2U})
    EXPECT_NEAR(shown[k].get<double>() / shown[1].get<double>(), 1, 0.03) << k << ": grey is grey";
}

// A profile whose matrices invert a mixture of linear sRGB with its mean: by this fraction under D65, and not
// at all under A.
std::string mixing_profile(const std::string& name, double share, int warm = 17) {
  constexpr double kFromXyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                     {-0.9692660, 1.8760108, 0.0415560},
                                     {0.0556434, -0.2040259, 1.0572252}};
  constexpr double kToD50[3][3] = {{0.4360747, 0.3850649, 0.1430804},
                                   {0.2225045, 0.7168786, 0.0606169},
                                   {0.0139322, 0.0971045, 0.7141733}};
  nlohmann::json warm_light{
      {"CalibrationIlluminant", warm}, {"ColorMatrix", kFromXyz}, {"ForwardMatrix", kFromXyz}};
  nlohmann::json cool_light{{"CalibrationIlluminant", 21}, {"ForwardMatrix", kToD50}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double mean = 0;
      for (const auto& row : kFromXyz) mean += row[j] / 3;
      cool_light["ColorMatrix"][i][j] = (kFromXyz[i][j] - share * mean) / (1 - share);
    }
  return scratch().write(name, nlohmann::json{{"lights", {warm_light, cool_light}}}.dump()).string();
}

// LibRaw uses the matrix for D65, which must show the mixture in each patch.
TEST(Measure, LibRawTakesTheMatricesOfACalibration) {
  if (shell("command -v dcraw_emu").code != 0) GTEST_SKIP() << "libraw-bin is not installed";
  const auto [scene, film] = shot("profile", kBayer);
  const auto patches = [&, &scene = scene, &film = film](const std::string& name, double share) {
    const std::string dng = file(name + ".dng");
    const Outcome made =
        abbe("develop " + film + " --profile " + mixing_profile(name + ".json", share) + " -o " + dng);
    EXPECT_EQ(made.code, 0);
    EXPECT_EQ(made.err, "") << "libtiff knows its tags";
    EXPECT_EQ(shell("dcraw_emu -w -o 1 -4 -g 1 1 -W -q 0 -T " + dng).code, 0);
    return measured(dng + ".tiff --chart " + scene)["patches"];
  };
  const nlohmann::json plain = patches("plain", 0);
  const nlohmann::json mixed = patches("mixed", 0.5);
  for (std::size_t patch = 0; patch < 24; ++patch) {
    const auto values = plain[patch]["mean"].get<std::vector<double>>();
    const double mean = (values[0] + values[1] + values[2]) / 3;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(mixed[patch]["mean"][k], (values[k] + mean) / 2, 0.005 * mean + 1e-4) << patch << ' ' << k;
  }
  const std::string told = shell("raw-identify -v " + file("mixed.dng")).out;
  for (const char* line :
       {"DNG Illuminant 1: Illuminant A", "DNG Illuminant 2: D65",
        "DNG color matrix 1:\n3.2405\t-1.5371\t-0.4985", "DNG color matrix 2:\n5.7053\t-3.1192\t-1.1971",
        "DNG forward matrix 1:\n3.2405\t-1.5371\t-0.4985", "DNG forward matrix 2:\n0.4361\t0.3851\t0.1431"})
    EXPECT_NE(told.find(line), std::string::npos) << line << '\n' << told;
}

TEST(Measure, ProfilesThatNoConverterKnowsAreNamed) {
  const auto [scene, film] = shot("unknown", kBayer);
  const std::string out = " -o " + file("unknown.dng") + " --profile ";
  const std::string lone = scratch().write("lone.json", R"({"lights": [{}]})").string();
  const std::string bare = scratch().write("bare.json", R"({"lights": [{}, {}]})").string();
  for (const auto& [arguments, code, message] :
       {std::tuple{out + mixing_profile("other.json", 0, 255), 4, "the illuminant has no Exif code"},
        std::tuple{out + lone, 4, "/lights"}, std::tuple{out + bare, 4, "missing key \"ColorMatrix\""},
        std::tuple{out + file("absent.json"), 4, "absent.json"},
        std::tuple{" -o " + file("unknown.tif") + " --profile " + lone, 2, "applies to .dng files only"}}) {
    const Outcome run = abbe("develop " + film + arguments);
    EXPECT_EQ(run.code, code) << arguments << '\n' << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << '\n' << run.err;
  }
}

// The camera of the film is a Nikon D5100. A film with its own bands has the colours of no camera.
TEST(Measure, AProfileIsOfTheFilmsOwnCamera) {
  const std::string bands =
      R"("exposure_s": 0.4, "response": "quantum", "readout": {"gain_e_per_dn": 9, "bits": 14},
         "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]}, "B": {"band": [400, 500]}})";
  const std::string other = "has the matrices of another camera than the film's (got Canon_EOS_5D, allowed ";
  for (const auto& [film, camera, message] :
       {std::tuple{shot("own", kBayer).film, "Nikon_D5100", std::string()},
        std::tuple{file("own.exr"), "Canon_EOS_5D", other + "Nikon_D5100)"},
        std::tuple{shot("boxes", bands).film, "box:400-500,500-600,600-700", std::string()},
        std::tuple{file("boxes.exr"), "Canon_EOS_5D", other + "those of its own channels)"}}) {
    nlohmann::json profile = nlohmann::json::parse(read_file(mixing_profile("of.json", 0)));
    profile["camera"] = camera;
    const std::string path = scratch().write("of.json", profile.dump()).string();
    const Outcome run = abbe("develop " + film + " --profile " + path + " -o " + file("of.dng"));
    EXPECT_EQ(run.code, message.empty() ? 0 : 4) << camera << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << camera << run.err;
  }
}

TEST(Measure, SpectralFilmsHaveAValueForEachBand) {
  const auto [scene, film] = shot("bands", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 100})");
  const nlohmann::json bands = measured(film + " --chart " + scene);
  EXPECT_EQ(bands["channels"].size(), 3U);
  const nlohmann::json& red = bands["patches"][14];
  EXPECT_EQ(red["patch"], "red");
  EXPECT_GT(red["mean"][2].get<double>(), 3 * red["mean"][0].get<double>());
  const std::string path = file("bands.csv");
  ASSERT_EQ(abbe("measure " + film + " --chart " + scene + " -o " + path).code, 0);
  Diagnostics diagnostics;
  const auto table = read_table(path, TableOrigin::user, diagnostics);
  ASSERT_TRUE(table) << diagnostics.text();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto column = table->column(bands["channels"][k].get<std::string>());
    ASSERT_TRUE(column) << bands["channels"][k];
    EXPECT_EQ(table->rows[14][*column], fmt::format("{}", red["mean"][k].get<double>()));
  }
}

TEST(Measure, SaturatedPatchesAreNamed) {
  const auto [scene, film] = shot("bright", R"("model": "dslr_apsc_bayer_14bit", "exposure_s": 20)");
  ASSERT_EQ(abbe("develop " + film + " -o " + file("bright.tif")).code, 0);
  const Outcome run = abbe("measure " + file("bright.tif") + " --chart " + scene);
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.err.find("saturated pixels make the means too low in "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("white 9.5"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("black 2"), std::string::npos) << run.err;
}

// Pixels outside a crop are black, which must not count as a patch.
TEST(Measure, PixelsThatWereNotRenderedAreNoPatches) {
  const std::string scene = chart_scene("cropped", kBayer);
  const std::string film = file("cropped.exr");
  ASSERT_EQ(abbe("render " + scene + " --quiet --crop 0,0,96,30 -o " + film).code, 0);
  std::string outputs;
  for (const char* end : {"dng", "tif", "png", "parts.exr"})
    outputs += " -o " + file(std::string("cropped.") + end);
  ASSERT_EQ(abbe("develop " + film + outputs).code, 0);
  const std::vector<const char*> by_day{"exr", "dng", "parts.exr"};
  for (const char* end : nightly() ? std::vector{"exr", "dng", "tif", "png", "parts.exr"} : by_day) {
    const std::string image = file(std::string("cropped.") + end);
    const Outcome run = abbe("measure " + image + " --chart " + scene);
    EXPECT_EQ(run.code, 4) << end << '\n' << run.err;
    EXPECT_NE(run.err.find("its measured area extends outside the rendered pixels (got x in ["),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("allowed [0, 96] and [0, 30])"), std::string::npos) << run.err;
    EXPECT_EQ(abbe("measure " + image + " --chart colorchecker24_babelcolor_average --corners " +
                   "0,0,96,0,96,30,0,30")
                  .code,
              0)
        << end;
  }
}

TEST(Measure, FaultsAreNamed) {
  const auto [scene, film] = shot("faulty", kBayer);
  const std::string aside = chart_scene("aside", kBayer, 0);
  ASSERT_EQ(abbe("develop " + film + " -o " + file("faulty.dng")).code, 0);
  const std::string table = " --chart colorchecker24_babelcolor_average";
  (void)scratch().write("cut.dng", read_file(file("faulty.dng")).substr(0, 3000));
  (void)scratch().write("cut.fits", "SIMPLE  =                    T");
  for (const auto& [arguments, code, message] :
       {std::tuple{film + " --chart " + aside, 4, "its inner part is outside the film"},
        std::tuple{film + table + " --corners 0,0,200,0,200,64,0,64", 4,
                   "its measured area extends outside the film (got x in ["},
        std::tuple{film + table + " --corners 0,0,9,9,9,0,0,9", 2,
                   "--corners: expected the corners of a convex"},
        std::tuple{film + table, 2, "a table of patches needs --corners"},
        std::tuple{film + table + " --corners 0,0,9", 2, "got 3 numbers, allowed 8"},
        std::tuple{film + table + " --corners 0,0,12,0,12,8,0,8", 4, "contains no whole pixel of channel R"},
        std::tuple{file("cut.dng") + " --chart " + scene, 4, "cut.dng: "},
        std::tuple{file("cut.fits") + " --chart " + scene, 4, "cut.fits: not a FITS image"},
        std::tuple{film + " --chart " + scene + " -o " + file("x.txt"), 2, "allowed .csv"},
        std::tuple{film + " " + file("faulty.dng") + " --chart " + scene + " -o " + file("x.csv"), 2,
                   "needs images with the same channels and unit"}}) {
    const Outcome run = abbe("measure " + arguments);
    EXPECT_EQ(run.code, code) << arguments << '\n' << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << '\n' << run.err;
  }
}

// A chart seen obliquely in a raw file. The values at the detected position must equal those at the position
// that the camera of the scene gives.
TEST(Measure, CornersAreFound) {
  if (!ABBE_FINDS_CHARTS) GTEST_SKIP() << "built without OpenCV";
  const std::string scene = scratch()
                                .write("askew.json", R"({"abbe": 1,
      "camera": {"pinhole": {"fov_deg": 40, "f_number": 5.6}, "from": [3, 2, 9], "to": [0, 0, 0], "up": [0.2, 1, 0]},
      "sensor": {"resolution": [384, 256], "model": "dslr_apsc_bayer_14bit", "exposure_s": 0.02},
      "lights": [{"point": {"at": [5, 5, 20]}, "emission": {"illuminant": "D65", "luminous_flux_lm": 1e6}}],
      "shapes": [{"name": "chart", "chart": {"reflectances": "colorchecker24_babelcolor_average",
                   "corner": [-3, -2, 0], "edge_u": [6, 0, 0], "edge_v": [0, 4, 0]}}],
      "render": {"samples": 8}})")
                                .string();
  const std::string film = file("askew.exr");
  const std::string raw = file("askew.dng");
  ASSERT_EQ(abbe("render " + scene + " --quiet -o " + film).code, 0);
  ASSERT_EQ(abbe("develop " + film + " -o " + raw).code, 0);
  const std::string table = " --chart colorchecker24_babelcolor_average --corners find";
  const nlohmann::json known = measured(raw + " --chart " + scene)["patches"];
  const nlohmann::json found = measured(raw + table);
  ASSERT_EQ(found["corners"].size(), 4U);
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = known[i]["mean"][k];
      const double noise =
          known[i]["deviation"][k].get<double>() / std::sqrt(known[i]["pixels"][k].get<double>());
      EXPECT_NEAR(found["patches"][i]["mean"][k], value, 0.005 * value + 2 * noise) << known[i]["patch"];
    }
  const Outcome told = abbe("measure " + raw + table);
  EXPECT_NE(told.err.find("the chart was found at --corners "), std::string::npos) << told.err;
  const Outcome wrong = abbe("measure " + raw + " --chart colorcheckersg_after_nov2014 --corners find");
  EXPECT_EQ(wrong.code, 2) << wrong.err;
}

}  // namespace
}  // namespace abbe::test
