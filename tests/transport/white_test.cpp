#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "sensor/response/polarised_channels.h"
#include "transport/render/white.h"

// Which light is the white.

namespace abbe {
namespace {

const Curve& red() {
  static const Curve kRed({{600, 0}, {650, 1}, {700, 0}});
  return kRed;
}
const Curve& blue() {
  static const Curve kBlue({{400, 0}, {450, 1}, {500, 0}});
  return kBlue;
}

// A card before a camera with the channels all over the spectrum, X, Y, Z.
Scene card_under(std::vector<Light> lights) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 24, 16, 0.001};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}},
                     {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  scene.channels = {energy_channel("R", Curve(1.0)), energy_channel("G", Curve(1.0)),
                    energy_channel("B", Curve(1.0))};
  scene.shapes.push_back({"card", Quad{{-5, -5, 5}, {0, 10, 0}, {10, 0, 0}}, 0});
  scene.lights = std::move(lights);
  scene.commit();
  return scene;
}
Light lamp(const std::string& name, const Curve& spectrum, double strength) {
  return {name, PointLight{{0, 0, 0}}, scaled(spectrum, strength)};
}

TEST(MainLight, IsTheOneThatExposesTheFilmMostInAnyOrder) {
  std::vector<Light> lights{lamp("faint", red(), 0.001),
                            {"dome", EnvironmentLight{}, blue()},
                            lamp("green", Curve({{500, 0}, {550, 1}, {600, 0}}), 0.3)};
  const auto by_name = [](const Light& a, const Light& b) { return a.name < b.name; };
  std::sort(lights.begin(), lights.end(), by_name);
  do {
    const White white = main_light(card_under(lights));
    EXPECT_EQ(white.name, "dome") << lights[0].name << ' ' << lights[1].name;
    EXPECT_EQ(white.xy, chromaticity(blue()));
  } while (std::next_permutation(lights.begin(), lights.end(), by_name));
}

// X, Y and Z together see more of the blue lamp.
TEST(MainLight, IsThatOfTheObserverWhoMeasuresPolarisation) {
  Scene scene =
      card_under({lamp("blue", blue(), 1.5), lamp("green", Curve({{500, 0}, {550, 1}, {600, 0}}), 1)});
  scene.channels = observer_channels(Observer::cie1931);
  EXPECT_EQ(main_light(scene).name, "green");
  scene.channels = with_stokes(scene.channels);
  EXPECT_EQ(main_light(scene).name, "green");
}

TEST(MainLight, LampsOfProportionalSpectraCountAsOne) {
  std::vector<Light> lights{lamp("strong", red(), 10)};
  for (int i = 0; i < 30; ++i) lights.push_back(lamp("weak", blue(), 0.5 + 0.01 * i));
  lights.push_back(lamp("weak but first", blue(), 0.9));
  const White white = main_light(card_under(lights));  // 10 against 20.2
  EXPECT_EQ(white.name, "weak but first") << "the strongest of its kind names it";
  lights.erase(lights.begin() + 12, lights.end());
  EXPECT_EQ(main_light(card_under(lights)).name, "strong") << "10 against 6.1";
}

TEST(MainLight, HasNothingToDoWithTheRendersSeedOrThreads) {
  const std::vector<Light> lights{lamp("red", red(), 1), lamp("blue", blue(), 1.02)};
  Scene scene = card_under(lights);
  const White one = main_light(scene);
  EXPECT_EQ(one.name, "blue");
  scene.render.seed = 77;
  const White other = main_light(scene, 3);
  EXPECT_EQ(other.name, one.name);
  EXPECT_EQ(other.reason, one.reason) << "the very share";
}

// What only photons bring counts: the stronger lamp stands behind the card.
TEST(MainLight, SeesWhatPhotonsBring) {
  Scene scene = card_under({{"hidden", PointLight{{0, 0, 9}}, scaled(red(), 5)}, lamp("seen", blue(), 1)});
  scene.render.integrator = Integrator::light;
  EXPECT_EQ(main_light(scene).name, "seen");
}

TEST(MainLight, TheObserverCountsLuminanceAndTheDarkHasEqualEnergy) {
  const Curve violet({{400, 0}, {420, 1}, {440, 0}});
  Scene scene = card_under({lamp("violet", violet, 3), lamp("red", red(), 0.5)});
  EXPECT_EQ(main_light(scene).name, "violet");
  scene.channels = observer_channels(Observer::cie1931);
  EXPECT_EQ(main_light(scene).name, "red");
  scene.channels = spectral_channels({380, 20, 20});
  scene.spectral = SpectralBins{380, 20, 20};
  EXPECT_EQ(main_light(scene).name, "red");
  EXPECT_EQ(main_light(card_under({})).xy, chromaticity(Curve(1.0)));
}

TEST(WhiteOf, AChromaticityIsShownInTheMainLight) {
  Scene scene = card_under({lamp("red", red(), 1)});
  scene.output.white = White{"0.3,0.4", "asked for", {0.3, 0.4}};
  const White white = white_of(scene);
  EXPECT_EQ(white.xy, (Chromaticity{0.3, 0.4}));
  EXPECT_EQ(white.spectrum->max(), red().max());
  scene.output.white->spectrum = blue();
  EXPECT_EQ((*white_of(scene).spectrum)(450), 1);
}

}  // namespace
}  // namespace abbe
