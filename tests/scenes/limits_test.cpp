#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "spectral/sources.h"
#include "tests/angles.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// What a film holds where something is very small, very large, or nothing at all.

namespace abbe {
namespace {

double mean(const RenderResult& result, int channel = 0) {
  return test::whole(result.film, channel).mean;
}

/// The differences between two films over the largest value, when `b` is divided by `factor`, largest first.
std::vector<double> differences(const Film& a, const Film& b, double factor = 1) {
  double largest = 0;
  std::vector<double> apart;
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(a.width() * a.height()); ++pixel)
    for (int channel = 0; channel < a.channels(); ++channel) {
      largest = std::max(largest, std::abs(a.mean(pixel, channel)));
      apart.push_back(std::abs(a.mean(pixel, channel) - b.mean(pixel, channel) / factor));
    }
  for (double& one : apart) one /= largest;
  std::ranges::sort(apart, std::greater<>());
  return apart;
}

double difference(const Film& a, const Film& b, double factor = 1) {
  return differences(a, b, factor).front();
}

// One camera, one dome.
Scene dome(const std::string& camera, const std::string& sensor, const std::string& emission) {
  return test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{{}, "from": [0, 0, 0], "to": [0, 0, 2], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [9, 9], {}}},
    "lights": [{{"environment": {{}}, "emission": {}}}], "render": {{"samples": 2048}}}})",
                                     camera, sensor, emission));
}

TEST(FilmUnits, ALensDimsWithTheFourthPowerOfTheCosineAndWithMagnification) {
  const double f = 0.05;
  const double distance = 2;
  const Scene scene = dome(R"("thin_lens": {"focal_length": 0.05, "f_number": 16})",
                           R"("pixel_pitch_um": 8000, "channels": {"all": 1})",
                           R"({"spectrum": {"band": [500, 600]}, "radiance": 3})");
  const double v = f * distance / (distance - f);
  const double magnification = v / distance;
  const double n = 16;
  const double on_axis = kPi * 3 / (4 * n * n * (1 + magnification) * (1 + magnification));
  EXPECT_NEAR(v, f * (1 + magnification), 1e-12);
  const Film film = render(scene, {}).film;
  const auto at = [&film](int x, int y) { return film.mean(static_cast<std::size_t>(y * 9 + x), 0); };
  // Mean of cos^4 over a pixel.
  const auto expected = [&](int x, int y) {
    double sum = 0;
    for (int i = 0; i < 64; ++i)
      for (int j = 0; j < 64; ++j) {
        const double px = (x - 4.5 + (i + 0.5) / 64) * 8e-3 / v;
        const double py = (y - 4.5 + (j + 0.5) / 64) * 8e-3 / v;
        sum += std::pow(1 + px * px + py * py, -2);
      }
    return on_axis * sum / (64 * 64);
  };
  EXPECT_NEAR(at(4, 4) / expected(4, 4), 1, 2e-3);
  EXPECT_NEAR(at(0, 0) / expected(0, 0), 1, 2e-3);
  EXPECT_NEAR(at(8, 4) / expected(8, 4), 1, 2e-3);
}

constexpr const char* kCornell = "cornell.json";
const std::vector<Override> kSmall{{"/sensor/resolution", "[16, 16]"}, {"/render/samples", "4"}};

RenderResult rendered_small(const char* scene, std::vector<Override> settings) {
  settings.insert(settings.end(), kSmall.begin(), kSmall.end());
  return render(test::load(scene, settings), {});
}

TEST(Limits, AFilmIsProportionalToRadianceFromTheFaintestToTheBrightest) {
  const auto lit = [](double radiance) {
    return rendered_small("glass_sphere.json",
                          {{"/lights/0/emission", fmt::format(R"({{"spectrum": {}}})", radiance)},
                           {"/lights/1/emission", R"({"spectrum": 0})"}});
  };
  const RenderResult one = lit(1);
  for (const int exponent : test::nightly() ? std::vector{-80, -40, 40, 60} : std::vector{-80}) {
    const RenderResult other = lit(std::ldexp(1.0, exponent));
    EXPECT_EQ(difference(one.film, other.film, std::ldexp(1.0, exponent)), 0) << exponent;
  }
  const RenderResult brightest = lit(1e30);
  EXPECT_EQ(brightest.stats.nonfinite_samples, 0U);
  EXPECT_TRUE(std::isfinite(mean(brightest)));
  EXPECT_THROW((void)lit(1e-40), Error) << "less than a float can be";
}

