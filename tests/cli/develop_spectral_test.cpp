#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "io/spectral_exr.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Spectral films, and sensors that record them.

namespace abbe::test {
namespace {

constexpr const char* kBins = R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 5})";
const std::string kBroadBands =
    R"("response": "quantum", "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]}, "B": {"band": [400, 500]}})";

// A dome of 0.5 W/(m^2 sr nm) from 400 to 700 nm through a fast wide-angle lens.
std::string dome_scene(const std::string& name, const std::string& sensor,
                       const std::string& focal_length = "0.02") {
  return scratch()
      .write(name, fmt::format(R"({{"abbe": 1,
        "camera": {{"thin_lens": {{"focal_length": {}, "f_number": 2, "focus_distance": "infinity"}},
                    "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
        "sensor": {{"resolution": [24, 16], "pixel_pitch_um": 1000, "exposure_s": 0.02, {}}},
        "lights": [{{"environment": {{}}, "emission": {{"spectrum": {{"band": [400, 700], "value": 0.5}}}}}}],
        "render": {{"samples": 64}}}})",
                               focal_length, sensor))
      .string();
}
std::string dome_film(const std::string& name, const std::string& sensor, const std::string& options = "") {
  return film_of(dome_scene(name + ".json", sensor), name, options);
}

TEST(DevelopSpectral, BinsHoldTheRadianceThatIsSeenFromCornerToCorner) {
  const std::string path = dome_film("bins", kBins, "--spp 1024");
  const SpectralImage image = spectral_image(read_exr(path), path);
  ASSERT_EQ(image.bands.size(), 60U);
  EXPECT_EQ(image.metadata.at("expTime"), "0.02");
  EXPECT_EQ(image.metadata.at("whiteLuminance"), "1");
  double sum = 0;
  double corner = 0;
  for (const SpectralBand& band : image.bands) {
    double mean = 0;
    for (const float radiance : band.radiance) mean += static_cast<double>(radiance) / 384;
    EXPECT_NEAR(mean, 2.5, 0.025) << band.center_nm;
    sum += mean;
    corner += static_cast<double>(band.radiance.front());
  }
  EXPECT_NEAR(sum, 150, 0.2);  // 0.08 % less, since cos^4 decreases within this large pixel
  EXPECT_NEAR(corner, 150, 0.3) << "the lens darkens its corners to a half, the scene does not";
}

// Images of life size: at f/1, with rays from the rim of the lens at 14 degrees to the axis, and at f/2 off
// the axis.
TEST(DevelopSpectral, CloseUpsHoldTheRadianceToo) {
  for (const char* lens : {R"("f_number": 1)", R"("f_number": 2, "blades": 5)"}) {
    const auto scene = [&](const std::string& name, const std::string& sensor) {
      return scratch()
          .write(name, fmt::format(R"({{"abbe": 1,
            "camera": {{"thin_lens": {{"focal_length": 0.1, {}, "focus_distance": 0.2}},
                        "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
            "sensor": {{"resolution": [12, 8], "pixel_pitch_um": 10000, {}}},
            "lights": [{{"environment": {{}}, "emission": {{"spectrum": {{"band": [400, 700], "value": 0.5}}}}}}],
            "render": {{"samples": 4096}}}})",
                                   lens, sensor))
          .string();
    };
    const std::string path =
        film_of(scene("macro.json", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 150})"), "macro",
                "--stats " + file("macro.stats"));
    const auto stats = nlohmann::json::parse(read_file(file("macro.stats")));
    const SpectralImage image = spectral_image(read_exr(path), path);
    for (const SpectralBand& band : image.bands) {
      double mean = 0;
      for (const float radiance : band.radiance) mean += static_cast<double>(radiance) / 96;
      EXPECT_NEAR(mean, 75, 0.15) << lens;
      EXPECT_NEAR(band.radiance.front(), 75, 0.4) << lens;
      EXPECT_NEAR(band.radiance[53], 75, 0.4) << lens;
    }
    EXPECT_NEAR(stats["film"]["475nm"]["mean"], 75, 0.15) << lens;
    const std::string counting = scene("counting_macro.json", kBroadBands);
    developed(path + " --scene " + counting + " -o " + file("seen.exr"));
    const Image seen = read_exr_parts(file("seen.exr")).front().image;
    const Image direct = read_exr(film_of(counting, "direct_macro"));
    for (const std::size_t pixel : {0U, 53U})
      EXPECT_NEAR(seen.find("G")->values[pixel] / direct.find("G")->values[pixel], 1, 0.015) << lens;
  }
}

