#include <array>
#include <cmath>
#include <ostream>
#include <string>
#include <string_view>

#include "tests/angles.h"
#include "tests/scenes/meter_fixture.h"
#include "tests/tier.h"

// What meters read, against what can be told by hand, by every integrator.

namespace abbe {
namespace {

using test::expect_equal;
using test::read;

// A scene of one meter and what else there is.
std::string scene_of(const std::string& meter, const std::string& rest,
                     const std::string& integrator = "path", int samples = 64) {
  return R"({"abbe": 1, "meters": {"m": )" + meter + "}, " + rest + R"(, "render": {"integrator": ")" +
         integrator + R"(", "samples": )" + std::to_string(samples) + "}}";
}

// Of 1000 lm, off the middle.
constexpr const char* kBulb =
    R"("lights": [{"point": {"at": [0.3, -0.2, 0.1]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}])";
constexpr const char* kSky = R"("lights": [{"environment": {}, "emission": {"spectrum": 2}}])";

TEST(Meter, ASphereAroundALampTakesItsFlux) {
  const auto sphere = [](const char* facing) {
    return std::string(R"({"measures": "flux", "sphere": {"center": [0, 0, 0], "radius": 1, "facing": ")") +
           facing + R"("}})";
  };
  const MeterReading inwards = read(scene_of(sphere("inwards"), kBulb));
  expect_equal(inwards.whole.luminous, 1000);
  EXPECT_EQ(read(scene_of(sphere("outwards"), kBulb)).whole.luminous.mean, 0) << "its back is to the lamp";
  // Of a spectrum that is even from 300 to 1100 nm a watt has in the mean 700 nm over hc photons per second.
  EXPECT_NEAR(inwards.whole.photons.mean / inwards.whole.radiant.mean / (700e-9 / 1.98644586e-25), 1, 1e-3);
}

struct OfTheSky {
  const char* meter;
  double expected;  // over the radiance
};
void PrintTo(const OfTheSky& of, std::ostream* out) {
  *out << of.meter;
}
class MeterInAnEvenSky : public ::testing::TestWithParam<OfTheSky> {};

// Whatever a meter is like, it tells the radiance L of an even sky: pi L of a hemisphere, pi sin^2 L of a
// cone about the normal.
TEST_P(MeterInAnEvenSky, TellsWhatItsSurfaceAndConeMakeOfIt) {
  const double radiance = 2.0 * 800;  // over all wavelengths
  expect_equal(read(scene_of(GetParam().meter, kSky)).whole.radiant, GetParam().expected * radiance);
}

const double kCone = 2 * kPi * (1 - std::cos(kPi / 9));
const double kSine2 = std::pow(std::sin(kPi / 9), 2);
INSTANTIATE_TEST_SUITE_P(
    Quantities, MeterInAnEvenSky,
    ::testing::Values(
        OfTheSky{R"({"at": [0, 0, 0], "normal": [0, 3, 4]})", kPi},
        OfTheSky{R"({"at": [0, 0, 0], "normal": [0, 3, 4], "acceptance_deg": 20})", kPi* kSine2},
        OfTheSky{R"({"measures": "radiance", "at": [0, 0, 0], "normal": [0, 3, 4], "acceptance_deg": 20})",
                 1},
        OfTheSky{
            R"({"measures": "radiance", "disc": {"center": [0, 0, 0], "normal": [1, 0, 0], "radius": 2}, "acceptance_deg": 0.1})",
            1},
        OfTheSky{
            R"({"measures": "flux", "quad": {"corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [1, 3, 0]}})",
            6 * kPi},
        OfTheSky{R"({"measures": "flux", "disc": {"center": [0, 0, 0], "normal": [1, 0, 0], "radius": 2}})",
                 4 * kPi* kPi},
        OfTheSky{R"({"measures": "flux", "sphere": {"center": [0, 0, 0], "radius": 0.5}})", kPi* kPi},
        OfTheSky{
            R"({"measures": "intensity", "disc": {"center": [0, 0, 0], "normal": [1, 0, 0], "radius": 2}, "acceptance_deg": 20})",
            4 * kPi* kPi* kSine2 / kCone}));

