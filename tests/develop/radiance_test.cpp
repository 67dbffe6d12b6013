#include "develop/radiance.h"

#include <gtest/gtest.h>

#include "io/error.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe {
namespace {

// One pixel of 1 W m^-2 sr^-1 in each of two bands, from 500 to 600 nm.
SpectralImage green() {
  return {1,
          1,
          {{525, {1}}, {575, {1}}},
          {},
          {{"seed", "7"}, {"channel.old", "gone"}, {"to_xyz_d65", "of the preview"}, {kAxisKey, "3"}}};
}

Channel band(const std::string& name, double from_nm, double to_nm) {
  Channel channel;
  channel.name = name;
  channel.weight = Curve({{from_nm, 0}, {from_nm, 1}, {to_nm, 1}, {to_nm, 0}});
  return channel;
}

TEST(Radiance, ASensorLooksThroughItsExposure) {
  Diagnostics diagnostics;
  const Image film =
      exposed_film(green(), {{band("V", 510, 590)}, {}, {0.5}, {{"exposure_s", "1"}}}, "a.exr", diagnostics);
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  EXPECT_NEAR(film.find("V")->values[0], 80.0 / 50 * 0.5, 1e-6);
  EXPECT_EQ(film.metadata, (std::map<std::string, std::string>{
                               {"exposure_s", "1"}, {"frame_mean_error", "inf"}, {"seed", "7"}}));
}

// Otherwise the sensor's pictures would be scaled by candelas, and its raw files would record a lens that it
// does not have.
TEST(Radiance, AFilmTellsOfItsOwnSensorAlone) {
  SpectralImage image = green();
  for (const char* key :
       {"aperture", "display_exposure", "electrons_per_lx_s", "exposure_s", "exposure_s.old", "expTime",
        "gathering_area_m2", "isoSpeed", "mosaic", "sensor", "white", "white_xy", "whiteLuminance"})
    image.metadata[key] = "of the old one";
  image.metadata["lights_xy"] = "of the lights";
  Diagnostics diagnostics;
  const RadianceSensor sensor{{band("V", 510, 590)}, {}, {0.5}, {{"exposure_s", "1"}, {"white", "sun"}}};
  EXPECT_EQ(exposed_film(image, sensor, "a.exr", diagnostics).metadata,
            (std::map<std::string, std::string>{{"exposure_s", "1"},
                                                {"frame_mean_error", "inf"},
                                                {"lights_xy", "of the lights"},
                                                {"seed", "7"},
                                                {"white", "sun"}}));
}

// The recorded error of the film is that of its bands, not of a sensor exposed to them.
TEST(Radiance, TheErrorOfABandIsNoSensors) {
  SpectralImage bands = green();
  for (const SpectralBand& of : green().bands)
    bands.others.push_back({variance_of(spectral_channel(of.center_nm)), {0.01F}});
  for (const auto& [told, left] : {std::pair{"0.01", false}, std::pair{"inf", true}}) {
    bands.metadata["frame_mean_error"] = told;
    Diagnostics diagnostics;
    const Image film = exposed_film(bands, {{band("V", 510, 590)}, {}, {0.5}, {}}, "a.exr", diagnostics);
    EXPECT_EQ(film.metadata.contains("frame_mean_error"), left) << told;
    EXPECT_EQ(has_unknown_error(film.metadata), left) << told;
  }
}

TEST(Radiance, LightThatTheImageLacksIsToldOrRefused) {
  Diagnostics diagnostics;
  (void)exposed_film(green(), {{band("V", 550, 650)}, {}, {1}, {}}, "a.exr", diagnostics);
  EXPECT_EQ(
      diagnostics.text(),
      "a.exr: warning: covers only 500 to 600 nm, but 50 % of the response of channel \"V\" lies outside\n");
  try {
    (void)exposed_film(green(), {{band("V", 650, 700)}, {}, {1}, {}}, "a.exr", diagnostics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
  }
}

TEST(Radiance, TheEyeSeesGreen) {
  const ExposedFilm film = observed_film(green(), "a.exr", {}, {});
  EXPECT_EQ(film.sensor.planes, (std::vector<std::string>{"R", "G", "B"}));
  const auto value = [&](const char* name) { return film.film.find(name)->values[0]; };
  EXPECT_GT(value("G"), value("R"));
  EXPECT_LT(value("B"), 0);  // outside the gamut
}

TEST(Radiance, TheEyeIsShownWhatTheFilmTells) {
  SpectralImage image = green();
  image.metadata.insert({{"display_exposure", "300"}, {"white", "A"}, {"white_xy", "0.44758 0.40745"}});
  const FilmSensor told = observed_film(image, "a.exr", {}, {}).sensor;
  EXPECT_EQ(told.display_exposure, 300);
  EXPECT_EQ(told.white, (Chromaticity{0.44758, 0.40745}));
  EXPECT_EQ(observed_film(image, "a.exr", {}, kD65).sensor.white, kD65);
  EXPECT_EQ(observed_film(green(), "a.exr", {}, {}).sensor.display_exposure, std::nullopt);
  image.metadata["display_exposure"] = "bright";
  try {
    (void)observed_film(image, "a.exr", {}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    EXPECT_STREQ(error.what(), "a.exr: attribute \"display_exposure\" makes no sense (got \"bright\")");
  }
}

}  // namespace
}  // namespace abbe