TEST(DevelopSpectral, StatsAreOfTheRadiancesThatTheFilmHolds) {
  const std::string path = dome_film("stats", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 100})",
                                     "--crop 0,0,12,16 --stats " + file("dome.stats"));
  const auto stats = nlohmann::json::parse(read_file(file("dome.stats")));
  const Image film = read_exr(path);
  double mean = 0;
  double variance = 0;
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 12; ++x) {
      mean += static_cast<double>(film.find(spectral_channel(450))->values[24 * y + x]) / 192;
      variance += static_cast<double>(film.find("Variance." + spectral_channel(450))->values[24 * y + x]);
    }
  EXPECT_NEAR(mean, 50, 2.5);
  EXPECT_NEAR(stats["film"]["450nm"]["mean"], mean, 1e-6 * mean);
  EXPECT_NEAR(stats["film"]["450nm"]["standard_error"], std::sqrt(variance) / 192, 1e-6 * mean);
}

// A dome of 0.5 W/(m^2 sr nm) over all visible wavelengths has 683 lm/W x 0.5 x 106.8 nm.
TEST(DevelopSpectral, ThePreviewIsInCandelas) {
  const std::string path = dome_film("dome", kBins);
  const Image image = read_exr(path);
  const double luminance = 0.2126 * image.find("R")->values[200] + 0.7152 * image.find("G")->values[200] +
                           0.0722 * image.find("B")->values[200];
  EXPECT_NEAR(luminance, 683 * 0.5 * 106.8, 200);
  EXPECT_EQ(abbe("develop " + path + " --display " + file("dome.png")).code, 0);
  EXPECT_EQ(read_picture(file("dome.png")).channels.size(), 3U);
}

TEST(DevelopSpectral, RenderAndDevelopShowTheSame) {
  for (const char* exposure : {"", "--set /output/exposure=1e5"}) {
    const std::string film = dome_film("shown", kBins, exposure + (" --display " + file("render.png")));
    ASSERT_EQ(abbe("develop " + film + " --display " + file("develop.png")).code, 0);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(read_picture(file("render.png")).channels[k].values,
                read_picture(file("develop.png")).channels[k].values)
          << exposure;
  }
}

// Its unit is the candela. Films of the sensor are in electrons.
TEST(DevelopSpectral, TheExposureOfRadiancesIsNoSensors) {
  const std::string scene = dome_scene("counting.json", kBroadBands);
  const auto seen = [&](const std::string& film) {
    developed(film + " --scene " + scene + " -o " + file("counted.exr") + " --display " +
              file("counted.png"));
    EXPECT_FALSE(read_exr_parts(file("counted.exr")).front().image.metadata.contains("display_exposure"));
    return read_picture(file("counted.png")).channels[0].values;
  };
  const std::vector<float> chosen = seen(dome_film("unexposed", kBins));
  EXPECT_EQ(seen(dome_film("exposed", kBins, "--set /output/exposure=1e5")), chosen);
}