// From a disc as large as the cone at the lamp is wide, the flux within the cone is that of a lamp of even
// intensity: 1000 lm over all directions.
TEST(Meter, ADiscTellsTheIntensityOfALamp) {
  const auto meter = [](double acceptance) {
    return R"({"measures": "intensity", "disc": {"center": [0.3, -0.2, -2.9], "normal": [0, 0, 1], "radius": 1.5}, "acceptance_deg": )" +
           std::to_string(acceptance) + "}";
  };
  expect_equal(read(scene_of(meter(20), kBulb)).whole.luminous, 1000 / (4 * kPi));
}

struct By {
  const char* integrator;
  int samples;
  double margin = 0.02;
};
void PrintTo(const By& by, std::ostream* out) {
  *out << by.integrator;
}
class MeterBy : public ::testing::TestWithParam<By> {};

// A disc of radius 1 under a bright one of radius 0.6 at the distance 1, on one axis [Howell2010, C-41]; and
// what of its light comes within 20 degrees of the normal, by a sum over both discs.
double flux_between_discs(double least_cosine) {
  constexpr int kRadii = 200;
  constexpr int kTurns = 400;
  double sum = 0;
  for (int i = 0; i < kRadii; ++i)
    for (int j = 0; j < kRadii; ++j)
      for (int k = 0; k < kTurns; ++k) {
        const double a = (i + 0.5) / kRadii;
        const double b = 0.6 * (j + 0.5) / kRadii;
        const double d2 = 1 + a * a + b * b - 2 * a * b * std::cos(2 * kPi * (k + 0.5) / kTurns);
        if (1 / std::sqrt(d2) > least_cosine) sum += a * b / (d2 * d2);
      }
  return sum * 0.6 / (kRadii * kRadii) * 2 * kPi * 2 * kPi / kTurns;
}

TEST_P(MeterBy, TellsTheFluxBetweenDiscs) {
  const std::string_view by = GetParam().integrator;
  if (!test::nightly() && by != "path" && by != "light") GTEST_SKIP() << "takes long";
  const std::string lamp =
      R"("lights": [{"disc": {"center": [0, 0, 1], "normal": [0, 0, -1], "radius": 0.6}, "emission": {"illuminant": "E", "luminance": 1}}])";
  const std::string disc =
      R"({"measures": "flux", "disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1})";
  const auto& [integrator, samples, margin] = GetParam();
  // F = (S - sqrt(S^2 - 4 (R_lamp/R)^2)) / 2 with S = 1 + (1 + R_lamp^2) / R^2, of the lower disc.
  const double s = 1 + 1.36;
  const double whole = kPi * kPi * (s - std::sqrt(s * s - 4 * 0.36)) / 2;
  EXPECT_NEAR(flux_between_discs(0) / whole, 1, 1e-4);
  expect_equal(read(scene_of(disc + "}", lamp, integrator, samples)).whole.luminous, whole, margin);
  const double within = flux_between_discs(std::cos(kPi / 9));
  expect_equal(read(scene_of(disc + R"(, "acceptance_deg": 20})", lamp, integrator, samples)).whole.luminous,
               within, margin);
}

INSTANTIATE_TEST_SUITE_P(Integrators, MeterBy,
                         ::testing::Values(By{"path", 64}, By{"light", 64}, By{"bdpt", 64}, By{"vcm", 256},
                                           By{"photon-map", 128}, By{"adjoint-brute", 256, 0.05},
                                           By{"photon-brute", 64}));