TEST(Limits, ALightWithoutPowerChangesNothing) {
  const RenderResult plain = rendered_small("glass_sphere.json", {});
  const RenderResult with = rendered_small("glass_sphere.json", {{"/lights", R"([
      {"sphere": {"center": [-3, 5, -2], "radius": 0.15}, "emission": {"spectrum": 1, "luminance": 136600.4}},
      {"environment": {}, "emission": {"spectrum": 1, "luminance": 34.1501}},
      {"point": {"at": [0, 3, 0]}, "emission": {"spectrum": 0}},
      {"spot": {"at": [0, 3, 0], "direction": [0, -1, 0], "half_angle_deg": 20}, "emission": {"spectrum": {"band": [900, 1000]}, "intensity": 5}}])"}});
  EXPECT_EQ(difference(plain.film, with.film), 0);
}

TEST(Limits, ExposuresThatFloatsCannotHoldAreRefused) {
  Scene scene = test::load("glass_sphere.json");
  const auto refused = [&](double exposure_s) {
    scene.exposure_s = exposure_s;
    const std::optional<Error> error = refusal(scene);
    return error ? std::string(error->what()) : "";
  };
  EXPECT_EQ(refused(1e-30), "");
  EXPECT_EQ(refused(1e20), "");
  EXPECT_NE(refused(1e-60).find("give film values below the range of floats"), std::string::npos);
  EXPECT_NE(refused(1e60).find("give film values above the range of floats"), std::string::npos);
}

// A sensor that counts electrons makes large numbers of what paths carry, which is what is lost first.
TEST(Limits, RadiancesThatPathsCannotCarryAreRefused) {
  const auto lit = [](int exponent) {
    const double luminance = std::ldexp(2500.0, exponent);
    return std::vector<Override>{{"/lights/0/emission/luminance", fmt::format("{}", luminance)}};
  };
  const double bright = mean(rendered_small("ccd.json", lit(0)));
  EXPECT_NEAR(std::ldexp(mean(rendered_small("ccd.json", lit(-86))), 86) / bright, 1, 1e-6);
  const std::optional<Error> error = refusal(test::load("ccd.json", lit(-90)));
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("below the range of floats (got about 1.6e-33 J/(m^2 nm)"),
            std::string::npos)
      << error->what();
}

TEST(Limits, LightTheSensorDoesNotRespondToIsExactlyBlack) {
  const RenderResult result = rendered_small(
      "glass_sphere.json", {{"/lights/0/emission", R"({"spectrum": {"band": [900, 1000]}})"},
                            {"/lights/1/emission", R"({"spectrum": {"band": [1000, 1100]}})"}});
  EXPECT_EQ(mean(result), 0);
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
}

// By units that leave the walls along the axes, so that directions are drawn in the same frames.
TEST(Limits, AnImageDoesNotDependOnTheUnitOfLength) {
  const auto in = [](const char* unit) {
    return rendered_small(kCornell, {{"/units", unit}, {"/camera/pinhole", R"({"fov_deg": 39})"}});
  };
  const RenderResult metres = in("m");
  for (const char* unit : {"cm", "mm"}) EXPECT_LT(difference(metres.film, in(unit).film), 1e-6) << unit;
}

RenderResult through_glass(const char* unit, const char* integrator) {
  return rendered_small(
      "glass_sphere.json",
      {{"/units", unit}, {"/render/integrator", integrator}, {"/materials/glass/dielectric/ior", "1.7"}});
}

// Of techniques whose paths go nowhere that others have shown.
TEST(Limits, AnImageThroughGlassDoesNotDependOnTheUnitOfLength) {
  for (const char* integrator : {"bdpt", "light", "vcm"}) {
    const RenderResult metres = through_glass("m", integrator);
    for (const char* unit : {"cm", "mm", "in"})
      EXPECT_LT(difference(metres.film, through_glass(unit, integrator).film), 3e-6) << integrator << unit;
  }
}

// Pilot rays and pilot photons decide where photons and camera paths start. Rounding may decide the course of
// one path, at an edge or by roulette, so that the three channels of one pixel may differ by more than
// rounding.
TEST(Limits, AGuidedImageDoesNotDependOnTheUnitOfLength) {
  constexpr std::size_t kValuesOfAPixel = 3;
  const RenderResult metres = through_glass("m", "auto");
  const std::vector<const char*> by_day{"cm", "in"};
  for (const char* unit : test::nightly() ? std::vector{"cm", "mm", "in"} : by_day) {
    const RenderResult other = through_glass(unit, "auto");
    EXPECT_LT(differences(metres.film, other.film).at(kValuesOfAPixel), 1e-5) << unit;
    EXPECT_NEAR(mean(other) / mean(metres), 1, 1e-2) << unit;
  }
}

TEST(Limits, MatterOfIndexOneIsNotSeen) {
  const auto sphere = [](const char* ior) {
    return render(test::load("validation/dome.json",
                             {{"/materials/glass/dielectric/ior", ior}, {"/render/samples", "4"}}),
                  {});
  };
  const RenderResult air = sphere("1");
  const RenderResult none =
      render(test::load("validation/dome.json", {{"/shapes", "[]"}, {"/render/samples", "4"}}), {});
  EXPECT_LT(difference(none.film, air.film), 1e-6);
}

