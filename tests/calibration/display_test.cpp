#include "calibration/output/display.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "calibration/chart/delta_e.h"
#include "calibration/output/color_spaces.h"
#include "calibration/output/ocio.h"
#include "sensor/film/crop.h"
#include "spectral/rgb.h"
#include "spectral/sources.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

double srgb_linear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double srgb_code(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Image film_of(const std::vector<std::string>& names, const std::vector<std::array<double, 3>>& pixels) {
  Image film{static_cast<int>(pixels.size()), 1, {}, {}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    film.channels.push_back({names[k], {}});
    for (const auto& pixel : pixels) film.channels.back().values.push_back(static_cast<float>(pixel[k]));
  }
  return film;
}

std::array<double, 3> pixel(const DisplayPicture& picture, std::size_t i) {
  std::array<double, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) rgb[k] = picture.image.channels.at(k).values.at(i);
  return rgb;
}

TEST(Display, AgreesWithDoublePrecision) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> value(-0.4, 1.4);
  std::vector<std::array<double, 3>> pixels(4000);
  for (auto& p : pixels) p = {value(random), value(random), value(random)};
  pixels.push_back({0.00532, 0.00075, -0.00293});
  const Matrix3 m(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  const DisplayTransform display({"R", "G", "B"}, m);
  constexpr double kScale = 0.75;
  const DisplayPicture picture = display(film_of({"R", "G", "B"}, pixels), kScale);
  const Matrix3 to_srgb = rgb_to_xyz(kRec709).inverse() * m;
  const Gamut gamut(kRec709, 1);
  std::size_t outside = 0;
  std::size_t too_bright = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::array<double, 3> linear{};
    for (std::size_t k = 0; k < 3; ++k)
      linear[k] = kScale * static_cast<double>(static_cast<float>(pixels[i][k]));
    const MappedColor mapped = map_into(gamut, multiply(to_srgb, linear));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(pixel(picture, i)[k], srgb_code(mapped.rgb[k]), 1e-5) << testing::PrintToString(pixels[i]);
    outside += mapped.outside ? 1U : 0U;
    too_bright += mapped.too_bright ? 1U : 0U;
    EXPECT_EQ(picture.outside.channels.at(0).values[i], mapped.outside ? 1 : 0);
  }
  EXPECT_NEAR(picture.outside_fraction, static_cast<double>(outside) / static_cast<double>(pixels.size()),
              1e-12);
  EXPECT_NEAR(picture.clipped_fraction, static_cast<double>(too_bright) / static_cast<double>(pixels.size()),
              1e-3);
  EXPECT_GT(outside, 100U);
  EXPECT_GT(too_bright, 100U);
}

TEST(Display, WhiteStaysWhiteUnderAnyLight) {
  for (const char* light : {"A", "D50", "D65", "FL2", "FL11"}) {
    const Curve illuminant = test::illuminant(light);
    for (const std::vector<Channel>& channels :
         {test::camera(), observer_channels(Observer::cie1931), observer_channels(Observer::cie1964)}) {
      const DisplayTransform display = make_display(channels, illuminant);
      const std::vector<double> white = diffuser_values(channels, illuminant);
      const std::vector<std::string> names{channels[0].name, channels[1].name, channels[2].name};
      std::vector<std::array<double, 3>> ramp;
      for (const double grey : {1.0, 0.5, 0.18, 0.01})
        ramp.push_back({grey * white[0] / white[1], grey, grey * white[2] / white[1]});
      const DisplayPicture picture = display(film_of(names, ramp), 1.0);
      for (std::size_t i = 0; i < ramp.size(); ++i)
        for (const double code : pixel(picture, i)) EXPECT_NEAR(code, srgb_code(ramp[i][1]), 2e-6) << light;
    }
  }
}

TEST(Display, ObserverIsNotFitted) {
  const DisplayTransform observer =
      make_display(observer_channels(Observer::cie1931), test::illuminant("D65"));
  EXPECT_TRUE(observer.to_xyz_d65().equalWithAbsError(Matrix3(), 5e-4));
}

TEST(Display, ALampWithoutAWhiteIsShownAsItLooks) {
  for (const double nm : {589.0, 900.0}) {
    const DisplayTransform display =
        make_display(observer_channels(Observer::cie1931), lines(std::vector<SpectralLine>{{nm, 1, 1}}));
    EXPECT_EQ(display.to_xyz_d65(), Matrix3()) << nm;
  }
}