// A bulb of 1000 lm: a point in the middle of a shell of glass that absorbs. What its faces of reflectance R
// and its glass of transmittance tau throw back comes to the shell again; all else leaves it.
TEST(NightlyMeter, PhotonsTellTheFluxOfALampWithinGlass) {
  constexpr double kReflectance = 0.04;
  constexpr double kAbsorption_per_m = 20;
  constexpr double kThickness = 0.02;
  const double tau = std::exp(-kAbsorption_per_m * kThickness);
  const double between = 1 - std::pow(kReflectance * tau, 2);
  const double through = std::pow(1 - kReflectance, 2) * tau / between;
  const double thrown_back = kReflectance * (1 + std::pow((1 - kReflectance) * tau, 2) / between);
  const std::string bulb =
      R"("lights": [{"point": {"at": [0, 0, 0]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}],
    "materials": {"glass": {"dielectric": {"ior": 1.5, "absorption_per_m": 20}}, "air": {"dielectric": {"ior": 1}, "priority": 1}},
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.07}, "material": "glass"},
               {"sphere": {"center": [0, 0, 0], "radius": 0.05}, "material": "air"}])";
  const std::string sphere =
      R"({"measures": "flux", "sphere": {"center": [0.1, 0, 0], "radius": 0.3, "facing": "inwards"}})";
  for (const char* integrator : {"auto", "light", "photon-brute"})
    expect_equal(read(scene_of(sphere, bulb, integrator)).whole.luminous, 1000 * through / (1 - thrown_back));
}

// A lamp of 1000 lm in a bulb in a grey ball of 1 m: nothing else absorbs, so that the wall sends back what
// it takes, rho/(1 - rho) of the flux, in even radiance everywhere.
TEST(NightlyMeter, PathsAndPhotonsShareTheLightOfALampWithinGlass) {
  const std::string bulb =
      R"("lights": [{"sphere": {"center": [0, 0, 0], "radius": 0.03}, "material": "white", "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}],
    "materials": {"glass": {"dielectric": {"ior": 1.5}}, "air": {"dielectric": {"ior": 1}, "priority": 1},
                  "white": {"diffuse": {"reflectance": 1}}, "wall": {"diffuse": {"reflectance": 0.5}}},
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.07}, "material": "glass"},
               {"sphere": {"center": [0, 0, 0], "radius": 0.05}, "material": "air"},
               {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "wall"}])";
  const std::string sphere =
      R"({"measures": "flux", "sphere": {"center": [0.02, 0, 0], "radius": 0.5, "facing": "inwards"}})";
  const double flux = 1000 + 0.25 * 1000 * 0.5 / (1 - 0.5);
  expect_equal(read(scene_of(sphere, bulb, "light")).whole.luminous, flux);
  const LightReading shared = read(scene_of(sphere, bulb, "auto", 512)).whole;
  EXPECT_LT(shared.luminous.standard_error, 0.01 * flux);
  expect_equal(shared.luminous, flux, 0.03);
}

// A black ball of 0.1 m above a disc, and beside a sphere, of 1 m: photons from afar must not be sent to the
// ball alone.
TEST(NightlyMeter, SunlightReachesWhatIsBeyondTheShapes) {
  const std::string sun =
      R"("lights": [{"sun": {"towards": [0, 0, 1], "illuminance": 1}}], "materials": {"black": {"diffuse": {"reflectance": 0}}},
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.1}, "material": "black"}])";
  const std::string disc = R"({"disc": {"center": [0, 0, -0.2], "normal": [0, 0, 1], "radius": 1}})";
  const std::string sphere = R"({"measures": "flux", "sphere": {"center": [2, 0, 0], "radius": 1}})";
  for (const char* integrator : {"path", "light", "photon-brute"}) {
    expect_equal(read(scene_of(disc, sun, integrator, 256)).whole.luminous, 0.99);
    expect_equal(read(scene_of(sphere, sun, integrator, test::by_night(256, 128))).whole.luminous, kPi);
  }
}

// The flux of a bulb of 1000 lm through a quad at the distance h is that of four rectangles a x b with a
// corner under the bulb, which are seen from there at the solid angle atan(a b / (h sqrt(a^2 + b^2 + h^2))).
// No shape is there to tell that the bulb is near.
TEST(Meter, TakesALampBesideItsOwnSurfaceForNear) {
  constexpr double kHeight = 0.3;
  double solid_angle = 0;
  for (const double a : {0.25, 1.75})
    for (const double b : {0.25, 0.75})
      solid_angle += std::atan(a * b / (kHeight * std::sqrt(a * a + b * b + kHeight * kHeight)));
  const std::string quad =
      R"({"measures": "flux", "quad": {"corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 1, 0]}})";
  const std::string bulb =
      R"("lights": [{"point": {"at": [0.25, 0.25, 0.3]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}])";
  for (const char* integrator : {"auto", "light", "photon-brute"})
    expect_equal(read(scene_of(quad, bulb, integrator)).whole.luminous, 1000 * solid_angle / (4 * kPi));
}