// A wall lit by a bulb through a pane that does not show: photons are aimed at the pane and must bring what
// light sampling finds without it.
TEST(Limits, PhotonsThroughMatterOfIndexOneBringAllTheLight) {
  constexpr const char* kWall = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -1.2, 1], "to": [0, 0, 1], "up": [0, 0, 1]},
    "sensor": {"resolution": [32, 32], "channels": {"g": {"band": [500, 600]}}},
    "materials": {"white": {"diffuse": {"reflectance": 0.8}}, "air": {"dielectric": {"ior": 1}}},
    "lights": [{"point": {"at": [0.2, -2, 1.5]}, "emission": {"illuminant": "E", "luminous_intensity": 1}}],
    "shapes": [
      {"quad": {"corner": [-2, 0, -1], "edge_u": [4, 0, 0], "edge_v": [0, 0, 4]}, "material": "white"},
      {"quad": {"corner": [-1, -1.5, 0.3], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}, "material": "air"}],
    "render": {"max_depth": 3}})";
  const Override samples{"/render/samples", test::nightly() ? "1024" : "192"};
  const RenderResult with_pane = render(test::load_text(kWall, {samples}), {});
  Scene no_pane = test::load_text(kWall, {samples});
  no_pane.shapes.pop_back();
  no_pane.commit();
  const RenderResult without = render(no_pane, {});
  ASSERT_GT(with_pane.stats.paths, without.stats.paths) << "photons were traced";
  EXPECT_NEAR(mean(with_pane) / mean(without), 1,
              test::ratio_margin(with_pane.film, without.film, 1e-3, 0.01));
}

TEST(Limits, ANarrowSpotSendsOutItsFlux) {
  for (const double half_angle_deg : {0.1, 0.13, 1.0, 5.0}) {
    // A meter that holds the whole spot, 10 m away.
    const double side = 2.4 * 10 * std::tan(half_angle_deg * kPi / 180);
    const Scene scene = test::load_text(fmt::format(
        R"({{"abbe": 1,
             "camera": {{"irradiance_probe": {{"quad": {{"corner": [{0}, {1}, {2}], "edge_u": [{3}, 0, {4}], "edge_v": [0, {5}, 0]}}}}}},
             "sensor": {{"resolution": [64, 64], "observer": "1931"}},
             "lights": [{{"spot": {{"at": [6, 0, 8], "direction": [-0.6, 0, -0.8], "half_angle_deg": {6}}},
                          "emission": {{"illuminant": "E", "luminous_flux_lm": 1}}}}],
             "render": {{"samples": 64}}}})",
        -0.4 * side, -0.5 * side, 0.3 * side, 0.8 * side, -0.6 * side, side, half_angle_deg));
    EXPECT_NEAR(mean(render(scene, {}), 1) * side * side, 1, 2e-3) << half_angle_deg;
  }
}

// A lamp of 1 W, millimetres above a ground ten kilometres wide and from a meter, by I/d^2.
TEST(Limits, ALampNextToWhatItLightsIsCountedInAWideScene) {
  const auto lit = [](double height_m, const char* samples) {
    return render(test::load_text(fmt::format(R"({{"abbe": 1,
              "camera": {{"irradiance_probe": {{"at": [0, 0, {}], "normal": [0, 0, 1]}}}},
              "sensor": {{"resolution": [1, 1], "channels": {{"all": {{"band": [300, 1100]}}}}}},
              "materials": {{"black": {{"diffuse": {{"reflectance": 0}}}}}},
              "lights": [{{"point": {{"at": [0, 0, {}]}}, "emission": {{"illuminant": "E", "radiant_flux_W": 1}}}}],
              "shapes": [{{"quad": {{"corner": [-5000, -5000, 0], "edge_u": [10000, 0, 0], "edge_v": [0, 10000, 0]}}, "material": "black"}}]}})",
                                              0.5 * height_m, 1.5 * height_m),
                                  {{"/render/samples", samples}}),
                  {});
  };
  for (const double distance_m : {2e-3, 2e-5}) {
    const RenderResult once = lit(distance_m, "16");
    const RenderResult often = lit(distance_m, "2048");
    EXPECT_EQ(often.stats.nonfinite_samples, 0U);
    EXPECT_GT(mean(once), 0);
    EXPECT_NEAR(mean(often) / mean(once), 1, 1e-6) << distance_m;
  }
  EXPECT_NEAR(mean(lit(2e-5, "64")) / mean(lit(2e-3, "64")), 1e4, 0.1);
}

TEST(Limits, NegativeResponsesAreKept) {
  const auto with = [](const char* channels) {
    return rendered_small(
        kCornell,
        {{"/sensor",
          fmt::format(R"({{"resolution": [16, 16], "response": "quantum", "channels": {}}})", channels)}});
  };
  const RenderResult plus = with(R"({"a": 1})");
  const RenderResult minus = with(R"({"a": -1})");
  EXPECT_EQ(minus.stats.nonfinite_samples, 0U);
  EXPECT_EQ(difference(plus.film, minus.film, -1), 0);
}

}  // namespace
}  // namespace abbe
