#include "transport/path/film_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spectral/sources.h"
#include "transport/plan/plan.h"

namespace abbe {
namespace {

SampledWavelengths all_at(double nm) {
  return {SampledSpectrum(static_cast<float>(nm)), SampledSpectrum(0.5F)};
}

const std::vector<Channel> kChannels{energy_channel("a", Curve(1.0)), energy_channel("b", Curve(3.0))};

template <typename Contribution>
std::vector<double> exposed_by(const Contribution& contribution, FilmResponse response, const FilmPoint& at,
                               double nm) {
  std::vector<double> exposed;
  response.expose(at, all_at(nm), contribution, [&](const FilmPoint&, std::span<const double> values) {
    exposed.assign(values.begin(), values.end());
  });
  return exposed;
}
std::vector<double> exposed(const FilmResponse& response, const FilmPoint& at, double nm,
                            const StokesSpectrum& light) {
  return exposed_by(light, response, at, nm);
}
std::vector<double> exposed(const FilmResponse& response, const FilmPoint& at, double nm, float power) {
  return exposed_by(SampledSpectrum(power), response, at, nm);
}

TEST(FilmResponse, AMosaicExposesThePixelsOwnChannel) {
  const Mosaic mosaic{2, 1, {1, 0}};
  const FilmResponse response(kChannels, &mosaic);
  EXPECT_EQ(exposed(response, {4, 7}, 500, 0.5F), std::vector<double>{8 * 0.5 / 0.5 * 3});
  EXPECT_EQ(exposed(response, {5, 7}, 500, 0.5F), std::vector<double>{8 * 0.5 / 0.5});
}

TEST(FilmResponse, WithoutAMosaicEveryPixelHasAllChannels) {
  const std::vector<double> values = exposed(FilmResponse(kChannels), {1, 0}, 500, 0.5F);
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[0], 8 * 0.5 / 0.5);
  EXPECT_EQ(values[1], 3 * values[0]);
}

TEST(FilmResponse, AngularChannelsFollowTheAngle) {
  const std::vector<Channel> channels{
      behind(energy_channel("line", Curve(1.0)), {Curve(1.0), {{band(645, 655), 2.0}}}),
      energy_channel("plain", Curve(1.0))};
  const FilmResponse response(channels);
  const std::vector<double> upright = exposed(response, {0, 0, 1}, 640, 1);
  EXPECT_EQ(upright[0], 0);
  const auto tilt = static_cast<float>(std::sqrt(1 - 4 * (1 - std::pow(640.0 / 650, 2))));
  const std::vector<double> tilted = exposed(response, {0, 0, tilt}, 640, 1);
  EXPECT_EQ(tilted[0], upright[1]);
  EXPECT_EQ(tilted[1], upright[1]);
}

StokesSpectrum slanted(float intensity) {
  return {SampledSpectrum(intensity), SampledSpectrum(0.5F), SampledSpectrum(0.25F), SampledSpectrum(0.125F)};
}

TEST(FilmResponse, ChannelsMeasureTheirRowOfTheStokesVector) {
  EXPECT_FALSE(FilmResponse(kChannels).polarised());
  std::vector<Channel> channels = with_stokes(kChannels);
  channels.push_back(behind(energy_channel("up", Curve(1.0)), Polariser{90}));
  const FilmResponse response(channels);
  EXPECT_TRUE(response.polarised());
  const std::vector<double> values = exposed(response, {}, 500, slanted(1));
  ASSERT_EQ(values.size(), channels.size());
  const std::vector<double> of_unit{1, 3, 0.5, 1.5, 0.25, 0.75, 0.125, 0.375, (1 - 0.5) / 2};
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], 16 * of_unit[k], 1e-6) << k;
  // An unpolarised contribution equals the vector (c, 0, 0, 0).
  EXPECT_EQ(exposed(response, {}, 500, 1), (std::vector<double>{16, 48, 0, 0, 0, 0, 0, 0, 8}));
  EXPECT_EQ(exposed(response, {}, 500, StokesSpectrum{SampledSpectrum(1.0F)}), exposed(response, {}, 500, 1));
}

// A mosaic of polarisers has one polariser per pixel; pixels are selected as for unpolarised light.
TEST(FilmResponse, PolarisedLightFallsOnPixelsAndAngles) {
  const std::vector<Channel> channels{
      behind(behind(energy_channel("right", Curve(1.0)), {Curve(1.0), {{band(645, 655), 2.0}}}),
             Polariser{0}),
      behind(energy_channel("up", Curve(1.0)), Polariser{90})};
  const Mosaic mosaic{2, 1, {0, 1}};
  const FilmResponse response(channels, &mosaic);
  const auto at = [&](int x, float cos_film) {
    return exposed(response, {x, 0, cos_film}, 640, slanted(1)).at(0);
  };
  const auto tilt = static_cast<float>(std::sqrt(1 - 4 * (1 - std::pow(640.0 / 650, 2))));
  EXPECT_EQ(at(0, 1), 0);
  EXPECT_NEAR(at(0, tilt), 16 * 0.75, 1e-6);
  EXPECT_NEAR(at(1, tilt), 16 * 0.25, 1e-6);
}

