// Meters so small that few photons come to them by chance, behind specular shapes, against what can be told
// by hand.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <ImathVec.h>

#include "tests/scenes/meter_fixture.h"
#include "tests/tier.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

// What a meter reads by photons beside path tracing, of several seeds, each within a few per cent for
// certain.
void expect_irradiance(const std::string& scene, double expected, int samples = 64, double margin = 0.03) {
  const test::OnlyMeter only = test::only_meter(scene, {{"/render/samples", std::to_string(samples)}});
  RenderOptions how;
  how.guides = std::make_shared<const GuidingData>(make_trained_plan(only.scene, 1).guides);
  for (std::uint64_t seed = 0; seed < (test::nightly() ? 4 : 2); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene seeded = only.scene;
    seeded.render.seed = seed;
    test::expect_equal(read_meter(only.meter, render(seeded, how).film, seeded.exposure_s).whole.radiant,
                       expected, margin);
  }
}

// The part of unpolarised light that a smooth face reflects [Born1999, sec. 1.5.2].
double reflectance(double ior, double cosine) {
  const double within = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
  const double s = (cosine - ior * within) / (cosine + ior * within);
  const double p = (ior * cosine - within) / (ior * cosine + within);
  return (s * s + p * p) / 2;
}

// What stands at (0.2, 0.1, 0), behind panes.
std::string window(const std::string& meter, const std::string& lamps) {
  return R"({"abbe": 1, "meters": {"m": )" + meter +
         R"(}, "materials": {"pane": {"thin_glass": {"ior": 1.5}}},
    "shapes": [{"quad": {"corner": [-1, -1, 1], "edge_u": [1.05, 0, 0], "edge_v": [0, 2, 0]}, "material": "pane"},
               {"quad": {"corner": [0.05, -1, 1], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}, "material": "pane"}],
    "lights": [)" +
         lamps + "]}";
}

std::string disc(double radius) {
  return R"({"disc": {"center": [0.2, 0.1, 0], "normal": [0, 0, 1], "radius": )" + std::to_string(radius) +
         "}}";
}

// What comes there of a lamp of 1 W/sr: cos/d^2 times (1 - R)/(1 + R) of two faces.
double behind_window(const Imath::V3d& lamp) {
  const Imath::V3d way = lamp - Imath::V3d(0.2, 0.1, 0);
  const double cosine = way.z / way.length();
  const double reflected = reflectance(1.5, cosine);
  return cosine / way.length2() * (1 - reflected) / (1 + reflected);
}

constexpr const char* kPoint =
    R"({"point": {"at": [0, 0, 4]}, "emission": {"illuminant": "E", "intensity": 1}})";

TEST(SmallMeter, ReadsALampThroughAWindow) {
  for (const double radius : {0.01, 0.003}) {
    SCOPED_TRACE("radius " + std::to_string(radius));
    expect_irradiance(window(disc(radius), kPoint), behind_window({0, 0, 4}));
  }
  const std::string bulb =
      R"({"sphere": {"center": [0, 0, 4], "radius": 0.03}, "emission": {"illuminant": "E", "irradiance": 1, "distance": 1}})";
  expect_irradiance(window(disc(0.01), bulb), behind_window({0, 0, 4}), test::by_night(1024, 512), 0.08);
}

// Of the pilots few set out from the weaker lamps.
TEST(SmallMeter, ReadsStrongAndWeakLampsThroughAWindow) {
  const std::string weaker =
      R"(, {"point": {"at": [-1.5, 0.5, 3]}, "emission": {"illuminant": "E", "intensity": 0.3}},
          {"point": {"at": [3, 0, 2]}, "emission": {"illuminant": "E", "intensity": 0.05}})";
  const std::string quad =
      R"({"quad": {"corner": [0.197, 0.098, 0], "edge_u": [0.006, 0, 0], "edge_v": [0, 0.004, 0]}})";
  expect_irradiance(
      window(quad, kPoint + weaker),
      behind_window({0, 0, 4}) + 0.3 * behind_window({-1.5, 0.5, 3}) + 0.05 * behind_window({3, 0, 2}));
}

// A pool of 10 x 10 x 2 m in a beam 60 degrees off the vertical, or in the sun, and a disc of 5 cm that lies
// 1 m deep. Black walls stand within the water, so that its bottom and sides reflect nothing. In front of
// walls outside they would add 0.4 % by two weak reflections, which no pilot photon finds.
std::string pool(const std::string& light, const std::string& center) {
  const std::string wall = R"(, "material": "black"}, {"quad": {"corner": )";
  return R"({"abbe": 1, "meters": {"m": {"disc": {"center": )" + center +
         R"(, "normal": [0, 0, 1], "radius": 0.05}}},
    "materials": {"water": {"dielectric": {"ior": 1.333}}, "black": {"diffuse": {"reflectance": 0}}},
    "shapes": [{"mesh": {"vertices": [[-5, -5, -2], [5, -5, -2], [-5, 5, -2], [5, 5, -2], [-5, -5, 0], [5, -5, 0], [-5, 5, 0], [5, 5, 0]],
                         "triangles": [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]}, "material": "water"},
               {"quad": {"corner": [-4.99, -4.99, -1.99], "edge_u": [9.98, 0, 0], "edge_v": [0, 9.98, 0]})" +
         wall + R"([-4.99, -4.99, -1.99], "edge_u": [0, 9.98, 0], "edge_v": [0, 0, 1.99]})" + wall +
         R"([4.99, -4.99, -1.99], "edge_u": [0, 9.98, 0], "edge_v": [0, 0, 1.99]})" + wall +
         R"([-4.99, -4.99, -1.99], "edge_u": [9.98, 0, 0], "edge_v": [0, 0, 1.99]})" + wall +
         R"([-4.99, 4.99, -1.99], "edge_u": [9.98, 0, 0], "edge_v": [0, 0, 1.99]}, "material": "black"}],
    "lights": [{")" +
         light +
         R"(": {"towards": [0.8660254, 0, 0.5]}, "emission": {"illuminant": "E", "irradiance": 1}}]})";
}

TEST(SmallMeter, ReadsTheSunUnderWater) {
  const double expected = 0.5 * (1 - reflectance(1.333, 0.5));
  for (const auto& [light, center] :
       {std::pair("directional", "[0, 0, -1]"), {"directional", "[-2, 2, -1]"}, {"sun", "[1.3, -0.7, -1]"}}) {
    if (!test::nightly() && center == std::string("[0, 0, -1]")) continue;  // by day off the middle alone
    SCOPED_TRACE(std::string(light) + " at " + center);
    expect_irradiance(pool(light, center), expected);
  }
}

}  // namespace
}  // namespace abbe
