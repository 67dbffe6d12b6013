#include "sensor/film/spectral_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "io/error.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

const SpectralBins kBins{400, 10, 3};

TEST(SpectralFilm, BinsFillTheirRange) {
  const std::vector<Channel> channels = spectral_channels(kBins);
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "405nm");
  EXPECT_EQ(channels[2].name, "425nm");
  for (double nm = 395.5; nm < 435; nm += 1) {
    double sum = 0;
    for (const Channel& channel : channels) sum += channel.weight(nm);
    EXPECT_EQ(sum, nm > 400 && nm < 430 ? 1 : 0) << nm;
  }
  EXPECT_EQ(channels[1].weight(415), 1);
  EXPECT_EQ(channels[1].kind, ResponseKind::energy);
  EXPECT_EQ(spectral_channels({1000, 0.01, 2})[1].name, "1000.015nm");
}

Image binned_film() {
  Image image{2, 1, {}, {{"seed", "7"}}};
  for (const char* prefix : {"", "Variance."})
    for (const int nm : {405, 415, 425})
      image.channels.push_back(
          {prefix + std::to_string(nm) + "nm", {static_cast<float>(nm), static_cast<float>(2 * nm)}});
  return image;
}

TEST(SpectralFilm, ValuesBecomeRadiancesAndVariancesTheirs) {
  const std::vector<double> factors{0.5, 0.25};
  const SpectralImage image = spectral_film(binned_film(), kBins, factors);
  ASSERT_EQ(image.bands.size(), 3U);
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.bands[1].center_nm, 415);
  EXPECT_EQ(image.bands[1].radiance, (std::vector<float>{830, 3320}));
  ASSERT_EQ(image.others.size(), 3U);
  EXPECT_EQ(image.others[1].name, "Variance.S0.415,000000nm");
  EXPECT_EQ(image.others[1].values, (std::vector<float>{1660, 13280}));
}

TEST(SpectralFilm, AFilmWithoutABinIsABug) {
  Image image = binned_film();
  image.channels[1].name = "411nm";
  EXPECT_THROW((void)spectral_film(image, kBins, std::vector<double>{1, 1}), Error);
}

SpectralImage radiances() {
  SpectralImage image{1, 1, {}, {}, {}};
  for (int bin = 0; bin < 3; ++bin) {
    image.bands.push_back({kBins.center_nm(bin), {static_cast<float>(bin + 1)}});
    image.others.push_back({"Variance." + spectral_channel(kBins.center_nm(bin)), {0.04F}});
  }
  return image;
}

// The light of a bin is spread over it. A filter that cuts part of a bin removes that part of its energy.
TEST(SpectralFilm, ASensorCountsTheEnergyThatItsFiltersPass) {
  const std::vector channels{energy_channel("all", Curve(1.0)), energy_channel("half", band(405, 415)),
                             energy_channel("ramp", Curve({{400, 0}, {430, 30}})),
                             energy_channel("signed", Curve(-2.0))};
  const Image seen = expose(radiances(), channels, std::vector<double>{0.5});
  EXPECT_FLOAT_EQ(seen.find("all")->values[0], 0.5F * 6);
  EXPECT_FLOAT_EQ(seen.find("half")->values[0], 0.5F * (0.5F * 1 + 0.5F * 2));
  EXPECT_FLOAT_EQ(seen.find("ramp")->values[0], 0.5F * (5 + 15 * 2 + 25 * 3));
  EXPECT_FLOAT_EQ(seen.find("signed")->values[0], -0.5F * 12);
  // Deviations of 0.2 in all bins add up.
  EXPECT_FLOAT_EQ(seen.find("Variance.all")->values[0], 0.25F * 0.36F);
  EXPECT_FLOAT_EQ(seen.find("Variance.signed")->values[0], 0.25F * 1.44F);
}

TEST(SpectralFilm, AnInfiniteVarianceCountsWhereTheBandDoes) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  SpectralImage image = radiances();
  image.others[2].values[0] = kInfinite;
  const std::vector channels{energy_channel("all", Curve(1.0)), energy_channel("half", band(405, 415))};
  const Image seen = expose(image, channels, std::vector<double>{1});
  EXPECT_EQ(seen.find("Variance.all")->values[0], kInfinite);
  EXPECT_FLOAT_EQ(seen.find("Variance.half")->values[0], 0.04F);
}