// A card lit by a bulb 1.1 m above it.
TEST(Meter, RadianceIsThatOfWhatIsSeen) {
  const std::string card = std::string(kBulb) +
                           R"(, "materials": {"card": {"diffuse": {"reflectance": 0.5}}},
    "shapes": [{"quad": {"corner": [-9, -9, -1], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}, "material": "card"}])";
  const std::string meter =
      R"({"measures": "radiance", "at": [0.3, -0.2, 0], "normal": [0, 0, -1], "acceptance_deg": 0.5})";
  const double under_the_bulb = 1000 / (4 * kPi) / (1.1 * 1.1) * 0.5 / kPi;
  for (const char* integrator : {"path", "bdpt", "auto"})
    expect_equal(read(scene_of(meter, card, integrator)).whole.luminous, under_the_bulb, 0.01);
}

TEST(Meter, CellsAddUpToTheWhole) {
  const std::string meter =
      R"({"measures": "flux", "quad": {"corner": [-1, -1, -1], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}, "cells": [3, 2]})";
  const MeterReading reading = read(scene_of(meter, kBulb));
  ASSERT_EQ(reading.cells.size(), 6U);
  double sum = 0;
  for (const LightReading& cell : reading.cells) sum += cell.luminous.mean;
  EXPECT_NEAR(sum / reading.whole.luminous.mean, 1, 1e-6);
  EXPECT_GT(reading.cells[1].luminous.mean, reading.cells[0].luminous.mean);
  EXPECT_GT(reading.cells[2].luminous.mean, reading.cells[0].luminous.mean) << "the lamp is on that side";
  EXPECT_GT(reading.cells[1].luminous.mean, reading.cells[4].luminous.mean) << "rows follow edge_v";
}

TEST(Meter, SpectrumIsPerNm) {
  const std::string meter =
      R"({"at": [0, 0, 0], "normal": [0, 0, 1], "spectrum": {"from_nm": 400, "to_nm": 700, "step_nm": 100}})";
  const MeterReading reading = read(scene_of(
      meter,
      R"("lights": [{"environment": {}, "emission": {"spectrum": {"band": [450, 600], "value": 2}}}])"));
  ASSERT_EQ(reading.spectrum.size(), 3U);
  for (const auto& [bin, share] : {std::pair(0, 0.5), {1, 1.0}})
    EXPECT_NEAR(reading.spectrum[static_cast<std::size_t>(bin)].mean, 2 * kPi * share,
                5 * reading.spectrum[static_cast<std::size_t>(bin)].standard_error + 1e-5);
  EXPECT_EQ(reading.spectrum[2].mean, 0);
}

// Over a lamp that crosses at height 1 from x = -1 to 1 while the shutter is open, the mean of
// (1 + x^2)^(-3/2) is the root of a half.
TEST(Meter, ReadsTheMeanWhileTheShutterIsOpen) {
  const std::string moving = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -9, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [4, 4], "observer": "1931", "exposure_s": 0.5, "shutter": {"open_s": 2, "row_delay_s": 0.1}},
    "meters": {"m": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
    "lights": [{"point": {"at": [0, 0, 1]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000},
                "motion": {"keyframes": [{"time_s": 2, "translate": [-1, 0, 0]}, {"time_s": 2.5, "translate": [1, 0, 0]}]}}],
    "render": {"integrator": "path", "samples": 64}})";
  expect_equal(read(moving).whole.luminous, 1000 / (4 * kPi) / std::sqrt(2.0));
}

