#include "lens/beam.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lens/paraxial.h"
#include "lenses.h"

namespace abbe::lens {
namespace {

using Imath::V2d;

TEST(LensBeam, StopIsWhereTheListedMarginalRayPasses) {
  EXPECT_NEAR(stop_radius(test::double_gauss_of(test::kResolvedIndices)), 15.702464, 1e-6);
}

TEST(LensBeam, RaysPassTheStopWhereTheyAreAimed) {
  for (const char* name : {"double_gauss", "cooke_triplet", "achromat", "landscape", "tessar", "fisheye"}) {
    const System system = test::lens_named(name);
    const double radius = stop_radius(system);
    for (const double nm : system.wavelengths_nm)
      for (const double field : system.fields) {
        const SystemAt at(system, nm);
        const auto beam = Beam::of(at, field, radius);
        ASSERT_TRUE(beam) << name << ' ' << field;
        for (const V2d& pupil : {V2d(0, 0), V2d(0.5, -0.5), V2d(-0.7, 0)}) {
          const auto launched = beam->aim(pupil);
          ASSERT_TRUE(launched) << name << ' ' << field << ' ' << pupil.x << ' ' << pupil.y;
          const auto passed = beam->pupil_of(*launched);
          ASSERT_TRUE(passed);
          EXPECT_LT((*passed - pupil).length(), 1e-9) << name << ' ' << field;
        }
      }
  }
}

TEST(LensBeam, BoundsHoldTheStop) {
  const System system = test::lens_named("double_gauss");
  const SystemAt at(system, 587.6);
  const auto beam = Beam::of(at, 10, stop_radius(system));
  ASSERT_TRUE(beam);
  const Imath::Box2d box = beam->bounds();
  for (int i = 0; i < 200; ++i) {
    const auto launched = beam->aim({std::cos(0.0314159 * i), std::sin(0.0314159 * i)});
    ASSERT_TRUE(launched);
    EXPECT_TRUE(box.intersects(*launched));
  }
  EXPECT_LT(box.size().x, 1.1 * 50);
}

TEST(LensBeam, FieldsBeyondTheLensHaveNone) {
  const System system = test::lens_named("cooke_triplet");
  const SystemAt at(system, 550);
  EXPECT_FALSE(Beam::of(at, 100, stop_radius(system)));
}

// Light from a near point spreads: the projected solid angle of a disc is pi r^2/(r^2 + d^2).
TEST(LensBeam, NearObjectsFillTheirSolidAngle) {
  System hole;
  hole.surfaces.resize(1);
  hole.surfaces[0].thickness_mm = 10;
  hole.aperture = {ApertureKind::stop, 20};
  hole.object_distance_mm = 30;
  const SystemAt at(hole, 550);
  const auto beam = Beam::of(at, 0, 20);
  ASSERT_TRUE(beam);
  double sum = 0;
  const double cell = 0.1;
  for (double x = -20 + cell / 2; x < 20; x += cell)
    for (double y = -20 + cell / 2; y < 20; y += cell)
      if (x * x + y * y < 400) sum += beam->density({x, y}) * cell * cell;
  EXPECT_NEAR(sum / (3.14159265358979 * 400 / (400 + 900)), 1, 1e-3);
}

// A stop in the back focus, or so near to it that the entrance pupil is 50 km away. All chief rays of a near
// object are parallel to the axis and cross the first vertex at the height of their point.
TEST(LensBeam, TelecentricObjectSpaceHasBeamsOfNearObjects) {
  System system = test::sound_lens_of(R"({"object_distance": 100, "focus": "paraxial", "surfaces": [
    [50, 3, 1.5], [-50, 49.494949494949495], {"stop": true, "aperture": 0.5, "thickness": 50}]})");
  for (const double gap : {49.494949494949495, 49.494951, 49.49485}) {
    system.surfaces[1].thickness_mm = gap;
    const SystemAt at(system, 550);
    ASSERT_GT(std::abs(first_order(at).entrance_pupil_mm), 1e7);
    const auto beam = Beam::of(at, 0.2, 0.5);
    ASSERT_TRUE(beam);
    EXPECT_NEAR(beam->chief().x, 0, 1e-9);
    EXPECT_NEAR(beam->chief().y, 0.2, 1e-3);
    const auto launched = beam->aim({0, 1});
    ASSERT_TRUE(launched);
    EXPECT_NEAR((beam->pupil_of(*launched).value() - V2d(0, 1)).length(), 0, 1e-9);
    // u = y_stop/f at the object: half a millimetre of the stop is 0.99 mm of the first vertex.
    EXPECT_NEAR(launched->y - beam->chief().y, 0.5 / 50.505050505050505 * 100, 0.01);
  }
}

}  // namespace
}  // namespace abbe::lens
