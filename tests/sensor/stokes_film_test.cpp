#include "sensor/film/film_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/error.h"

namespace abbe {
namespace {

Image polarised_film() {
  return {1,
          2,
          {{"R", {4, 1}},
           {"G", {2, 1}},
           {"S1.R", {0, 0.6F}},
           {"S1.G", {2, 0}},
           {"S2.R", {-3, 0}},
           {"S2.G", {0, 0}},
           {"S3.R", {0, 0.8F}},
           {"S3.G", {0, 0}},
           {"Variance.R", {9, 9}}},
          {{"sensor_channels", "R,G,S1.R,S1.G,S2.R,S2.G,S3.R,S3.G"}}};
}

TEST(StokesFilm, FindsTheComponentsOfEachChannel) {
  const Image image = polarised_film();
  const std::vector<StokesPlanes> planes = stokes_planes(image);
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_EQ(planes[0].channel, "R");
  EXPECT_EQ(planes[0].at(0), (StokesVector{4, 0, -3, 0}));
  EXPECT_EQ(planes[1].at(0), (StokesVector{2, 2, 0, 0}));
  EXPECT_TRUE(stokes_planes({1, 1, {{"R", {1}}, {"G", {1}}}, {}}).empty());
  for (int component = 0; component < 3; ++component) {
    Image torn = polarised_film();
    torn.channels.erase(torn.channels.begin() + 2 + 2 * component);
    EXPECT_THROW((void)stokes_planes(torn), Error) << "component " << component + 1;
  }
}

TEST(StokesFilm, OfLinearPolarisersTellsNothingCircular) {
  EXPECT_TRUE(stokes_planes(polarised_film())[0].has_circular());
  Image linear = polarised_film();
  std::erase_if(linear.channels, [](const ImageChannel& channel) { return channel.name.starts_with("S3."); });
  for (const StokesPlanes& planes : stokes_planes(linear)) {
    EXPECT_FALSE(planes.has_circular());
    EXPECT_EQ(planes.at(1)[3], 0);
  }
}

TEST(StokesFilm, FindsThoseOfEachBand) {
  Image image{1, 1, {}, {{"spectralLayoutVersion", "1.0"}}};
  for (const char* name : {"S3.410,0nm", "S0.410,0nm", "S1.410,0nm", "S2.410,0nm", "S0.400,0nm", "S1.400,0nm",
                           "S2.400,0nm", "S3.400,0nm"})
    image.channels.push_back({name, {static_cast<float>(name[1] - '0')}});
  EXPECT_EQ(plane_names(image),
            (std::vector<std::string>{"S0.400,0nm", "S0.410,0nm", "S1.400,0nm", "S1.410,0nm", "S2.400,0nm",
                                      "S2.410,0nm", "S3.400,0nm", "S3.410,0nm"}));
  const std::vector<StokesPlanes> planes = stokes_planes(image);
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_EQ(planes[1].channel, "S0.410,0nm");
  EXPECT_EQ(planes[1].at(0), (StokesVector{0, 1, 2, 3}));
}

TEST(StokesFilm, TellsDegreeAndAngle) {
  const PolarisationFigures down = polarisation_of({4, 0, -3, 0});
  EXPECT_DOUBLE_EQ(down.degree, 0.75);
  EXPECT_DOUBLE_EQ(down.linear_degree, 0.75);
  EXPECT_DOUBLE_EQ(down.angle_deg, 135);
  const PolarisationFigures elliptic = polarisation_of({1, 0.6, 0, 0.8});
  EXPECT_DOUBLE_EQ(elliptic.degree, 1);
  EXPECT_DOUBLE_EQ(elliptic.linear_degree, 0.6);
  EXPECT_DOUBLE_EQ(elliptic.angle_deg, 0);
  EXPECT_DOUBLE_EQ(polarisation_of({2, -1, 0, 0}).angle_deg, 90);
  EXPECT_DOUBLE_EQ(polarisation_of({2, 0, 1, 0}).angle_deg, 45);
  EXPECT_EQ(polarisation_of({0, 0, 0, 0}).degree, 0);
  EXPECT_EQ(polarisation_of({-1, 1, 0, 0}).degree, 0);
}

}  // namespace
}  // namespace abbe