// On a board that leans, under a lamp along its normal: nothing of the board stands in the meter's light.
TEST(NightlyMeter, StandsOffTheSurfaceItLiesOn) {
  const std::string board =
      R"({"corner": [0, 0, 0], "edge_u": [1, 0.2, 0], "edge_v": [-0.1, 0.9998476952, 0.0174524064]})";
  const std::string lamp =
      R"("lights": [{"point": {"at": [0.4, 0.5, 1]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}])";
  const std::string black =
      R"(, "materials": {"black": {"diffuse": {"reflectance": 0}}}, "shapes": [{"quad": )" + board +
      R"(, "material": "black"}])";
  const std::string meter = R"({"quad": )" + board + "}";
  const double bare = read(scene_of(meter, lamp)).whole.luminous.mean;
  for (const char* integrator : {"path", "light", "photon-brute"})
    expect_equal(read(scene_of(meter, lamp + black, integrator, 256)).whole.luminous, bare);
}

// Inwards on the surface of a ball of ink around a lamp, and outwards on a black ball in an even sky.
TEST(Meter, SpheresStandOffTheBallsTheyLieOn) {
  const auto ball = [](const std::string& material) {
    return R"(, "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 2}, "material": ")" + material +
           R"("}], "materials": {"ink": {"medium": {"absorption_per_m": 1}}, "black": {"diffuse": {"reflectance": 0}}})";
  };
  const std::string lamp =
      R"("lights": [{"point": {"at": [0, 0, 0]}, "emission": {"illuminant": "E", "luminous_flux_lm": 1000}}])";
  const std::string within =
      R"({"measures": "flux", "sphere": {"center": [0, 0, 0], "radius": 2, "facing": "inwards"}})";
  expect_equal(read(scene_of(within, lamp + ball("ink"))).whole.luminous, 1000 * std::exp(-2));
  const std::string without = R"({"sphere": {"center": [0, 0, 0], "radius": 2}})";
  expect_equal(read(scene_of(without, kSky + ball("black"))).whole.radiant, kPi * 1600);
}

// Half of the meter is in ink: it reads the mean of its halves.
TEST(Meter, MayStandInSeveralKindsOfMatter) {
  const std::string ink = std::string(kSky) +
                          R"(, "materials": {"ink": {"medium": {"absorption_per_m": 1}}},
    "shapes": [{"sphere": {"center": [5, 0, 0], "radius": 5}, "material": "ink"}])";
  const auto from_to = [&](double from, double to) {
    const std::string quad = R"({"quad": {"corner": [)" + std::to_string(from) +
                             R"(, -0.5, 0], "edge_u": [)" + std::to_string(to - from) +
                             R"(, 0, 0], "edge_v": [0, 1, 0]}})";
    return read(scene_of(quad, ink)).whole.radiant;
  };
  const Film::Average inside = from_to(0, 1);
  const Film::Average outside = from_to(-1, 0);
  EXPECT_LT(inside.mean, 0.5 * outside.mean);
  expect_equal(from_to(-1, 1), (inside.mean + outside.mean) / 2);
}

// A pane close to a spot passes (1 - R)/(1 + R) = 2n/(n^2 + 1) of it along the normal, whichever way it
// shines.
TEST(Meter, TakesAllOfANarrowBeamThroughAPane) {
  for (const auto& [at, direction, disc] :
       {std::array{"[0.13, 0.07, 5]", "[0, 0, -1]", R"("center": [0, 0, -3], "normal": [0, 0, 1])"},
        std::array{"[0.13, 0.07, -5]", "[0, 0, 1]", R"("center": [0, 0, 3], "normal": [0, 0, -1])"}}) {
    const std::string rest =
        R"("materials": {"pane": {"thin_glass": {"ior": 1.5}}}, "shapes": [{"quad": {"corner": [-10, -10, 0],
      "edge_u": [20, 0, 0], "edge_v": [0, 20, 0]}, "material": "pane"}], "lights": [{"spot": {"at": )" +
        std::string(at) + R"(, "direction": )" + direction +
        R"(, "half_angle_deg": 0.1}, "emission": {"illuminant": "E", "radiant_flux_W": 1}}])";
    SCOPED_TRACE(direction);
    expect_equal(read(scene_of(R"({"measures": "flux", "disc": {)" + std::string(disc) + R"(, "radius": 1}})",
                               rest, "auto", test::by_night(2048, 512)))
                     .whole.radiant,
                 3.0 / 3.25);
  }
}

}  // namespace
}  // namespace abbe
