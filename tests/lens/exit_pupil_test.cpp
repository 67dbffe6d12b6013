#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "lens/beam.h"
#include "lens/exit_pupil.h"
#include "lens/paraxial.h"
#include "lenses.h"
#include "tests/tier.h"

// Rays of a camera through a lens agree with those of the optical bench, are reversible, and stay inside the
// bounds of the pupil.

namespace abbe::lens {
namespace {

using Imath::V2d;
using Imath::V3d;

class ShippedLens : public ::testing::TestWithParam<std::string> {
 protected:
  System lens = abbe::test::lens_named(GetParam());
  SpectralSystem system{lens, stop_radius(lens)};
  // Image height of the second widest field, or of 12 degrees.
  double image_height = std::abs(first_order(SystemAt(lens, lens.primary_nm())).focal_length_mm) * 0.21;
  std::mt19937 numbers{7};
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(numbers); }
};

TEST_P(ShippedLens, IsTracedAsOnTheBench) {
  int passed = 0;
  for (int i = 0; i < 4000; ++i) {
    const double nm = uniform(400, 700);
    const SystemAt at(system.system(), nm);
    const double angle = uniform(-0.2, 0.2);
    const Ray ray{
        {uniform(-0.5, 0.5) * system.stop_radius_mm(), uniform(-1, 1) * system.stop_radius_mm(), -5},
        {0, std::sin(angle), std::cos(angle)}};
    const RayPath path = trace(at, ray, Apertures::obeyed);
    const auto there = system.to_image(ray, nm);
    ASSERT_EQ(path.reached(), there.has_value());
    if (!there) continue;
    ++passed;
    EXPECT_LT((there->point - V2d(path.last.origin.x, path.last.origin.y)).length(), 1e-4);
    EXPECT_NEAR(there->transmittance / transmittance(at, ray, path), 1, 1e-6);
    const Ray back{{there->point.x, there->point.y, system.image_z()}, -there->direction};
    const auto out = system.to_object(back, nm);
    ASSERT_TRUE(out);
    EXPECT_LT((out->direction + ray.direction).length(), 1e-9) << "the way back";
    EXPECT_LT((out->origin - ray.origin).cross(ray.direction).length(), 1e-9 * (1 + image_height));
  }
  EXPECT_GT(passed, 200);
}

// True if a clear aperture limits a surface, so that no ray passes after it and its neighbour have crossed.
bool has_clear_apertures(const System& lens) {
  return std::all_of(lens.surfaces.begin(), lens.surfaces.end(),
                     [](const Surface& surface) { return surface.semi_aperture_mm.has_value(); });
}

// Clear apertures stop no light of the image, and transmit no more than that.
TEST_P(ShippedLens, EndsWhereTheLightOfItsPictureDoes) {
  System bare = lens;
  for (Surface& surface : bare.surfaces) surface.semi_aperture_mm.reset();
  bare.surfaces[bare.stop].semi_aperture_mm = system.stop_radius_mm();
  const V2d half(0.5 * image_height, 0.3 * image_height);
  const SpectralSystem open(bare, system.stop_radius_mm());
  const System ended = with_clear_apertures(open, half, 400, 700);
  std::vector<double> reach(ended.surfaces.size(), 0);
  const ExitPupil pupil(open, half, 400, 700);
  for (int i = 0; i < 20000; ++i) {
    const V2d image(uniform(-half.x, half.x), uniform(-half.y, half.y));
    const double nm = uniform(400, 700);
    const V2d to = pupil.bound(image).point(V2d(uniform(-1, 1), uniform(-1, 1)));
    const V3d from(image.x, image.y, open.image_z());
    const auto out = open.to_object({from, (V3d(to.x, to.y, open.last_z()) - from).normalized()}, nm);
    if (!out) continue;
    const RayPath path = trace(SystemAt(bare, nm), {out->origin, -out->direction}, Apertures::ignored);
    for (std::size_t k = 0; k < path.hits.size(); ++k)
      reach[k] = std::max(reach[k], open.local_of(k, path.hits[k].point).length());
  }
  for (std::size_t k = 0; k < reach.size(); ++k) {
    ASSERT_TRUE(ended.surfaces[k].semi_aperture_mm);
    EXPECT_GE(*ended.surfaces[k].semi_aperture_mm, reach[k] * (1 - 1e-3)) << "surface " << k + 1;
    EXPECT_LE(*ended.surfaces[k].semi_aperture_mm, reach[k] * 1.1) << "surface " << k + 1;
  }
}

// A triangle of blades has a corner, and so the widest beam, on one side only.
TEST_P(ShippedLens, EndsAllAroundWhereBladesLeaveACorner) {
  for (Surface& surface : lens.surfaces) surface.semi_aperture_mm.reset();
  const V2d half(0.5 * image_height, 0);
  const auto ended = [&] {
    return with_clear_apertures(SpectralSystem(lens, system.stop_radius_mm()), half, 400, 700);
  };
  const System round = ended();
  lens.surfaces[lens.stop].iris = Iris(kMinBlades, 90);
  const System bladed = ended();
  EXPECT_TRUE(bladed.surfaces[lens.stop].iris);
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
    EXPECT_EQ(*bladed.surfaces[k].semi_aperture_mm, *round.surfaces[k].semi_aperture_mm)
        << "surface " << k + 1;
}

// Rays over the last element and its surroundings, from the whole image, at wavelengths between those of the
// bounds. For lenses without clear apertures, rays slightly outside the bounds.
TEST_P(ShippedLens, LosesNothingByTheBoundsOfItsExitPupil) {
  const V2d half(image_height, 0.7 * image_height);
  const ExitPupil pupil(system, half, 400, 700);
  const double depth = system.image_z() - system.last_z();
  const PupilBound axial = pupil.bound({0, 0});
  const double reach = std::max({axial.semi.x, pupil.bound(half).center.length() + axial.semi.x, depth / 4});
  const bool whole = has_clear_apertures(system.system());
  int passed = 0;
  int inside = 0;
  for (int i = 0; i < 60000; ++i) {
    const V2d image = half * V2d(uniform(-1, 1), uniform(-1, 1));
    const V2d point = whole ? V2d(uniform(-reach, reach), uniform(-reach, reach))
                            : pupil.bound(image).point({uniform(-1.3, 1.3), uniform(-1.3, 1.3)});
    const double nm = uniform(400, 700);
    const V3d from(image.x, image.y, system.image_z());
    const auto out =
        system.to_object({from, (V3d(point.x, point.y, system.last_z()) - from).normalized()}, nm);
    const bool bound = pupil.bound(image).contains(point);
    inside += bound;
    if (!out) continue;
    ++passed;
    ASSERT_TRUE(bound) << point << " of the image at " << image << ", " << nm << " nm";
    const EntranceDisc& disc = pupil.entrance();
    const V3d in = out->origin + (disc.z - out->origin.z) / out->direction.z * out->direction;
    ASSERT_LT(std::hypot(in.x, in.y), disc.radius) << "comes in beside the disc";
    EXPECT_GT(depth / std::hypot(depth, (point - image).length()), pupil.min_cosine());
  }
  std::printf("%s: %d of %d rays within the bounds pass\n", GetParam().c_str(), passed, inside);
  EXPECT_GT(passed, 300);
  EXPECT_GT(passed, 0.6 * inside) << "the bounds are not wide";
}

INSTANTIATE_TEST_SUITE_P(All, ShippedLens,
                         ::testing::Values("landscape", "achromat", "cooke_triplet", "tessar", "double_gauss",
                                           "fisheye"));

// The stop is in the front focus of the lens behind it. From an image point at the distance z it has the
// angle R/f', straight ahead.
TEST(FarExitPupil, IsBoundByItsAngle) {
  for (const char* gap : {"99.1597", "99.15966386554621"}) {
    const System lens = abbe::test::sound_lens_of(
        std::string(R"({"f_number": 25, "focus": "paraxial", "surfaces": [{"stop": true, "thickness": )") +
        gap + "}, [100, 5, 1.5], [-100, 50]]}");
    const SpectralSystem system(lens, stop_radius(lens));
    const ExitPupil pupil(system, V2d(2, 2), 400, 700);
    const double depth = system.image_z() - system.last_z();
    const double expected =
        depth * system.stop_radius_mm() / first_order(SystemAt(lens, 550)).focal_length_mm;
    for (const double x : {0.0, 1.5}) {
      EXPECT_GT(pupil.bound({x, 0}).semi.y, expected) << gap;
      EXPECT_LT(pupil.bound({x, 0}).semi.y, 1.05 * expected) << gap;
      EXPECT_NEAR(pupil.bound({x, 0}).center.x, x, 0.01 * expected) << gap;
    }
  }
}

// A wedge before the lens and one displaced element, so that nothing has rotational symmetry.
TEST(DisplacedLens, LosesNothingByTheBoundsOfItsExitPupil) {
  System lens = abbe::test::lens_named("cooke_triplet");
  lens.surfaces[0].tilt_deg = {1.5, -0.7};
  lens.surfaces[3].decenter_mm = {0.3, 0.4};
  const SpectralSystem system(lens, stop_radius(lens));
  const V2d half(10, 7);
  const ExitPupil pupil(system, half, 450, 650);
  std::mt19937 numbers(3);
  const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
  int passed = 0;
  for (int i = 0; i < 20000; ++i) {
    const V2d image(uniform(half.x), uniform(half.y));
    const V2d point = pupil.bound(image).point({uniform(1.3), uniform(1.3)});
    const V3d from(image.x, image.y, system.image_z());
    if (!system.to_object({from, (V3d(point.x, point.y, system.last_z()) - from).normalized()}, 550))
      continue;
    ++passed;
    ASSERT_TRUE(pupil.bound(image).contains(point)) << point << " of the image at " << image;
  }
  EXPECT_GT(passed, 1000);
}

// A lens with a field stop that illuminates a part of the image smaller than the grid of the bounds. The stop
// is next to the image, where the beam is narrow and moves as far as the image point.
class FieldStop : public ::testing::TestWithParam<double> {
 protected:
  static System lens() {
    System lens = abbe::test::lens_named("double_gauss");
    Surface gate;
    gate.thickness_mm = 1;
    gate.semi_aperture_mm = 2;
    gate.decenter_mm = {GetParam(), 0};
    lens.surfaces.back().thickness_mm -= gate.thickness_mm;
    lens.surfaces.push_back(gate);
    return lens;
  }