TEST(Display, ShowsTheChartAsWellAsTheFitSays) {
  const Curve light = test::illuminant("D65");
  const std::vector<Channel> camera = test::camera();
  const DisplayTransform display = make_display(camera, light);
  const PatchColors colors = integrate(test::chart(), camera, light);
  const PatchErrors errors = fit_correction(colors).errors;
  EXPECT_LT(errors.mean, 1);
  std::vector<std::array<double, 3>> pixels;
  for (const Patch& patch : test::chart().patches) {
    const std::vector<double> raw = camera_raw(camera, light, patch.reflectance);
    pixels.push_back({raw[0], raw[1], raw[2]});
  }
  const DisplayPicture picture = display(film_of({"R", "G", "B"}, pixels), 1.0);
  EXPECT_EQ(picture.clipped_fraction, 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::array<double, 3> linear = pixel(picture, i);
    for (double& v : linear) v = srgb_linear(v);
    const Lab shown = xyz_to_lab(multiply(rgb_to_xyz(kRec709), linear), unit_xyz(kD65));
    const Lab truth = xyz_to_lab(colors.xyz[i], colors.white);
    EXPECT_NEAR(delta_e_2000(truth, shown), errors.delta_e[i], 0.01) << colors.names[i];
  }
}

TEST(Display, OneChannelIsGrey) {
  const DisplayTransform display = make_display(test::camera("kodak_kaf-3200me"), test::illuminant("A"));
  const DisplayPicture picture = display(film_of({"QE"}, {{0.5}, {1}, {2}}), 0.5);
  ASSERT_EQ(picture.image.channels.size(), 1U);
  EXPECT_NEAR(picture.image.channels[0].values[0], srgb_code(0.25), 2e-6);
  EXPECT_NEAR(picture.image.channels[0].values[2], 1, 2e-6);
  EXPECT_EQ(picture.clipped_fraction, 0);
}

TEST(Display, ScalesTheNinetyNinthPercentileToOne) {
  const XYZ white = unit_xyz(kD65);
  std::vector<std::array<double, 3>> pixels;
  for (int i = 0; i <= 1000; ++i) pixels.push_back({i * white[0], i * white[1], i * white[2]});
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  EXPECT_NEAR(display.automatic_scale(film_of({"X", "Y", "Z"}, pixels)), 1 / 990.0, 1e-9);
  EXPECT_EQ(display(film_of({"X", "Y", "Z"}, pixels)).scale,
            display.automatic_scale(film_of({"X", "Y", "Z"}, pixels)));
  std::vector<std::array<double, 3>> spark(1000, {0, 0, 0});
  EXPECT_EQ(display.automatic_scale(film_of({"X", "Y", "Z"}, spark)), 1);
  spark[3] = {4 * white[0], 4 * white[1], 4 * white[2]};
  EXPECT_NEAR(display.automatic_scale(film_of({"X", "Y", "Z"}, spark)), 0.25, 1e-7);
}

// A colour inside both Rec.709 and AP1, but with another brightest primary in each.
TEST(Display, TheAutomaticScaleIsThatOfEveryView) {
  const Image film = film_of({"X", "Y", "Z"}, {{0.6, 0.4, 0.1}, {0.3, 0.3, 0.3}});
  const DisplayTransform plain({"X", "Y", "Z"}, Matrix3());
  for (const ViewOptions& view : {ViewOptions{{}, kSrgbDisplay, kAcesView}, ViewOptions{{}, kP3Display, ""}})
    EXPECT_EQ(DisplayTransform({"X", "Y", "Z"}, Matrix3(), view).automatic_scale(film),
              plain.automatic_scale(film))
        << view.display << ' ' << view.view;
}

TEST(Display, WhatAFilmHasNotIsNeitherExposedForNorCounted) {
  const XYZ white = unit_xyz(kD65);
  Image film = film_of({"X", "Y", "Z"}, std::vector<std::array<double, 3>>(1000, {0, 0, 0}));
  for (const std::size_t lit : {3U, 4U, 900U})
    for (std::size_t k = 0; k < 3; ++k) film.channels[k].values[lit] = static_cast<float>(4 * white.at(k));
  film.channels[0].values[4] *= 2;
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  film.metadata[kCropKey] = "3,0,901,1";
  film.metadata[kAreasKey] = "3,0,5,1=0:8 900,0,901,1=0:8";
  EXPECT_EQ(recorded_pixels(film), (std::vector<std::size_t>{3, 4, 900}));
  EXPECT_NEAR(display.automatic_scale(film), 0.25, 1e-7);
  EXPECT_NEAR(display(film, 1).clipped_fraction, 1, 1e-12);
}