TEST(SpectralFilm, StokesComponentsBecomeRadiancesToo) {
  Image polarised = binned_film();
  for (int component = 1; component < 4; ++component)
    for (const int nm : {405, 415, 425}) {
      const std::string name = stokes_plane_name(component, std::to_string(nm) + "nm");
      polarised.channels.push_back({name, {static_cast<float>(component), -1}});
      polarised.channels.push_back({"Variance." + name, {1, 4}});
    }
  const SpectralImage image = spectral_film(polarised, kBins, std::vector<double>{0.5, 0.25});
  ASSERT_TRUE(image.is_polarised());
  EXPECT_EQ(image.bands[1].radiance, (std::vector<float>{830, 3320}));
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(image.polarised.at(i).size(), 3U);
    EXPECT_EQ(image.polarised.at(i)[2].center_nm, 425);
    EXPECT_EQ(image.polarised.at(i)[2].radiance, (std::vector<float>{2 * static_cast<float>(i + 1), -4}));
  }
  ASSERT_EQ(image.others.size(), 12U);
  EXPECT_EQ(image.others[11].name, "Variance.S3.425,000000nm");
  EXPECT_EQ(image.others[11].values, (std::vector<float>{4, 64}));
  EXPECT_FALSE(spectral_film(binned_film(), kBins, std::vector<double>{1, 1}).is_polarised());
}

// A polariser in front of a sensor that is exposed to a polarised image acts as it would in the scene.
TEST(SpectralFilm, PolarisersLookAtPolarisedImagesAlone) {
  SpectralImage image = radiances();
  const std::vector channels{behind(energy_channel("up", band(405, 430)), Polariser{90, Curve(0.8)})};
  try {
    (void)expose(image, channels, std::vector<double>{1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::usage);
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (const SpectralBand& band : image.bands)
      image.polarised.at(i).push_back({band.center_nm, {i == 0 ? -0.5F * band.radiance[0] : 7}});
  // Three quarters of the light oscillate vertically.
  const Image seen = expose(image, channels, std::vector<double>{2});
  EXPECT_NEAR(seen.find("up")->values[0], 2 * 0.8F * 0.75F * (0.5F + 2 + 3), 1e-5F);
  const Image all = expose(image, with_stokes({energy_channel("all", Curve(1.0))}), std::vector<double>{1});
  EXPECT_FLOAT_EQ(all.find("all")->values[0], 6);
  EXPECT_FLOAT_EQ(all.find("S1.all")->values[0], -3);
  EXPECT_FLOAT_EQ(all.find("S3.all")->values[0], 21);
}

TEST(SpectralFilm, WithoutVariancesThereIsNoError) {
  SpectralImage image = radiances();
  image.others.clear();
  const std::vector channels{energy_channel("all", Curve(1.0))};
  EXPECT_EQ(expose(image, channels, std::vector<double>{1}).find("Variance.all")->values[0], 0);
  image.others = radiances().others;
  image.others.pop_back();
  try {
    (void)expose(image, channels, std::vector<double>{1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
  }
}

TEST(SpectralFilm, WhatLiesBeyondTheWavelengthsCarriedIsNotSeen) {
  const SpectralImage image{1, 1, {{290, {1}}, {310, {1}}, {1090, {1}}, {1190, {1}}}, {}, {}};
  const std::vector channels{energy_channel("all", Curve(1.0))};
  // Bands [280, 300], [300, 700], [700, 1140] and [1140, 1240], cut to [300, 1100].
  EXPECT_FLOAT_EQ(expose(image, channels, std::vector<double>{1}).find("all")->values[0], 1 + 400 / 440.0F);
}

TEST(SpectralFilm, AnglesAreLost) {
  const std::vector channels{
      behind(energy_channel("tilting", Curve(1.0)), {Curve(1.0), {{band(410, 420), 2}}})};
  try {
    (void)expose(radiances(), channels, std::vector<double>{1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("angle of incidence"), std::string::npos);
  }
}

}  // namespace
}  // namespace abbe