  SpectralSystem system{lens(), stop_radius(lens())};
  ExitPupil pupil{system, V2d(21, 21), 450, 650};
  std::mt19937 numbers{3};
  double uniform(double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); }
  std::optional<Ray> from(const V2d& image, const V2d& point) {
    const V3d start(image.x, image.y, system.image_z());
    return system.to_object({start, (V3d(point.x, point.y, system.last_z()) - start).normalized()}, 550);
  }
};

TEST_P(FieldStop, LosesNothingByTheBoundsOfTheExitPupil) {
  const int rays = abbe::test::nightly() ? 20000 : 5000;
  int passed = 0;
  for (int i = 0; i < rays; ++i) {
    const V2d image(uniform(2.2), uniform(2.2));
    const V2d point = image + V2d(uniform(0.3), uniform(0.3));
    const auto out = from(image, point);
    if (!out) continue;
    ++passed;
    ASSERT_TRUE(pupil.bound(image).contains(point)) << point << " of the image at " << image;
    const EntranceDisc& disc = pupil.entrance();
    const V3d in = out->origin + (disc.z - out->origin.z) / out->direction.z * out->direction;
    ASSERT_LT(std::hypot(in.x, in.y), disc.radius) << "comes in beside the disc";
  }
  EXPECT_GT(passed, rays / 20);
  passed = 0;
  for (int i = 0; i < rays; ++i) {
    const V2d image(uniform(1.3), uniform(1.3));
    const double angle = uniform(std::numbers::pi);
    const double radius = std::sqrt(std::abs(uniform(1)));
    passed += from(image, pupil.bound(image).point(radius * V2d(std::cos(angle), std::sin(angle)))) ? 1 : 0;
  }
  EXPECT_GT(passed, 0.6 * rays) << "the bounds are not wide";
}

INSTANTIATE_TEST_SUITE_P(Centred, FieldStop, ::testing::Values(0));
// Without rotational symmetry, its bounds take seconds to compute.
INSTANTIATE_TEST_SUITE_P(NightlyDisplaced, FieldStop, ::testing::Values(1e-6));

}  // namespace
}  // namespace abbe::lens