TEST(Display, SaturatedColoursAreExposedSoThatTheyFit) {
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  for (const std::array<double, 3>& rgb : {std::array{0.0, 0.0, 1.0}, {0.3, 1.0, -0.2}, {1.0, -0.1, 0.0}}) {
    const std::vector<std::array<double, 3>> pixels(100, multiply(rgb_to_xyz(kRec709), rgb));
    const DisplayPicture picture = display(film_of({"X", "Y", "Z"}, pixels));
    EXPECT_EQ(picture.clipped_fraction, 0);
    const auto code = pixel(picture, 0);
    EXPECT_NEAR(*std::max_element(code.begin(), code.end()), 1, 1e-5);
  }
}

TEST(Display, NotANumberIsBlackAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  const DisplayPicture picture = display(film_of({"X", "Y", "Z"}, {{nan, nan, nan}, {0.1, 0.1, 0.1}}), 1.0);
  EXPECT_EQ(pixel(picture, 0), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(picture.clipped_fraction, 0.5);
}

TEST(Display, OwnConfigurationDoesNotMindTheUsersOne) {
  ASSERT_EQ(setenv("OCIO_ACTIVE_DISPLAYS", "elsewhere", 1), 0);
  ASSERT_EQ(setenv("OCIO_ACTIVE_VIEWS", "another", 1), 0);
  ASSERT_EQ(setenv("OCIO", "/nowhere/config.ocio", 1), 0);
  EXPECT_EQ(users_configuration(), "/nowhere/config.ocio");
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  EXPECT_NEAR(pixel(display(film_of({"X", "Y", "Z"}, {unit_xyz(kD65)}), 1.0), 0)[1], 1, 2e-6);
  unsetenv("OCIO_ACTIVE_DISPLAYS");
  unsetenv("OCIO_ACTIVE_VIEWS");
  unsetenv("OCIO");
  EXPECT_EQ(users_configuration(), "");
}

TEST(Display, ShowsThroughTheViewAskedFor) {
  const Image grey = film_of({"X", "Y", "Z"}, {unit_xyz(kD65)});
  const auto code = [&](const ViewOptions& options) {
    const DisplayTransform display({"X", "Y", "Z"}, Matrix3(), options);
    return pixel(display(grey, 0.18), 0)[1];
  };
  EXPECT_NEAR(code({}), srgb_code(0.18), 2e-6);
  EXPECT_NEAR(code({"", kRec1886Display, kPlainView}), std::pow(0.18, 1 / 2.4), 2e-6);
  EXPECT_NEAR(code({"", kP3Display, ""}), std::pow(0.18, 1 / 2.6), 2e-6);
  EXPECT_NEAR(std::pow(code({"", kRec1886Display, kAcesView}), 2.4), 0.104, 1e-3);
  // A tone-mapping view receives values brighter than white.
  const Image bright = film_of({"X", "Y", "Z"}, {unit_xyz(kD65)});
  const DisplayTransform aces({"X", "Y", "Z"}, Matrix3(), {"", "", kAcesView});
  EXPECT_GT(pixel(aces(bright, 4.0), 0)[1], pixel(aces(bright, 1.0), 0)[1] + 0.05);
  test::expect_error(
      [&] {
        code({"", "paper", ""});
      },
      ErrorCode::usage, "--screen: got paper, allowed sRGB - Display, ");
  test::expect_error(
      [&] {
        code({"", "", "film"});
      },
      ErrorCode::usage, "--view: got film, allowed Un-tone-mapped, ");
}

TEST(Display, PicturesTellHowTheirCodesAreRead) {
  const XYZ shown{0.25, 0.3, 0.2};
  const Image film = film_of({"X", "Y", "Z"}, {shown});
  for (const char* screen : {kSrgbDisplay, kRec1886Display, kP3Display}) {
    const DisplayPicture picture = DisplayTransform({"X", "Y", "Z"}, Matrix3(), {"", screen, ""})(film, 1.0);
    const auto encoding = recorded_encoding(picture.image);
    const auto space = recorded_primaries(picture.image);
    ASSERT_TRUE(encoding && space) << screen;
    std::array<double, 3> rgb = pixel(picture, 0);
    for (double& value : rgb) value = encoding->decoded(value);
    const XYZ read = multiply(rgb_to_xyz(*space), rgb);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(read[i], shown[i], 1e-5) << screen << i;
  }
}

TEST(Display, P3ShowsColoursThatSrgbCannot) {
  const XYZ green = multiply(rgb_to_xyz(kP3D65), {0, 1, 0});
  const Image film = film_of({"X", "Y", "Z"}, {green});
  const DisplayTransform p3({"X", "Y", "Z"}, Matrix3(), {"", kP3Display, ""});
  const DisplayTransform srgb({"X", "Y", "Z"}, Matrix3());
  EXPECT_EQ(p3(film, 1.0).outside_fraction, 0);
  EXPECT_EQ(srgb(film, 1.0).outside_fraction, 1);
  EXPECT_NEAR(pixel(p3(film, 1.0), 0)[1], 1, 1e-5);
}

TEST(Display, UsesAUsersConfigurationThatKnowsAces) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("abbe_users_ocio_" + std::to_string(::getpid()));
  write_ocio_config(folder, {});
  const Image grey = film_of({"X", "Y", "Z"}, {unit_xyz(kD65)});
  const DisplayTransform own({"X", "Y", "Z"}, Matrix3(), {folder / "config.ocio", "", ""});
  EXPECT_NEAR(pixel(own(grey, 0.18), 0)[1], srgb_code(0.18), 2e-6);
  EXPECT_FALSE(recorded_encoding(own(grey, 0.18).image)) << "of which the configuration says nothing";
  const auto refuse = [&](const std::string& text, const std::string& complaint) {
    std::ofstream(folder / "bad.ocio") << text;
    test::expect_error(
        [&] {
          static_cast<void>(DisplayTransform({"X", "Y", "Z"}, Matrix3(), {folder / "bad.ocio", "", ""}));
        },
        ErrorCode::input, complaint);
  };
  refuse("no configuration", "OpenColorIO: ");
  refuse(
      "ocio_profile_version: 1\nroles:\n  default: raw\ndisplays:\n  screen:\n    - !<View> {name: Raw, "
      "colorspace: raw}\ncolorspaces:\n  - !<ColorSpace>\n    name: raw\n    isdata: true\n",
      "has neither the role aces_interchange nor a colour space ACES2065-1");
  std::filesystem::remove_all(folder);
}