// Four wavelengths fall on each of two pixels.
TEST(FilmResponse, LanesExposeTheChannelAndTheAngleOfTheirOwnPixel) {
  WavelengthImages images{SampledSpectrum(SampledSpectrum::Values{2, 3, 2, 3, 2, 3, 2, 3}),
                          SampledSpectrum(0.5F),
                          SampledSpectrum(SampledSpectrum::Values{1, 0.5F, 1, 0.5F, 1, 0.5F, 1, 0.5F})};
  const auto fallen = [&](FilmResponse response) {
    std::vector<std::pair<int, double>> fell;
    response.expose(
        {0, 0, 1, 0, &images}, all_at(640), SampledSpectrum(1.0F),
        [&](const FilmPoint& at, std::span<const double> values) { fell.emplace_back(at.x, values[0]); });
    return fell;
  };
  using Fallen = std::vector<std::pair<int, double>>;
  EXPECT_EQ(fallen(FilmResponse(kChannels)), (Fallen{{2, 8}, {3, 8}}));
  const Mosaic mosaic{2, 1, {1, 0}};
  EXPECT_EQ(fallen(FilmResponse(kChannels, &mosaic)), (Fallen{{2, 24}, {3, 8}}));
  const std::vector<Channel> line{
      behind(energy_channel("line", Curve(1.0)), {Curve(1.0), {{band(635, 645), 1e9}}})};
  EXPECT_EQ(fallen(FilmResponse(line)), (Fallen{{2, 8}, {3, 8}})) << "a filter that no angle shifts";
  const std::vector<Channel> shifting{
      behind(energy_channel("line", Curve(1.0)), {Curve(1.0), {{band(635, 645), 1.5}}})};
  EXPECT_EQ(fallen(FilmResponse(shifting)), (Fallen{{2, 8}, {3, 0}}));
}

TEST(FilmResponse, LanesOfPolarisedLightFallApart) {
  const std::vector<Channel> channels = with_stokes({energy_channel("a", Curve(1.0))});
  FilmResponse response(channels);
  WavelengthImages images{SampledSpectrum(2.5F), SampledSpectrum(0.5F), SampledSpectrum(1.0F)};
  images.x = SampledSpectrum(SampledSpectrum::Values{2.5F, 2.5F, 2.5F, 2.5F, 2.5F, 2.5F, 4.5F, 4.5F});
  std::vector<std::pair<int, std::vector<double>>> fell;
  response.expose({0, 0, 1, 0, &images}, all_at(500), slanted(1),
                  [&](const FilmPoint& at, std::span<const double> exposed) {
                    fell.emplace_back(at.x, std::vector<double>(exposed.begin(), exposed.end()));
                  });
  ASSERT_EQ(fell.size(), 2U);
  EXPECT_EQ(fell[0], std::pair(2, std::vector<double>({12, 6, 3, 1.5})));
  EXPECT_EQ(fell[1], std::pair(4, std::vector<double>({4, 2, 1, 0.5})));
}

Scene card_in_a_line(const std::vector<Channel>& channels) {
  Scene scene{};
  scene.camera = {IrradianceProbe{}, 2, 1, 1};
  scene.channels = channels;
  scene.lights.push_back({"lamp", PointLight{{0, 0, 2}}, band(630, 640)});
  scene.commit();
  return scene;
}

TEST(Plan, PixelsOfAMosaicDrawTheWavelengthsOfTheirFilter) {
  Scene scene = card_in_a_line({energy_channel("a", band(632, 634)), energy_channel("b", band(636, 638))});
  const Plan both = make_plan(scene);
  EXPECT_EQ(&both.wavelengths_at(1, 0), &both.wavelengths);
  scene.mosaic = Mosaic{2, 1, {1, 0}};
  const Plan plan = make_plan(scene);
  EXPECT_DOUBLE_EQ(plan.wavelengths_at(0, 0).pdf(637), 0.5);
  EXPECT_EQ(plan.wavelengths_at(0, 0).pdf(633), 0);
  EXPECT_DOUBLE_EQ(plan.wavelengths_at(1, 0).pdf(633), 0.5);
  EXPECT_DOUBLE_EQ(plan.wavelengths.pdf(633), 0.25) << "photons meet any pixel";
  EXPECT_DOUBLE_EQ(plan.wavelengths.pdf(637), 0.25);
}

// A light that only a tilted filter transmits is sampled like other lights.
TEST(Plan, LightsAndWavelengthsAreDrawnForAllAnglesThatOccur) {
  std::vector<Channel> channels{
      behind(energy_channel("line", Curve(1.0)), {Curve(1.0), {{band(645, 655), 2.0}}})};
  limit_angles(channels[0], 0.9);
  const Scene scene = card_in_a_line(channels);
  EXPECT_TRUE(scene.features.angular_response);
  const Plan plan = make_plan(scene);
  EXPECT_FALSE(plan.path_lights.empty());
  EXPECT_GT(plan.wavelengths.pdf(635), 0.09);
  EXPECT_NEAR(plan.wavelengths.low_nm(), 645 * blue_shift(0.9, 2.0), 1e-9);
  EXPECT_EQ(plan.wavelengths.high_nm(), 655);
}

}  // namespace
}  // namespace abbe
