// Lamps of extreme sizes, places and spectra, each against its closed form.
#include <cmath>

#include <fmt/format.h>

#include "tests/angles.h"
#include "tests/scenes/scene_fixture.h"

namespace abbe {
namespace {

double mean(const RenderResult& result) {
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  return test::whole(result.film).mean;
}

// Stress 24: a meter below a ball of radiance 1/nm on the band, at a distance from its middle.
TEST(Stress, LampsOfAnySizeIrradiateByTheirSolidAngle) {
  for (const double radius : {1e-6, 1.0, 1e6}) {
    const double distance = radius + std::max(1.0, radius / 4);
    const Scene scene = test::load_text(fmt::format(
        R"({{"abbe": 1, "camera": {{"irradiance_probe": {{"at": [0, 0, 0], "normal": [0, 0, 1]}}}},
             "sensor": {{"resolution": [4, 4], "response": "energy", "channels": {{"all": {{"band": [500, 600]}}}}}},
             "lights": [{{"sphere": {{"center": [0, 0, {}], "radius": {}}}, "emission": {{"spectrum": {{"band": [500, 600]}}}}}}],
             "render": {{"samples": 1024}}}})",
        distance, radius));
    const double share = radius / distance;
    EXPECT_NEAR(mean(render(scene, {})) / (100 * kPi * share * share), 1, 1e-3) << radius;
  }
}

// Stress 25: a bulb 1e-5 above a card, of which the camera sees a square of ten times that around it. What
// falls on a square is the solid angle that it takes up.
TEST(Stress, ABulbNextToASurfaceIsFiniteAndUnbiased) {
  constexpr double kHeight = 1e-5;
  constexpr double kHalf = 1e-4;
  const Scene scene = test::load_text(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": {}, "f_number": 1}}, "from": [0, 0, 1], "to": [0, 0, 0], "up": [0, 1, 0]}},
           "sensor": {{"resolution": [8, 8], "response": "energy", "channels": {{"all": {{"band": [500, 600]}}}}}},
           "materials": {{"card": {{"diffuse": {{"reflectance": 1}}}}}},
           "shapes": [{{"quad": {{"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}}, "material": "card"}}],
           "lights": [{{"point": {{"at": [0, 0, {}]}}, "emission": {{"spectrum": {{"band": [500, 600]}}}}}}],
           "render": {{"samples": 16384, "max_depth": 1, "integrator": "path"}}}})",
      2 * std::atan(kHalf) * 180 / kPi, kHeight));
  const RenderResult result = render(scene, {});
  const Film::Average found = result.film.average(0);
  const double solid_angle =
      4 * std::atan(kHalf * kHalf / (kHeight * std::sqrt(2 * kHalf * kHalf + kHeight * kHeight)));
  const double radiance = 100 * solid_angle / (4 * kHalf * kHalf) / kPi;
  const double expected = radiance * kPi / 4;  // on the film of an f/1 pinhole
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  EXPECT_LT(found.standard_error, 0.01 * expected);
  EXPECT_LT(std::abs(found.mean - expected), 5 * found.standard_error) << found.mean / expected;
}

Scene dome(const std::string& channel, const std::string& emission) {
  return test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 1, "f_number": 4}}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [16, 16], "response": "energy", "channels": {{"all": {}}}}},
    "lights": [{{"environment": {{}}, "emission": {}}}], "render": {{"samples": 64}}}})",
                                     channel, emission));
}

// Stress 28: all the power of a line a picometre wide, beside light of the whole range.
TEST(Stress, ALineOfAPicometreKeepsItsEnergy) {
  const double broad = mean(render(dome("1", R"({"spectrum": 1})"), {}));
  for (const double nm : {300.5, 546.074, 1099.0}) {
    const std::string line =
        fmt::format(R"({{"lines": [{{"nm": {}, "width_nm": 0.001, "power": 800}}]}})", nm);
    EXPECT_NEAR(mean(render(dome("1", line), {})) / broad, 1, 1e-3) << nm;
    const std::string both = fmt::format(R"({{"spectrum": {{"sum": [1, {}]}}}})", line);
    EXPECT_NEAR(mean(render(dome("1", both), {})) / broad, 2, 2e-3) << nm;
  }
}

// Stress 29: the light of the Cornell box behind filters of 10 nm, against sums at a hundredth of a
// nanometre.
TEST(Stress, TenNanometreFiltersWeighAsQuadratureDoes) {
  const double broad = mean(render(dome("1", R"({"spectrum": 1})"), {})) / 800;
  for (const char* lamp : {"cornell_box_light", "FL11", "LED-B3"})
    for (const int nm : {450, 550, 650}) {
      const Scene scene = dome(fmt::format(R"({{"band": [{}, {}]}})", nm - 5, nm + 5),
                               fmt::format(R"({{"illuminant": "{}", "radiance": 1000}})", lamp));
      double sum = 0;
      for (int i = 0; i < 1000; ++i)
        sum += 0.01 *
               scene.lights[0].emission(SampledSpectrum(static_cast<float>(nm - 5 + 0.01 * (i + 0.5))))[0];
      EXPECT_NEAR(mean(render(scene, {})) / broad / sum, 1, 1e-3) << lamp << ' ' << nm;
    }
}

}  // namespace
}  // namespace abbe