// Nearly monochromatic sodium light: the small differences between channels exceed rounding.
TEST(Display, ShowsTheLightOfALine) {
  const Curve line({{589, 0}, {589, 1}, {590, 1}, {590, 0}});
  const DisplayTransform display = make_display(test::camera(), line);
  const Matrix3 to_xyz = display.to_xyz_d65();
  const PatchColors patches = integrate(test::chart(), test::camera(), line);
  for (std::size_t i = 0; i < patches.raw.size(); ++i) EXPECT_GT(multiply(to_xyz, patches.raw[i])[1], 0) << i;
}

TEST(Display, RefusesWhatItCannotShow) {
  const Curve light = test::illuminant("D65");
  const std::vector<Channel> two(2, energy_channel("G", band(500, 600)));
  test::expect_error([&] { static_cast<void>(make_display(two, light)); }, ErrorCode::usage,
                     "one or three channels (got 2)");
  for (const double from_nm : {500.0, 790.0}) {  // all alike, the second time in the infrared
    std::vector<Channel> blind;
    for (const char* name : {"a", "b", "c"}) blind.push_back(energy_channel(name, band(from_nm, 800)));
    test::expect_error([&] { static_cast<void>(make_display(blind, light)); }, ErrorCode::usage,
                       "display: in its light, channels a, b, c do not distinguish colours between 360 and "
                       "830 nm, so no colour picture can be made of them: ");
  }
  const DisplayTransform display({"R", "G", "B"}, Matrix3());
  test::expect_error(
      [&] {
        static_cast<void>(display(film_of({"R", "G"}, {{0.5, 0.5}})));
      },
      ErrorCode::input, "has no complete channel B");
}

}  // namespace
}  // namespace abbe
