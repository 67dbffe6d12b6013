#include "develop/polarisation.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "sensor/film/film_planes.h"
#include "sensor/readout/demosaic.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

// Film of one light under four polarisers, of which one leaks and counts twice as much.
Image film_of_polarisers(int width, int height) {
  const double i = 4;
  const double q = -1;
  const double u = 2;
  Image image{width, height, {}, {{"sensor_channels", "I0,I45,I90,I135"}}};
  const std::array<PolariserRow, 4> rows{
      {{"I0", 1, 1, 0}, {"I0", 1, 0, 1}, {"I0", 2, -0.5, 0}, {"I0", 1, 0, -1}}};
  const std::array names{"I0", "I45", "I90", "I135"};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double counted = rows.at(k).weight * (i + rows.at(k).q * q + rows.at(k).u * u);
    image.channels.push_back({names.at(k), std::vector<float>(image.pixels(), static_cast<float>(counted))});
    image.metadata[fmt::format("{}{}", kAnalyserKey, names.at(k))] = to_text(rows.at(k));
  }
  return image;
}

void expect_the_light(const Image& stokes) {
  const auto planes = stokes_planes(stokes);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].channel, "I0");
  for (std::size_t pixel = 0; pixel < stokes.pixels(); ++pixel) {
    const StokesVector told = planes[0].at(pixel);
    EXPECT_NEAR(told[0], 4, 1e-5) << pixel;
    EXPECT_NEAR(told[1], -1, 1e-5) << pixel;
    EXPECT_NEAR(told[2], 2, 1e-5) << pixel;
    EXPECT_EQ(told[3], 0);
    EXPECT_FALSE(planes[0].has_circular());
  }
}

TEST(PolarisationCamera, SolvesForTheStokesVector) {
  expect_the_light(stokes_of_polarisers(film_of_polarisers(2, 1)));
}

TEST(PolarisationCamera, InterpolatesItsMosaic) {
  const Mosaic mosaic{2, 2, {2, 1, 3, 0}};
  const std::vector<std::string> names{"I0", "I45", "I90", "I135"};
  Image planes = film_of_polarisers(6, 4);
  for (const std::string& name : names)
    planes.channels.push_back({"Variance." + name, std::vector<float>(planes.pixels(), 0)});
  Image raw = mosaicked(planes, mosaic, names);
  raw.metadata["sensor_channels"] = kRawPlane;
  raw.metadata["mosaic"] = to_text(mosaic, names);
  raw.metadata["mosaic_channels"] = "I0,I45,I90,I135";
  expect_the_light(stokes_of_polarisers(raw));
}

TEST(PolarisationCamera, NeedsThreeAngles) {
  Image two = film_of_polarisers(1, 1);
  two.metadata.erase("analyser.I45");
  two.metadata.erase("analyser.I135");
  EXPECT_TRUE(stokes_of_polarisers(two).channels.empty());
  EXPECT_TRUE(stokes_of_polarisers({1, 1, {{"R", {1}}}, {}}).channels.empty());
}

}  // namespace
}  // namespace abbe
