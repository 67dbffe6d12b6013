#include "calibration/output/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "calibration/chart/delta_e.h"
#include "calibration/output/color_spaces.h"
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
  std::size_t outside = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::array<double, 3> expected = multiply(to_srgb, pixels[i]);
    bool clipped = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const double code = srgb_code(kScale * expected[k]);
      clipped = clipped || code < -1e-5 || code > 1 + 1e-5;
      EXPECT_NEAR(pixel(picture, i)[k], std::clamp(code, 0.0, 1.0), 1e-5)
          << testing::PrintToString(pixels[i]);
    }
    outside += clipped ? 1U : 0U;
  }
  EXPECT_NEAR(picture.clipped_share, static_cast<double>(outside) / static_cast<double>(pixels.size()), 1e-3);
  EXPECT_GT(outside, 100U);
}

TEST(Display, WhiteStaysWhiteUnderAnyLight) {
  for (const char* light : {"A", "D50", "D65", "FL2"}) {
    const Curve illuminant = test::illuminant(light);
    for (const std::vector<Channel>& channels : {test::camera(), observer_channels(Observer::cie1931)}) {
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
  EXPECT_FALSE(observer.fit().has_value());
  EXPECT_TRUE(observer.to_xyz_d65().equalWithAbsError(Matrix3(), 5e-4));
  const DisplayTransform camera = make_display(test::camera(), test::illuminant("D65"));
  ASSERT_TRUE(camera.fit().has_value());
  EXPECT_LT(camera.fit()->errors.mean, 1);
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
  std::vector<std::array<double, 3>> pixels;
  for (const Patch& patch : test::chart().patches) {
    const std::vector<double> raw = camera_raw(camera, light, patch.reflectance);
    pixels.push_back({raw[0], raw[1], raw[2]});
  }
  const DisplayPicture picture = display(film_of({"R", "G", "B"}, pixels), 1.0);
  EXPECT_EQ(picture.clipped_share, 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::array<double, 3> linear = pixel(picture, i);
    for (double& v : linear) v = srgb_linear(v);
    const Lab shown = xyz_to_lab(multiply(rgb_to_xyz(kRec709), linear), unit_xyz(kD65));
    const Lab truth = xyz_to_lab(colors.xyz[i], colors.white);
    EXPECT_NEAR(delta_e_2000(truth, shown), display.fit()->errors.delta_e[i], 0.01) << colors.names[i];
  }
}

TEST(Display, OneChannelIsGrey) {
  const DisplayTransform display = make_display(test::camera("kodak_kaf-3200me"), test::illuminant("A"));
  const DisplayPicture picture = display(film_of({"QE"}, {{0.5}, {1}, {2}}), 0.5);
  ASSERT_EQ(picture.image.channels.size(), 1U);
  EXPECT_NEAR(picture.image.channels[0].values[0], srgb_code(0.25), 2e-6);
  EXPECT_NEAR(picture.image.channels[0].values[2], 1, 2e-6);
  EXPECT_EQ(picture.clipped_share, 0);
}

TEST(Display, ScalesTheNinetyNinthPercentileToOne) {
  std::vector<std::array<double, 3>> pixels;
  for (int i = 0; i <= 1000; ++i) pixels.push_back({1.0 * i, 1.0 * i, 1.0 * i});
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  EXPECT_NEAR(display.automatic_scale(film_of({"X", "Y", "Z"}, pixels)), 1 / 990.0, 1e-9);
  EXPECT_EQ(display(film_of({"X", "Y", "Z"}, pixels)).scale,
            display.automatic_scale(film_of({"X", "Y", "Z"}, pixels)));
  std::vector<std::array<double, 3>> spark(1000, {0, 0, 0});
  EXPECT_EQ(display.automatic_scale(film_of({"X", "Y", "Z"}, spark)), 1);
  spark[3] = {1, 4, 1};
  EXPECT_EQ(display.automatic_scale(film_of({"X", "Y", "Z"}, spark)), 0.25);
}

TEST(Display, NotANumberIsBlackAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  const DisplayPicture picture = display(film_of({"X", "Y", "Z"}, {{nan, nan, nan}, {0.1, 0.1, 0.1}}), 1.0);
  EXPECT_EQ(pixel(picture, 0), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(picture.clipped_share, 0.5);
}

TEST(Display, DoesNotMindTheUsersOwnConfiguration) {
  ASSERT_EQ(setenv("OCIO_ACTIVE_DISPLAYS", "elsewhere", 1), 0);
  ASSERT_EQ(setenv("OCIO", "/nowhere/config.ocio", 1), 0);
  const DisplayTransform display({"X", "Y", "Z"}, Matrix3());
  EXPECT_NEAR(pixel(display(film_of({"X", "Y", "Z"}, {unit_xyz(kD65)}), 1.0), 0)[1], 1, 2e-6);
  unsetenv("OCIO_ACTIVE_DISPLAYS");
  unsetenv("OCIO");
}

TEST(Display, RefusesWhatItCannotShow) {
  const Curve light = test::illuminant("D65");
  const std::vector<Channel> two(2, energy_channel("G", band(500, 600)));
  test::expect_error([&] { static_cast<void>(make_display(two, light)); }, ErrorCode::usage,
                     "one or three channels (got 2)");
  const DisplayTransform display({"R", "G", "B"}, Matrix3());
  test::expect_error(
      [&] {
        static_cast<void>(display(film_of({"R", "G"}, {{0.5, 0.5}})));
      },
      ErrorCode::input, "has no complete channel B");
}

}  // namespace
}  // namespace abbe
