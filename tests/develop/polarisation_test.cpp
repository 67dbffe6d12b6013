#include "develop/polarisation.h"

#include <gtest/gtest.h>

#include "io/error.h"
#include "io/spectral_exr.h"
#include "sensor/film/feature_film.h"
#include "sensor/film/film_planes.h"

namespace abbe {
namespace {

// Red light is polarised vertically; green light is twice as strong and polarised horizontally.
Image colours() {
  Image film{1, 1, {}, {{"sensor_channels", "R,G,B,S1.R,S1.G,S1.B,S2.R,S2.G,S2.B,S3.R,S3.G,S3.B"}}};
  for (const char* name :
       {"R", "G", "B", "S1.R", "S1.G", "S1.B", "S2.R", "S2.G", "S2.B", "S3.R", "S3.G", "S3.B"})
    film.channels.push_back({name, {0}});
  film.channels[0].values = {1};
  film.channels[1].values = {2};
  film.channels[3].values = {-1};
  film.channels[4].values = {2};
  return film;
}

TEST(PolarisationOfFilms, TellsEachChannel) {
  const Image told = polarisation_image(colours());
  ASSERT_EQ(told.channels.size(), 9U);
  EXPECT_EQ(told.find("DoP.R")->values[0], 1);
  EXPECT_EQ(told.find("DoLP.G")->values[0], 1);
  EXPECT_EQ(told.find("AoLP.R")->values[0], 90);
  EXPECT_EQ(told.find("AoLP.G")->values[0], 0);
  EXPECT_EQ(told.find("DoP.B")->values[0], 0) << "no light";
  EXPECT_FALSE(told.metadata.contains("sensor_channels"));
}

TEST(PolarisationOfFilms, HasNeitherLayersNorFeatures) {
  Image film = colours();
  film.metadata.insert({{kLayersKey, "light.key"}, {kFeaturesKey, "id"}, {kShapeNamesKey, R"(["ball"])"}});
  const Image told = polarisation_image(film);
  for (const char* key : {kLayersKey, kFeaturesKey, kShapeNamesKey})
    EXPECT_FALSE(told.metadata.contains(key)) << key;
}

TEST(PolarisationOfFilms, WeighsChannelsAsTheEyeDoes) {
  Image film = colours();
  EXPECT_NEAR(polarisation_of_light(film).at(0).degree, 1.0 / 3, 1e-12);
  film.metadata["to_xyz_d65"] = "1 0 0 3 1 1 0 0 1";
  const PolarisationFigures seen = polarisation_of_light(film).at(0);
  EXPECT_NEAR(seen.degree, 1.0 / 5, 1e-12);
  EXPECT_EQ(seen.angle_deg, 90);
}

// Two of the four bands are visible.
TEST(PolarisationOfFilms, LooksAtRadiances) {
  SpectralImage image{1, 1, {{500, {1}}, {600, {1}}, {1060, {100}}, {1080, {100}}}, {}, {}};
  for (std::size_t i = 0; i < 3; ++i)
    for (const SpectralBand& band : image.bands)
      image.polarised.at(i).push_back({band.center_nm, {i == 1 ? (band.center_nm < 700 ? -0.5F : 100) : 0}});
  const Image film = spectral_layout(image);
  const PolarisationFigures seen = polarisation_of_light(film).at(0);
  EXPECT_NEAR(seen.degree, 0.5, 1e-3);
  EXPECT_NEAR(seen.angle_deg, 135, 1e-3);
  EXPECT_EQ(polarisation_image(film).find("AoLP.S0.1060,000000nm")->values[0], 45);
  EXPECT_FALSE(is_spectral(polarisation_image(film)));
}

TEST(PolarisationOfFilms, NeedsAFilmThatMeasuresIt) {
  try {
    (void)polarisation_of_light({1, 1, {{"R", {1}}}, {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::usage);
    EXPECT_STREQ(error.what(),
                 "--stokes: the film does not measure polarisation: set sensor/stokes in the scene, or use "
                 "polarisers at three sufficiently different angles");
  }
}

}  // namespace
}  // namespace abbe