TEST(DevelopSpectral, ASensorThatLooksLaterCountsWhatOneInTheSceneCounts) {
  const std::string spectral = dome_film("later", kBins);
  const std::string direct = dome_film("direct", kBroadBands);
  const Outcome run = abbe("develop " + spectral + " --scene " + dome_scene("sensor.json", kBroadBands) +
                           " -o " + file("seen.exr") + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const Image seen = read_exr_parts(file("seen.exr")).front().image;
  const Image rendered = read_exr(direct);
  for (const char* channel : {"R", "G", "B"})
    for (const std::size_t pixel : {0U, 200U, 383U})
      EXPECT_NEAR(seen.find(channel)->values[pixel] / rendered.find(channel)->values[pixel], 1, 0.01)
          << channel << pixel;
  EXPECT_EQ(seen.metadata.at("scene_sha256"), read_exr(spectral).metadata.at("scene_sha256"));
  EXPECT_EQ(seen.metadata.count("spectralLayoutVersion"), 0U);
  EXPECT_EQ(seen.metadata.at("channel.R"), "quantum, electrons per m^2");
  const Outcome raw = abbe("develop " + spectral + " --scene " + dome_scene("sensor.json", kBroadBands) +
                           R"( --set '/readout={"gain_e_per_dn": 1e6, "bits": 16}' -o )" + file("seen.tif"));
  EXPECT_EQ(raw.code, 0) << raw.err;
}

// A shutter that opens and closes during the whole exposure passes half the light to any sensor.
TEST(DevelopSpectral, AShutterTakesNothingOffRadiancesAndItsShareOffCounts) {
  const std::string shutter = R"(, "shutter": {"rise_s": 0.01, "fall_s": 0.01})";
  const std::string path = dome_film("half_open", kBins + shutter);
  const SpectralImage image = spectral_image(read_exr(path), path);
  double mean = 0;
  for (const float radiance : image.bands[30].radiance) mean += static_cast<double>(radiance) / 384;
  EXPECT_NEAR(mean, 2.5, 0.15);
  const std::string scene = dome_scene("half_sensor.json", kBroadBands + shutter);
  ASSERT_EQ(abbe("develop " + path + " --scene " + scene + " -o " + file("half_seen.exr")).code, 0);
  const Image seen = read_exr_parts(file("half_seen.exr")).front().image;
  const Image rendered = read_exr(dome_film("half_direct", kBroadBands + shutter));
  EXPECT_NEAR(seen.find("G")->values[200] / rendered.find("G")->values[200], 1, 0.01);
}

TEST(DevelopSpectral, AMosaicLooksThroughEachPixelsOwnFilter) {
  const std::string spectral = dome_film("for_mosaic", kBins);
  const auto seen = [&](const std::string& name, const std::string& sensor) {
    const Outcome run = abbe("develop " + spectral + " --scene " + dome_scene(name + ".json", sensor) +
                             " -o " + file(name + ".exr"));
    EXPECT_EQ(run.code, 0) << run.err;
    return read_exr_parts(file(name + ".exr"));
  };
  const std::vector<ExrPart> all = seen("all_channels", kBroadBands);
  const std::vector<ExrPart> own = seen("bayer", kBroadBands + R"(, "mosaic": [["R", "G"], ["G", "B"]])");
  ASSERT_GE(own.size(), 2U);
  for (const int part : {0, 1}) {
    const auto plane = [&](const std::vector<ExrPart>& parts, const std::string& name) {
      const ImageChannel* found =
          parts[static_cast<std::size_t>(part)].image.find((part == 0 ? "" : "Variance.") + name);
      return found == nullptr ? std::vector<float>(384) : found->values;
    };
    for (const auto& [pixel, name] :
         std::map<std::size_t, std::string>{{0, "R"}, {1, "G"}, {24, "G"}, {25, "B"}}) {
      EXPECT_GT(plane(own, "raw")[pixel], 0) << pixel;
      EXPECT_EQ(plane(own, "raw")[pixel], plane(all, name)[pixel]) << pixel;
    }
  }
}

TEST(DevelopSpectral, ResponsesBeyondTheBandsAreTold) {
  const std::string spectral =
      dome_film("narrow", R"("spectral": {"from_nm": 500, "to_nm": 600, "step_nm": 10})");
  const auto seen = [&](const std::string& band) {
    return abbe(
        "develop " + spectral + " --scene " +
        dome_scene("band.json", R"("response": "quantum", "channels": {"W": {"band": )" + band + "}}"));
  };
  EXPECT_EQ(seen("[510, 590]").err, "");
  const Outcome half = seen("[550, 650]");
  EXPECT_EQ(half.code, 0);
  EXPECT_NE(
      half.err.find("covers only 500 to 600 nm, but 52.1 % of the response of channel \"W\" lies outside"),
      std::string::npos)
      << half.err;
  const Outcome none = seen("[610, 650]");
  EXPECT_EQ(none.code, 4);
  EXPECT_NE(none.err.find("but 100 % of the response"), std::string::npos) << none.err;
}

TEST(DevelopSpectral, PartsOfASpectralFilmMerge) {
  const std::string text = dome_scene("merged.json", kBins);
  for (const char* range : {"0:32", "32:64"})
    ASSERT_EQ(abbe("render " + text + " --quiet --sample-range " + range + " -o " +
                   file(std::string(range) + ".abbepart"))
                  .code,
              0);
  ASSERT_EQ(
      abbe("merge " + file("0:32.abbepart") + " " + file("32:64.abbepart") + " -o " + file("merged.exr"))
          .code,
      0);
  ASSERT_EQ(abbe("render " + text + " --quiet -o " + file("at_once.exr")).code, 0);
  EXPECT_EQ(read_file(file("merged.exr")), read_file(file("at_once.exr")));
}

TEST(DevelopSpectral, WhatDoesNotFitIsRefused) {
  const std::string spectral = dome_film("fits", kBins);
  const auto says = [](const std::string& arguments, int code, const std::string& words) {
    const Outcome run = abbe("develop " + arguments);
    EXPECT_EQ(run.code, code) << arguments << '\n' << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  const std::string picture = " --display " + file("no.png");
  says(spectral + picture + " --iso 400", 2,
       "--iso: needs a sensor for a spectral film (allowed with --scene)");
  says(spectral + picture + " --set /readout/bits=8", 2, "--set: needs a sensor for a spectral film");
  says(spectral + " -o " + file("no.tif"), 2, "needs a sensor for a spectral film (allowed with --scene)");
  says(spectral + " --scene " + dome_scene("same.json", kBins), 2, "its sensor is spectral itself");
  says(spectral + " --scene " + dome_scene("far.json", kBroadBands, "0.03"), 4,
       "was rendered with another field of view");
  std::string meter = read_file(dome_scene("meter.json", kBroadBands));
  const std::size_t camera = meter.find("{\"thin_lens\"");
  meter.replace(camera, meter.find("\"sensor\"") - camera,
                R"({"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]}}, )");
  says(spectral + " --scene " + scratch().write("meter.json", meter).string(), 4,
       "was rendered with another kind of camera");
  std::string small = read_file(dome_scene("small.json", kBroadBands));
  small.replace(small.find("[24, 16]"), 8, "[12, 8]");
  says(spectral + " --scene " + scratch().write("small.json", small).string(), 4,
       "has another size than the sensor (got 24 x 16, allowed 12 x 8)");
  says(spectral + " --scene " + file("absent.json"), 4, "absent.json");
  says(dome_film("counted", kBroadBands) + " --scene " + dome_scene("sensor.json", kBroadBands), 2,
       "applies to spectral films only");
  const std::string tilting =
      R"("response": "quantum", "channels": {"t": {"filters": [{"transmittance": {"band": [500, 510]}, "effective_index": 2}]}})";
  says(spectral + " --scene " + dome_scene("tilting.json", tilting) + " -o " + file("no.exr"), 2,
       "depends on the angle of incidence");
  Image image = read_exr(spectral);
  image.metadata.erase("emissiveUnits");
  write_exr(file("unitless.exr"), image);
  says(file("unitless.exr"), 4, "unitless.exr: missing attribute \"emissiveUnits\"");
  image.metadata["emissiveUnits"] = "W.m^-2.sr^-1";
  image.channels.push_back({"S0.nm", image.channels.front().values});
  write_exr(file("unnamed.exr"), image);
  says(file("unnamed.exr"), 4, "unnamed.exr: channel \"S0.nm\" names no wavelength");
}

}  // namespace
}  // namespace abbe::test
