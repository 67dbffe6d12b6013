#include "develop/raw_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/output/camera_profile.h"
#include "spectral/library.h"
#include "spectral/rgb.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

const Matrix3 kFromXyz(1.1, -0.3, -0.1, -0.4, 1.2, 0.2, 0.05, -0.1, 0.9);

Curve light(const std::string& name) {
  Diagnostics diagnostics;
  return load_illuminant(name, {}, diagnostics).value().curve;
}

// A camera whose responses are the observer's, mixed by `kFromXyz`, so that this is the color matrix of its
// DNG.
std::vector<Channel> mixed_observer() {
  const std::vector<Channel> xyz = observer_channels(Observer::cie1931);
  std::vector<Channel> camera;
  for (int i = 0; i < 3; ++i) {
    Curve weight = scaled(xyz[0].weight, kFromXyz[i][0]);
    for (int j = 1; j < 3; ++j)
      weight = sum(weight, scaled(xyz[static_cast<std::size_t>(j)].weight, kFromXyz[i][j]));
    camera.push_back(energy_channel(std::string(1, "RGB"[i]), weight));
  }
  return camera;
}

RawPicture picture_in(const Curve& lamp, const Chromaticity& white) {
  FilmSensor sensor;
  sensor.planes = sensor.channels = {"R", "G", "B"};
  sensor.readout = Readout{};
  sensor.white = white;
  sensor.display = make_display(mixed_observer(), lamp, {}, white);
  DevelopedFilm developed;
  developed.codes = {1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}};
  return raw_picture(developed, sensor);
}

std::array<double, 3> row_of(const std::array<double, 9>& rows, std::size_t i) {
  return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
}
std::array<double, 3> times(const std::array<double, 9>& rows, const std::array<double, 3>& x) {
  std::array<double, 3> y{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) y[i] += row_of(rows, i)[k] * x[k];
  return y;
}

TEST(RawPicture, TellsTheCameraInTheFilmsOwnLight) {
  for (const auto& [name, number] : {std::pair{"A", 17}, {"D65", 21}, {"FL11", 14}, {"LED-B3", 255}}) {
    const Curve lamp = light(name);
    const RawPicture raw = picture_in(lamp, chromaticity(lamp));
    ASSERT_EQ(raw.lights.size(), 1U) << name;
    EXPECT_EQ(raw.lights[0].illuminant, number) << name;
    const XYZ white = unit_xyz(chromaticity(lamp));
    const std::array<double, 3> neutral = multiply(kFromXyz, white);
    const double most = *std::max_element(neutral.begin(), neutral.end());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(raw.neutral.value()[i], neutral[i] / most, 1e-4) << name;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(row_of(raw.lights[0].color, i)[k],
                    kFromXyz[static_cast<int>(i)][static_cast<int>(k)] / most, 1e-3)
            << name << ' ' << i << ' ' << k;
    }
    const std::array<double, 3> to_white = times(raw.lights[0].forward, {1, 1, 1});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(to_white[i], dng_white()[i], 1e-4) << name;
  }
}

// Adaptation to a spectral line is impossible: its light is displayed and recorded as under daylight.
TEST(RawPicture, TellsDaylightWhereNoEyeAdapts) {
  const Chromaticity sodium = chromaticity(lines(std::vector<SpectralLine>{{589.3, 1, 1}}));
  const RawPicture raw = picture_in(light("D65"), sodium);
  ASSERT_EQ(raw.lights.size(), 1U);
  EXPECT_EQ(raw.lights[0].illuminant, 21);
  const std::array<double, 3> neutral = times(raw.lights[0].color, unit_xyz(kD65));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(raw.neutral.value()[i], neutral[i], 1e-12);
}

TEST(RawPicture, MatricesOfACalibrationTakeTheirPlace) {
  FilmSensor sensor;
  sensor.planes = sensor.channels = {"R", "G", "B"};
  sensor.readout = Readout{};
  sensor.white = kD65;
  sensor.display = DisplayTransform(sensor.channels, kFromXyz.inverse(true));
  sensor.lights = {{17, {}, {}}, {21, {}, {}}};
  DevelopedFilm developed;
  developed.codes = {1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}};
  const RawPicture raw = raw_picture(developed, sensor);
  ASSERT_EQ(raw.lights.size(), 2U);
  EXPECT_EQ(raw.lights[0].illuminant, 17);
  EXPECT_TRUE(raw.neutral);
}

// A raw file records a single exposure time.
TEST(RawPicture, TellsTheExposureOfAllChannelsAlone) {
  FilmSensor sensor;
  sensor.planes = sensor.channels = {"R", "G"};
  sensor.readout = Readout{};
  DevelopedFilm developed;
  developed.codes = {1, 1, {{"R", {1}}, {"G", {1}}}, {}};
  sensor.shared_exposure_s = 0.5;
  sensor.exposure_s = {5, 5};
  EXPECT_EQ(raw_picture(developed, sensor).exposure_s, 5);
  sensor.exposure_s = {5, 0.5};
  EXPECT_FALSE(raw_picture(developed, sensor).exposure_s);
}

}  // namespace
}  // namespace abbe
