#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/metrics/appearance.h"
#include "calibration/metrics/camera_quality.h"
#include "calibration/metrics/color_rendering.h"
#include "spectral/color_temperature.h"
#include "spectral/rgb.h"
#include "spectral/sources.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe::test {
namespace {

// Published values of real lights are tested in `validation/cases`.

std::optional<ColorTemperature> temperature_of(const Curve& light) {
  return color_temperature(tristimulus(light, Curve(1), Observer::cie1931));
}

TEST(ColorTemperature, IsThatOfTheBlackBodyItself) {
  for (const double kelvin : {1000.0, 1200.0, 2856.0, 6500.0, 20000.0, 24000.0, 80000.0, 99000.0, 1e5}) {
    const auto found = temperature_of(planck(kelvin));
    ASSERT_TRUE(found.has_value()) << kelvin;
    EXPECT_NEAR(found->kelvin / kelvin, 1, 1e-6);
    EXPECT_NEAR(found->duv, 0, 1e-10);
  }
}

TEST(ColorTemperature, IsNoneFarFromTheLocusAndBeyondItsEnds) {
  EXPECT_FALSE(temperature_of(band(530, 540)).has_value());  // green
  for (const double kelvin : {900.0, 999.9, 100010.0, 150000.0})
    EXPECT_FALSE(temperature_of(planck(kelvin)).has_value()) << kelvin;
  EXPECT_FALSE(color_temperature({0, 0, 0}).has_value());
  EXPECT_FALSE(color_rendering(band(450, 455)).has_value());
  EXPECT_FALSE(color_fidelity(Curve()).has_value());
}

TEST(ColorTemperature, IsSignedByTheSideOfTheLocus) {
  const Curve lamp = planck(4000);
  EXPECT_GT(temperature_of(sum(lamp, scaled(band(520, 560), 0.1 * lamp(540))))->duv, 0.001);
  EXPECT_LT(temperature_of(product(lamp, sum(Curve(1), band(520, 560, -0.1))))->duv, -0.001);
}

TEST(ColorRendering, OfTheReferencesThemselvesIsPerfect) {
  // The nominal temperature of daylight is not quite its correlated one, hence 1e-2.
  for (const Curve& light : {planck(2700), planck(3900), daylight(5600), daylight(9000)}) {
    EXPECT_NEAR(color_rendering(light)->general, 100, 0.02);
    const auto fidelity = color_fidelity(light);
    EXPECT_NEAR(fidelity->fidelity, 100, 0.02);
    EXPECT_NEAR(fidelity->gamut, 100, 0.05);
    EXPECT_EQ(fidelity->samples.size(), 99u);
  }
}

TEST(ColorRendering, OfHuesWithoutSamplesAndTheirGamutThereIsNone) {
  const auto fidelity = color_fidelity(planck(1000));
  ASSERT_TRUE(fidelity.has_value());
  EXPECT_NEAR(fidelity->fidelity, 100, 0.05);
  EXPECT_TRUE(std::isnan(fidelity->gamut));
  std::vector<std::size_t> empty;
  for (std::size_t k = 0; k < ColorFidelity::kBins; ++k)
    if (!fidelity->bins[k].has_samples()) empty.push_back(k);
  EXPECT_EQ(empty, (std::vector<std::size_t>{3, 5, 12}));
}

// One sample is so near the end of its hue bin that sums in steps of 5 nm put it into another, which gives
// 78.3.
TEST(ColorRendering, SamplesAreThoseOfEveryNanometre) {
  const auto fidelity = color_fidelity(illuminant("FL3.9"));
  EXPECT_NEAR(fidelity->bins[11].fidelity, 71.45, 0.05);
  EXPECT_NEAR(fidelity->fidelity, 77.50, 0.05);
}

// Expected values come from independent sums over the tables. The ranges give 5001.24 and 5001.02 K. Their
// reference daylights differ in the third decimal of M1 or M2, to which the CIE rounds; without rounding the
// results would differ by 0.0025.
TEST(ColorRendering, RangesDifferLittle) {
  const Curve light = illuminant("D50");
  EXPECT_NEAR(color_rendering(light)->general, 99.992438, 1e-6);
  EXPECT_NEAR(color_rendering(light, kVisibleRange)->general, 99.980698, 1e-6);
  EXPECT_NEAR(color_fidelity(light)->fidelity, color_fidelity(light, kVisibleRange)->fidelity, 0.01);
  EXPECT_NE(color_fidelity(light)->fidelity, color_fidelity(light, kVisibleRange)->fidelity);
}

TEST(ColorRendering, DoesNotDependOnPower) {
  const Curve lamp = illuminant("FL4");
  EXPECT_NEAR(color_rendering(lamp)->general, color_rendering(scaled(lamp, 1e-6))->general, 1e-9);
  EXPECT_NEAR(color_fidelity(lamp)->gamut, color_fidelity(scaled(lamp, 1e6))->gamut, 1e-9);
}

TEST(Appearance, GivesGreysNoChromaWhenAdaptedCompletely) {
  for (const AppearanceModel model : {AppearanceModel::ciecam02, AppearanceModel::cam16}) {
    const ViewingConditions conditions{{109.85, 100, 35.58}, 60, 20, true};
    const Appearance appearance(model, conditions);
    const ColorAppearance white = appearance(conditions.white);
    EXPECT_NEAR(white.lightness, 100, 1e-9);
    // The cones of Hunt, Pointer and Estevez respond equally to white, to their five digits.
    EXPECT_NEAR(white.chroma, 0, model == AppearanceModel::cam16 ? 0.05 : 0.2);
    EXPECT_NEAR(appearance({0, 0, 0}).lightness, 0, 1e-12);
    EXPECT_NEAR(appearance.uniform(conditions.white)[0], 100, 1e-9);
  }
}

TEST(Itp, CountsCodeValuesOfGreys) {
  // A grey has neither T nor P, and I is its code value: 0.508 at 100 cd/m^2 [BT2408, table 1].
  const XYZ d65 = unit_xyz(kD65);
  const auto grey = itp({100 * d65[0], 100 * d65[1], 100 * d65[2]});
  EXPECT_NEAR(grey[0], 0.508, 5e-4);
  EXPECT_NEAR(grey[1], 0, 1e-12);
  EXPECT_NEAR(grey[2], 0, 1e-12);
}

TEST(CameraSpace, IsPerfectForObserversAndTheirCombinations) {
  const CameraSpace observer = camera_space(observer_channels(Observer::cie1931));
  EXPECT_NEAR(observer.vora, 1, 1e-12);
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  const std::vector<Channel> mixed{energy_channel("R", sum(cmf.x, scaled(cmf.y, 0.7))),
                                   energy_channel("G", sum(cmf.y, scaled(cmf.z, 0.2))),
                                   energy_channel("B", sum(cmf.z, scaled(cmf.x, 0.1)))};
  const CameraSpace combined = camera_space(mixed);
  EXPECT_NEAR(combined.vora, 1, 1e-12);
  for (const double residual : combined.luther) EXPECT_NEAR(residual, 0, 1e-6);
}

TEST(CameraSpace, LosesADimensionWithAChannelThatRepeatsAnother) {
  std::vector<Channel> channels = observer_channels(Observer::cie1931);
  channels[2] = channels[1];
  EXPECT_NEAR(camera_space(channels).vora, 2.0 / 3, 1e-12);
  expect_error([&] { (void)camera_space(std::span(channels).first(2)); }, ErrorCode::usage, "three channels");
}

TEST(CameraSpace, OrdersRealCamerasByNearness) {
  const double best = camera_space(camera("Canon_EOS_5D_Mark_II")).vora;
  const double worst = camera_space(camera("Canon_PowerShot_S90")).vora;
  EXPECT_GT(best, worst);
  EXPECT_GT(worst, 0.85);
  EXPECT_LT(best, 1);
}

TEST(Metamerism, IsNothingForOneSpectrumAndForAFactor) {
  const Chart colors = chart();
  const Curve& blue = colors.patches[12].reflectance;
  const Metamerism same = metamerism(blue, blue, illuminant("D65"), illuminant("A"));
  EXPECT_NEAR(same.index_76, 0, 1e-9);
  // Reflectances that differ by a factor are corrected to match under the reference light.
  const Metamerism darker = metamerism(blue, scaled(blue, 0.8), illuminant("D65"), illuminant("A"));
  EXPECT_GT(darker.reference_76, 1);
  EXPECT_NEAR(darker.index_76, 0, 1e-9);
}

TEST(Metamerism, ShowsMetamersInAnotherLight) {
  // Two reflectances that are grey for the observer in D65: one flat, one of three bands.
  const Curve flat(0.3);
  const Curve bands = sum(band(430, 470, 0.75), sum(band(520, 560, 0.65), band(590, 630, 0.7)));
  const Metamerism found = metamerism(flat, bands, illuminant("D65"), illuminant("FL2"));
  EXPECT_GT(found.index_76, 3);
  EXPECT_GT(found.index_2000, 2);
  expect_error([&] { (void)metamerism(flat, Curve(), illuminant("D65"), illuminant("A")); }, ErrorCode::input,
               "black");
}

}  // namespace
}  // namespace abbe::test
