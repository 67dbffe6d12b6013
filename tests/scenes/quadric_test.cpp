// Cylinders, cones and paraboloids in scenes whose light is known.
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "tests/scenes/scene_fixture.h"

namespace abbe {
namespace {

// The film of a point at that height of the z axis, or of a pinhole camera, relative to that in light of
// radiance 1 from everywhere; irradiances are divided by pi.
struct Measured {
  double mean;
  double noise;  // 4.9 standard deviations
};
Measured measured(const std::string& camera, int pixels, const std::string& content) {
  const auto film_of = [&](const std::string& lit) {
    return render(test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {},
    "sensor": {{"resolution": [{}, {}], "response": "energy", "channels": {{"all": 1}}}},
    "materials": {{"glass": {{"dielectric": {{"ior": 1.5}}}}, "mirror": {{"mirror": {{"reflectance": 1}}}},
                   "black": {{"diffuse": {{"reflectance": 0}}}}}},
    {},
    "render": {{"samples": {}, "max_depth": 200, "roulette_depth": -1, "integrator": "path"}}}})",
                                              camera, pixels, pixels, lit, 65'536 / (pixels * pixels))),
                  {})
        .film;
  };
  const Film unit = film_of(R"("lights": [{"environment": {}, "emission": {"spectrum": 1}}])");
  const Film film = film_of(content);
  const test::Region found = test::whole(film);
  const double one = test::whole(unit).mean;
  return {found.mean / one, 4.9 * std::sqrt(found.variance) / one};
}
std::string probe(double z, int facing) {
  return fmt::format(R"({{"irradiance_probe": {{"at": [0, 0, {}], "normal": [0, 0, {}]}}}})", z, facing);
}

TEST(Quadrics, SolidsOfGlassAreInvisibleInAFurnace) {
  const std::string camera =
      R"({"pinhole": {"fov_deg": 24}, "from": [0.3, 1.5, -4], "to": [0, 0, 0], "up": [0, 1, 0]})";
  for (const char* solid :
       {R"("cylinder": {"from": [0, -0.6, 0.1], "to": [0.1, 0.6, 0], "radius": 0.5, "caps": true})",
        R"("cone": {"base": [0, -0.6, 0.1], "apex": [0.1, 0.6, 0], "radius": 0.6, "caps": true})"}) {
    const Measured film =
        measured(camera, 8,
                 fmt::format(R"("lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
                       "shapes": [{{{}, "material": "glass"}}])",
                             solid));
    EXPECT_NEAR(film.mean, 1, film.noise + 5e-3) << solid;
    EXPECT_LT(film.noise, 0.03);
  }
}

// The tube is seen between its near and its far opening. A disc of radius r at the distance d fills the
// fraction r^2/(r^2 + d^2) of the irradiance.
TEST(Quadrics, AShiningTubeLightsItsAxis) {
  const Measured film =
      measured(probe(0, 1), 1,
               R"("shapes": [{"cylinder": {"from": [0, 0, 0.5], "to": [0, 0, 1.5], "radius": 0.7},
                                 "material": "black", "emission": {"spectrum": 1}, "two_sided": true}])");
  const auto opening = [](double distance) { return 0.49 / (0.49 + distance * distance); };
  EXPECT_NEAR(film.mean, opening(0.5) - opening(1.5), film.noise + 1e-3);
  EXPECT_LT(film.noise, 0.03);
}

// From below its base, a cone that shines outwards shows its base alone, which is a disc.
TEST(Quadrics, AShiningSolidConeIsADiscFromBelow) {
  const Measured film =
      measured(probe(0, 1), 1,
               R"("shapes": [{"cone": {"base": [0, 0, 0.8], "apex": [0, 0, 2], "radius": 0.6, "caps": true},
                                 "material": "black", "emission": {"spectrum": 1}}])");
  EXPECT_NEAR(film.mean, 0.36 / (0.36 + 0.64), film.noise + 1e-3);
  EXPECT_LT(film.noise, 0.03);
}

// All of a parabolic mirror looks as bright as the sun from its focus. The rim, at (1, 0.25) for a focal
// length of 1, is seen at an angle of sine 0.8 to the axis.
TEST(Quadrics, AParabolicMirrorConcentratesTheSun) {
  const Measured film = measured(
      probe(1, -1), 1,
      R"("lights": [{"sun": {"towards": [0, 0, 1], "angular_diameter_deg": 20}, "emission": {"spectrum": 1}}],
         "shapes": [{"paraboloid": {"vertex": [0, 0, 0], "axis": [0, 0, 1], "focal_length": 1, "radius": 1}, "material": "mirror"}])");
  EXPECT_NEAR(film.mean, 0.64, film.noise + 1e-3);
  EXPECT_LT(film.noise, 0.03);
}

}  // namespace
}  // namespace abbe
