#include "develop/film_sensor.h"

#include <gtest/gtest.h>

#include "films.h"
#include "io/error.h"

namespace abbe {
namespace {

using test::counting_film;

std::optional<FilmSensor> sensor_of(const Image& film, const std::vector<Override>& overrides,
                                    Diagnostics& diagnostics) {
  return read_film_sensor(film, "a.exr", overrides, {}, {}, diagnostics);
}

TEST(FilmSensor, ArisesFromTheMetadata) {
  Diagnostics diagnostics;
  const auto sensor = sensor_of(counting_film(), {}, diagnostics);
  ASSERT_TRUE(sensor) << diagnostics.text();
  EXPECT_EQ(sensor->planes, std::vector<std::string>{"V"});
  EXPECT_EQ(sensor->channels, sensor->planes);
  EXPECT_EQ(sensor->exposure_s, std::vector<double>{0.01});
  EXPECT_EQ(sensor->gathering_area_m2, 1e-10);
  EXPECT_EQ(sensor->display_exposure, 8e12);
  ASSERT_TRUE(sensor->readout);
  EXPECT_EQ(sensor->readout->dark_e_per_s, 2);
  ASSERT_TRUE(sensor->display);
  EXPECT_DOUBLE_EQ(sensor->display->to_xyz_d65()[1][0], 1);
}

TEST(FilmSensor, OverridesReachTheReadOutAlone) {
  Diagnostics diagnostics;
  const auto sensor = sensor_of(counting_film(), {{"/readout/bits", "10"}}, diagnostics);
  ASSERT_TRUE(sensor) << diagnostics.text();
  EXPECT_EQ(sensor->readout->bits, 10);
  try {
    (void)sensor_of(counting_film(), {{"/exposure_s", "1"}}, diagnostics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::usage);
    EXPECT_STREQ(
        error.what(),
        "--set: the render has already used this value (got /exposure_s, allowed /readout and keys below it, "
        "/output/white)");
  }
}

TEST(FilmSensor, FaultsOfTheReadOutAreReportedWhereTheyStand) {
  Diagnostics diagnostics;
  EXPECT_FALSE(sensor_of(counting_film(), {{"/readout/bits", "17"}}, diagnostics));
  EXPECT_NE(diagnostics.text().find("/readout/bits"), std::string::npos) << diagnostics.text();
  EXPECT_NE(diagnostics.text().find("allowed [1, 16]"), std::string::npos) << diagnostics.text();
}

// A film of Stokes vectors displays its intensities. Its other planes cannot be read out.
TEST(FilmSensor, OfStokesVectorsCountsTheirIntensities) {
  Image film = counting_film();
  film.metadata["sensor_channels"] = "V,S1.V,S2.V,S3.V";
  film.metadata["sensor"] = "{}";
  Diagnostics diagnostics;
  const auto sensor = sensor_of(film, {}, diagnostics);
  ASSERT_TRUE(sensor) << diagnostics.text();
  EXPECT_EQ(sensor->planes.size(), 4U);
  EXPECT_EQ(sensor->channels, std::vector<std::string>{"V"});
  EXPECT_TRUE(sensor->display);
  film.metadata["sensor"] = counting_film().metadata["sensor"];
  try {
    (void)sensor_of(film, {}, diagnostics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    EXPECT_STREQ(error.what(), "a.exr: plane \"S3.V\" has signed values, not electrons to read out");
  }
}

TEST(FilmSensor, PlanesComeWithTheirVariance) {
  Image film = counting_film();
  Diagnostics diagnostics;
  const auto sensor = sensor_of(film, {}, diagnostics);
  require_planes(film, *sensor, "a.exr");
  film.channels.pop_back();
  try {
    require_planes(film, *sensor, "a.exr");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a.exr: has no channel \"Variance.V\"");
  }
}

}  // namespace
}  // namespace abbe
