#include "develop/develop.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "develop/film_file.h"
#include "develop/raw_picture.h"
#include "films.h"
#include "io/error.h"
#include "io/exr.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe {
namespace {

using test::counting_film;

ExposedFilm exposed(const std::vector<Override>& overrides = {}, const Image& film = counting_film()) {
  Diagnostics diagnostics;
  return {film, read_film_sensor(film, "a.exr", overrides, {}, {}, diagnostics).value()};
}

TEST(Develop, StepsFollowOneAnother) {
  const ExposedFilm film = exposed();
  const DevelopedFilm developed = develop(film, 7);
  EXPECT_EQ(developed.exposure.channels.front().values, film.film.channels.front().values);
  EXPECT_FLOAT_EQ(developed.electrons.channels.front().values[0], 400);
  EXPECT_FLOAT_EQ(developed.electrons.channels.front().values[1], 900);
  const ImageChannel& codes = *developed.codes.find("V");
  for (std::size_t i = 0; i < 2; ++i)  // gain 1, dark signal 0.02 electrons
    EXPECT_FLOAT_EQ(developed.calibrated.find("V")->values[i], (codes.values[i] - 0.02F) / 1e-10F);
  EXPECT_NEAR(codes.values[1], 900, 6 * std::sqrt(900.0));
}

TEST(Develop, NoiseIsAFunctionOfTheSeed) {
  const ExposedFilm film = exposed();
  EXPECT_EQ(render_seed(film.film), 7U);
  EXPECT_EQ(render_seed({}), 0U);
  EXPECT_EQ(develop(film, 7).codes.channels[0].values, develop(film, 7).codes.channels[0].values);
  EXPECT_NE(develop(film, 7).codes.channels[0].values, develop(film, 8).codes.channels[0].values);
}

TEST(Develop, FiguresAreMeansAndRootsOfMeanSquares) {
  const ExposedFilm film = exposed({{"/readout/full_well_e", "600"}});
  const std::vector<PlaneFigures> figures = plane_figures(film.sensor, develop(film, 7));
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_NEAR(figures[0].mean, 650, 1e-3);
  EXPECT_NEAR(figures[0].render_error.value(), std::sqrt(2e22) * 1e-10, 1e-5);
  EXPECT_NEAR(figures[0].noise.photon_e, std::sqrt(650.0), 1e-3);
  EXPECT_EQ(figures[0].saturated_fraction, 0.5);
}

TEST(Develop, AnErrorThatTheFilmDoesNotKnowIsNotTold) {
  ExposedFilm film = exposed();
  film.film.metadata["frame_mean_error"] = "inf";
  EXPECT_FALSE(plane_figures(film.sensor, develop(film, 7))[0].render_error);
  replace_with_frame(film, FlatFrame{});
  EXPECT_EQ(plane_figures(film.sensor, develop(film, 7))[0].render_error, 0) << "a frame of no render";
}

// The value of a directly visible light fits single precision, but its square does not.
TEST(Develop, AnErrorWhoseSquareSinglePrecisionDoesNotHoldIsNotTold) {
  Image lamp = counting_film();
  lamp.channels[1].values[1] = std::numeric_limits<float>::infinity();
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "bare_lamp.exr";
  write_exr(path, lamp);
  const ExposedFilm film = exposed({}, read_film(path));
  std::filesystem::remove(path);
  EXPECT_FALSE(plane_figures(film.sensor, develop(film, 7))[0].render_error);
}

TEST(Develop, FiguresAreOfTheAreasThatWereRendered) {
  Image film = counting_film();
  film.metadata["areas"] = "1,0,2,1=0:8";
  const ExposedFilm merged = exposed({}, film);
  EXPECT_NEAR(plane_figures(merged.sensor, develop(merged, 7))[0].mean, 900, 1e-3);
}

TEST(Develop, WithoutAReadOutTheExposureIsAll) {
  ExposedFilm film = exposed();
  film.sensor.readout.reset();
  const DevelopedFilm developed = develop(film, 7);
  EXPECT_TRUE(developed.codes.channels.empty());
  ASSERT_EQ(developed.calibrated.channels.size(), 1U);
  EXPECT_EQ(developed.calibrated.channels[0].values, film.film.channels[0].values);
  const std::vector<PlaneFigures> figures = plane_figures(film.sensor, developed);
  EXPECT_NEAR(figures[0].mean, 6.5e12, 1e6);
  EXPECT_NEAR(figures[0].render_error.value(), std::sqrt(2e22), 1e5);
}

// Saturation is white whatever the readout noise.
TEST(Develop, WhatIsSaturatedIsShownAsWhite) {
  constexpr std::size_t kPixels = 200;
  Image film = counting_film();
  film.width = kPixels;
  film.channels.clear();
  for (const char* name : {"R", "G", "B"}) {
    film.channels.push_back({name, std::vector<float>(kPixels, 1e14F)});
    film.metadata[std::string("channel.") + name] = film.metadata["channel.V"];
  }
  film.metadata["sensor_channels"] = "R,G,B";
  film.metadata["to_xyz_d65"] = "1 0 0 0 1 0 0 0 1";
  film.metadata["sensor"] =
      R"({"readout": {"gain_e_per_dn": 1, "bits": 12, "full_well_e": 1000, "read_noise_e": 20}})";
  const ExposedFilm saturated = exposed({}, film);
  const Image shown = display_planes(saturated.sensor, develop(saturated, 7).calibrated);
  for (const ImageChannel& plane : shown.channels)
    EXPECT_EQ(plane.values, std::vector<float>(kPixels, plane.values[0])) << plane.name;
}

// A third of the pixels is white light above saturation, a third orange light that saturates only red, a
// third grey. The orange is brighter in red than any neutral.
TEST(Develop, SaturatedWhiteIsWhiteBesideBrightColours) {
  constexpr std::size_t kPixels = 300;
  Image film = counting_film();
  film.width = kPixels;
  film.channels.clear();
  const std::array<std::array<float, 3>, 3> thirds{
      {{1e14F, 1e14F, 1e14F}, {1e14F, 4e12F, 1e12F}, {3e12F, 3e12F, 3e12F}}};
  for (std::size_t k = 0; k < 3; ++k) {
    ImageChannel plane{std::string(1, "RGB"[k]), {}};
    for (std::size_t i = 0; i < kPixels; ++i) plane.values.push_back(thirds[i / 100][k]);
    film.metadata["channel." + plane.name] = film.metadata["channel.V"];
    film.channels.push_back(std::move(plane));
  }
  film.metadata["sensor_channels"] = "R,G,B";
  film.metadata["to_xyz_d65"] = "0.85 -0.05 0.15 0.35 0.75 -0.1 0.05 -0.15 1.19";
  film.metadata["sensor"] = R"({"readout": {"gain_e_per_dn": 1, "bits": 12, "full_well_e": 1000}})";
  film.metadata.erase("display_exposure");
  const ExposedFilm shot = exposed({}, film);
  const Image planes = display_planes(shot.sensor, develop(shot, 7).calibrated);
  const double white = display_white(shot.sensor, planes);
  const Image picture = (*shot.sensor.display)(planes, 1 / white).image;
  for (const ImageChannel& plane : picture.channels) {
    EXPECT_NEAR(plane.values[50], 1, 2e-3) << plane.name;
    EXPECT_LE(plane.values[150], 1) << plane.name;
    EXPECT_LT(plane.values[250], 0.9) << plane.name;
  }
  EXPECT_EQ(picture.metadata.at("display_exposure"), fmt::format("{:.7g}", white));
  EXPECT_LT(white, 1 / shot.sensor.display->automatic_scale(planes)) << "which the orange decides";
}

TEST(Develop, AFrameOfNoSceneHasNoErrorOfARender) {
  ExposedFilm film = exposed();
  film.film.metadata["frame_mean_error"] = "0.001";
  replace_with_frame(film, DarkFrame{});
  EXPECT_FALSE(film.film.metadata.contains("frame_mean_error"));
}

TEST(Develop, AnEvenFrameTellsTheShareOfSaturationThatItHas) {
  ExposedFilm film = exposed();
  replace_with_frame(film, FlatFrame{0.25});
  const auto told = [&film] { return develop(film, 7).codes.metadata.at("frame"); };
  EXPECT_EQ(told(), "flat, 0.25 of saturation");
  Diagnostics diagnostics;
  expose_for(film, 0.02, diagnostics);
  EXPECT_EQ(told(), "flat, 0.5 of saturation") << "of twice the light";
  film.sensor.readout->gain_e_per_dn = 2;
  EXPECT_EQ(told(), "flat, 0.25 of saturation") << "of twice the electrons";
}

TEST(Develop, ABiasFrameDevelopsAgainInNoTime) {
  ExposedFilm bias = exposed();
  replace_with_frame(bias, BiasFrame{});
  const DevelopedFilm developed = develop(bias, 7);
  bias.film.metadata = developed.exposure.metadata;
  ExposedFilm again = exposed({}, bias.film);
  EXPECT_EQ(again.sensor.exposure_s, std::vector<double>{0});
  EXPECT_EQ(develop(again, 7).codes.channels[0].values, developed.codes.channels[0].values);
  Diagnostics diagnostics;
  EXPECT_THROW(expose_for(again, 1, diagnostics), Error);
  bias.film.metadata.erase("frame");
  EXPECT_THROW((void)exposed({}, bias.film), Error) << "a film of a scene has a time";
}

// Within six standard deviations of the dark current.
TEST(Develop, APixelOfAMosaicIsDarkForTheTimeOfItsOwnFilter) {
  ExposedFilm film = exposed({}, test::mosaic_film());
  const DevelopedFilm developed = develop(film, 7);
  const std::vector<float>& codes = developed.codes.find("raw")->values;
  EXPECT_NEAR(codes[0], 5e4, 6 * std::sqrt(5e4));
  EXPECT_NEAR(codes[1], 5e3, 6 * std::sqrt(5e3));
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_FLOAT_EQ(developed.calibrated.find("raw")->values[i],
                    (codes[i] - (i == 0 ? 5e4F : 5e3F)) / 1e-10F);
  EXPECT_DOUBLE_EQ(plane_figures(film.sensor, developed)[0].noise.dark_e, std::sqrt((5e4 + 5e3) / 2));
  Diagnostics diagnostics;
  expose_for(film, 1, diagnostics);
  EXPECT_EQ(film.sensor.exposure_s, (std::vector<double>{10, 1}));
  EXPECT_EQ(film.film.metadata.at("exposure_s.R"), "10");
}

TEST(Develop, BlackIsTheExpectedDarkSignal) {
  ExposedFilm film = exposed({{"/readout/offset_dn", "50"}, {"/readout/dark_e_per_s", "2500"}});
  const auto told = [&film] { return develop(film, 7).codes.metadata.at("black_level_dn"); };
  EXPECT_EQ(told(), "75");
  Diagnostics diagnostics;
  expose_for(film, 0.02, diagnostics);
  EXPECT_EQ(told(), "100");
  EXPECT_EQ(raw_picture(develop(film, 7), film.sensor).black_level_dn, 100);
  replace_with_frame(film, DarkFrame{});
  EXPECT_EQ(told(), "100");
  EXPECT_FALSE(unequal_dark_signals_warning(film.sensor));
  EXPECT_EQ(diagnostics.text(), "");
  replace_with_frame(film, BiasFrame{});
  EXPECT_EQ(told(), "50");
}

TEST(Develop, DarkSignalsThatDifferAreNotInTheBlackLevelAndWarnedOf) {
  const ExposedFilm film = exposed({{"/readout/offset_dn", "50"}}, test::mosaic_film());
  EXPECT_EQ(develop(film, 7).codes.metadata.at("black_level_dn"), "50");
  EXPECT_EQ(
      unequal_dark_signals_warning(film.sensor),
      "channels with different exposure times have different dark signals (5e+03 to 5e+04 DN): the black "
      "level of raw files does not include them");
  ExposedFilm cooled = film;
  cooled.sensor.readout->dark_e_per_s = 0;
  EXPECT_FALSE(unequal_dark_signals_warning(cooled.sensor));
}

// If all channels have the same exposure time, it is the film's, and the sensor's is not used.
TEST(Develop, ATimeIsThatOfAllChannelsWhereTheySayTheSame) {
  Image film = counting_film();
  film.metadata["exposure_s"] = "1";
  film.metadata["exposure_s.V"] = film.metadata["expTime"] = "2";
  for (const auto& [seconds, factor] : {std::pair{2.0, 1.0F}, std::pair{4.0, 2.0F}}) {
    ExposedFilm shot = exposed({}, film);
    Diagnostics diagnostics;
    expose_for(shot, seconds, diagnostics);
    EXPECT_EQ(common_exposure(shot.sensor), seconds);
    EXPECT_EQ(std::stod(shot.film.metadata.at("expTime")), seconds);
    EXPECT_EQ(std::stod(shot.film.metadata.at("exposure_s.V")), seconds);
    EXPECT_EQ(shot.film.find("V")->values[0], factor * film.find("V")->values[0]);
  }
}

TEST(Develop, AnotherTimeIsToldByAllThatTellOne) {
  Image film = test::mosaic_film();
  film.metadata["expTime"] = "0.002";
  film.metadata["exposure_s"] = "0.002";
  film.metadata["exposure_s.R"] = "0.02";
  film.metadata["sensor"] =
      R"({"exposure_s":0.002,"channels":{"R":{"filters":[],"exposure_s":0.02},"G":"bessell_V"},)"
      R"("shutter":{"open_s":1,"rise_s":0.001}})";
  ExposedFilm shot = exposed({}, film);
  Diagnostics diagnostics;
  expose_for(shot, 0.02, diagnostics);
  const std::map<std::string, std::string> told = develop(shot, 7).exposure.metadata;
  EXPECT_EQ(told.at("expTime"), "0.02");
  EXPECT_EQ(told.at("exposure_s"), "0.02");
  EXPECT_EQ(told.at("exposure_s.R"), "0.2");
  EXPECT_EQ(told.at("sensor"),
            R"({"exposure_s":0.02,"channels":{"R":{"filters":[],"exposure_s":0.2},"G":"bessell_V"},)"
            R"("shutter":{"open_s":1,"rise_s":0.01}})");
}

TEST(Develop, FilesTellWhatTheyAreShownBy) {
  Image film = counting_film();
  film.metadata["white"] = "sun";
  film.metadata["white_xy"] = "0.31272 0.32903";
  const DevelopedFilm own = develop(exposed({}, film), 7);
  EXPECT_EQ(own.exposure.metadata.at("white"), "sun");
  EXPECT_EQ(own.exposure.metadata.at("to_xyz_d65"), film.metadata.at("to_xyz_d65"));
  Diagnostics diagnostics;
  const Chromaticity a{0.44758, 0.40745};
  ExposedFilm asked{film, read_film_sensor(film, "a.exr", {}, {}, a, diagnostics).value()};
  asked.sensor.white_name = "A";
  asked.sensor.display_exposure = 5e12;
  const DevelopedFilm developed = develop(asked, 7);
  for (const Image* image : {&developed.exposure, &developed.codes, &developed.calibrated}) {
    EXPECT_EQ(image->metadata.at("white"), "A");
    EXPECT_EQ(recorded_white(*image), a);
    EXPECT_EQ(image->metadata.at("to_xyz_d65"), to_text(asked.sensor.display->to_xyz_d65()));
    EXPECT_EQ(std::stod(image->metadata.at("display_exposure")), 5e12);
  }
}

TEST(Develop, PartsTellTheUnitThatTheyHave) {
  const DevelopedFilm developed = develop(exposed(), 7);
  EXPECT_EQ(developed.exposure.metadata.at("channel.V"), "quantum, electrons per m^2");
  EXPECT_EQ(developed.electrons.metadata.at("channel.V"), "electrons per pixel");
  EXPECT_EQ(developed.codes.metadata.at("channel.V"), "digital numbers");
}

TEST(Develop, ThePreviewIsOfNoSensor) {
  Image film = counting_film();
  film.metadata["mosaic"] = film.metadata["mosaic_channels"] = "V";
  film.metadata["white"] = "sun";
  film.metadata["white_xy"] = "0.31272 0.32903";
  film.metadata["scene"] = "a.json";
  const ExposedFilm shot = exposed({}, film);
  const DevelopedFilm developed = develop(shot, 7);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "preview_parts.exr";
  write_parts(path, developed, display_planes(shot.sensor, developed.calibrated), shot.sensor);
  const ExrPart part = read_exr_parts(path).back();
  std::filesystem::remove(path);
  ASSERT_EQ(part.name, "preview");
  for (const char* key : {"channel.V", "sensor_channels", "sensor", "to_xyz_d65", "mosaic", "mosaic_channels",
                          "white", "white_xy", "exposure_s", "display_exposure"})
    EXPECT_FALSE(part.image.metadata.contains(key)) << key;
  EXPECT_EQ(part.image.metadata.at("scene"), "a.json");
}

std::string warned_of(const std::string& shutter, double seconds) {
  Image film = counting_film();
  film.metadata["sensor"] = R"({"exposure_s": 0.01, "shutter": )" + shutter + "}";
  ExposedFilm shot = exposed({}, film);
  Diagnostics diagnostics;
  expose_for(shot, seconds, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
  return diagnostics.text();
}

TEST(Develop, AnotherTimeThanAShutterThatTakesItsOwnIsWarnedOf) {
  const std::string warning =
      "--exposure-s: warning: motion blur remains that of the film's own exposure time of 0.01 s; the "
      "opening, closing and row delay of the shutter are scaled with the exposure time\n";
  for (const char* shape : {R"("rise_s": 0.002)", R"("fall_s": 0.002)", R"("row_delay_s": 0.0002)",
                            R"("transmission": [[0, 0], [1, 1]])"})
    EXPECT_EQ(warned_of(std::string("{") + shape + "}", 0.02), warning) << shape;
  EXPECT_EQ(warned_of(R"({"rise_s": 0.002})", 0.01), "");
  EXPECT_EQ(warned_of(R"({"open_s": 0.1, "rise_s": 0, "fall_s": 0.0, "row_delay_s": 0})", 0.02), "");
}

}  // namespace
}  // namespace abbe
