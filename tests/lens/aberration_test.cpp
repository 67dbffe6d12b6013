#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/seidel.h"
#include "lens/spot.h"
#include "lenses.h"

namespace abbe::lens {
namespace {

using Imath::V2d;
using Imath::V3d;

// Third-order transverse aberrations of the double Gauss as listed, surface by surface and their sum:
// spherical aberration, tangential coma, tangential and sagittal astigmatism, Petzval, distortion, axial and
// lateral colour.
constexpr std::array<std::array<double, 8>, 12> kListed{{
    {-1.040587, 0.053227, -0.531277, -0.530672, -0.530370, 0.009048, -0.320428, 0.005463},
    {-0.002474, 0.078453, -0.633384, -0.080636, 0.195737, 0.852194, -0.017875, 0.188905},
    {-0.320986, -0.086051, -0.786925, -0.781799, -0.779236, -0.069862, -0.275440, -0.024614},
    {-0.012707, 0.037799, -0.037480, -0.012493, 0.000000, 0.012388, 0.137441, -0.136283},
    {1.363481, 0.846376, 1.382005, 1.265253, 1.206876, 0.261800, 0.433452, 0.089688},
    {0, 0, 0, 0, 0, 0, 0, 0},
    {2.059866, -2.025339, 1.694345, 1.251814, 1.030548, -0.410277, 0.349174, -0.114441},
    {-0.001561, -0.012725, -0.034567, -0.011522, 0.000000, -0.031301, 0.039049, 0.106081},
    {-1.139327, 0.540680, -0.870024, -0.813005, -0.784496, 0.128607, -0.200884, 0.031777},
    {0.000192, 0.014807, 0.212677, -0.040909, -0.167702, -1.050920, -0.006321, -0.162376},
    {-1.212851, 0.589843, -0.470280, -0.406534, -0.374661, 0.065903, -0.173172, 0.028073},
    {-0.306954, 0.037071, -0.074910, -0.160505, -0.203302, -0.232420, -0.035003, 0.012274},
}};

// Surface contributions are large and cancel: the error of 1e-8 in the listed indices is 1e-6 of them.
TEST(LensSeidel, DoubleGaussHasItsListedThirdOrder) {
  const System system = test::lens_named("double_gauss");
  const System resolved = test::double_gauss_of(test::kResolvedIndices);
  const SeidelSums sums =
      seidel_sums(SystemAt(resolved, 587.6), SystemAt(system, 486.1), SystemAt(system, 656.3), 25, 14);
  for (std::size_t i = 0; i < kListed.size(); ++i) {
    const Seidel& s = i < sums.surfaces.size() ? sums.surfaces[i] : sums.sum;
    const double twice = 2 * sums.image_nu;
    const std::array<double, 8> found{s.spherical / twice,
                                      3 * s.coma / twice,
                                      (3 * s.astigmatism + s.petzval) / twice,
                                      (s.astigmatism + s.petzval) / twice,
                                      s.petzval / twice,
                                      s.distortion / twice,
                                      s.axial_color / sums.image_nu,
                                      s.lateral_color / sums.image_nu};
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k], kListed[i][k], 2e-6) << "surface " << i + 1 << ", column " << k;
  }
}

// A real ray close to the axis misses the paraxial focus by S_I/(2 n'u') of its beam, including aspheric
// terms.
TEST(LensSeidel, AspheresCountAsRealRaysSee) {
  const System system = test::sound_lens_of(R"({"entrance_pupil": 2, "focus": "paraxial", "surfaces": [
    {"radius": 30, "thickness": 4, "glass": 1.6, "conic": -0.8, "r2": 0.002, "asphere": [2e-5], "stop": true},
    {"radius": -60, "thickness": 10, "conic": 2, "asphere": [-1e-5]}]})");
  const SystemAt at(system, 587.5618);
  const double y = 0.4;
  const SeidelSums sums = seidel_sums(at, at, at, y, 0);
  const RayPath path = trace(at, {V3d(0, y, -1), V3d(0, 0, 1)}, Apertures::obeyed);
  EXPECT_NEAR(path.last.origin.y / (sums.sum.spherical / (2 * sums.image_nu)), 1, 2e-3);
}

// An asphere away from the stop has coma because the beam passes its spherical aberration eccentrically.
TEST(LensSeidel, AspheresOffTheStopGiveDistortion) {
  const std::string text = R"({"entrance_pupil": 0.01, "fields_deg": [3], "focus": "paraxial", "surfaces": [
    {"stop": true, "thickness": 5}, {"thickness": 1, "glass": 1.5, "asphere": [1e-4]}, [-50, 10]]})";
  const System system = test::sound_lens_of(text);
  const SystemAt at(system, 587.5618);
  const SeidelSums sums = seidel_sums(at, at, at, 0.005, 3);
  const auto chief = chief_ray(at, 3, stop_radius(system));
  ASSERT_TRUE(chief);
  const double ideal = paraxial_chief_height(at, 3, first_order(at).image_distance_mm);
  EXPECT_NEAR((chief->height_mm - ideal) / (sums.sum.distortion / (2 * sums.image_nu)), 1, 0.02);
}

// A stop in the back focus, and as far behind it as that: the entrance pupil of a near object is at infinity.
System telecentric(double off) {
  System system = test::sound_lens_of(R"({"object_distance": 100, "surfaces": [
    [50, 3, 1.5], [-50, 49.494949494949495], {"stop": true, "aperture": 0.5, "thickness": 50}]})");
  system.surfaces[1].thickness_mm += off;
  system.surfaces[2].thickness_mm = first_order(SystemAt(system, 550)).image_distance_mm;
  return system;
}

TEST(LensSeidel, TelecentricSumsTellTheDistortionOfRealRays) {
  for (const double off : {0.0, 1e-6, -1e-6}) {
    const System system = telecentric(off);
    const SystemAt at(system, 550);
    const SeidelSums sums = seidel_sums(at, at, at, 1, 0.5);
    const auto chief = chief_ray(at, 0.5, 0.5);
    ASSERT_TRUE(chief);
    const double ideal = paraxial_chief_height(at, 0.5, first_order(at).image_distance_mm);
    EXPECT_NEAR((chief->height_mm - ideal) / (sums.sum.distortion / (2 * sums.image_nu)), 1, 0.02) << off;
  }
}

// A plane stop in the focus of a single surface: the pupil is at infinity within rounding.
TEST(LensField, TelecentricBeamsHaveAWorkingFNumberAlone) {
  System system;
  system.surfaces.resize(2);
  system.surfaces[0].profile.curvature = 1.0 / 32;
  system.surfaces[0].behind = Glass{"glass", RefractiveIndex(1.5)};
  system.surfaces[0].thickness_mm = 96;
  system.surfaces[1].behind = system.surfaces[0].behind;
  system.surfaces[1].thickness_mm = 48;
  system.object_distance_mm = 128;
  system.stop = 1;
  const SystemAt at(system, 550);
  ASSERT_TRUE(std::isinf(first_order(at).entrance_pupil_mm));
  const auto found = speed(at, 0.48, 20);
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::isinf(found->entrance_diameter_mm));
  EXPECT_TRUE(std::isnan(found->f_number));
  EXPECT_NEAR(found->launch_diameter_mm, 2 * 0.48 / 64 * 128, 0.01);
  EXPECT_NEAR(found->working_f_number, 1 / (2 * 0.48 / 64), 0.2);
}

TEST(LensSeidel, FieldsOfAtLeastARightAngleHaveNoneNorDistortion) {
  const System system = test::lens_named("fisheye");
  const SystemAt at(system, 587.5618);
  const double radius = stop_radius(system);
  for (const double field : {90.0, -95.0}) {
    const auto chief = chief_ray(at, field, radius);
    ASSERT_TRUE(chief);
    EXPECT_FALSE(chief->distortion) << field;
    const Seidel sum = seidel_sums(at, at, at, 1, field).sum;
    EXPECT_EQ(sum.spherical, seidel_sums(at, at, at, 1, 0).sum.spherical);
    for (const double none : {sum.coma, sum.astigmatism, sum.petzval, sum.distortion, sum.lateral_color})
      EXPECT_TRUE(std::isnan(none)) << field;
  }
  EXPECT_TRUE(chief_ray(at, 89.9, radius)->distortion);
}

TEST(LensField, DistortionOfTheDoubleGaussIsTheListed) {
  const System system = test::lens_named("double_gauss");
  const SystemAt at(system, 587.6);
  const double radius = stop_radius(system);
  EXPECT_NEAR(100 * *chief_ray(at, 10, radius)->distortion, -0.4976, 5e-5);
  EXPECT_NEAR(100 * *chief_ray(at, 14, radius)->distortion, -1.0557, 5e-5);
  EXPECT_FALSE(chief_ray(at, 0, radius)->distortion);
}

// An ellipsoid of conic constant -1/n^2 images an object at infinity to a point inside glass of index n.
System perfect(double defocus) {
  System system;
  system.surfaces.resize(1);
  const double n = 1.5;
  system.surfaces[0].profile = {1.0 / 100, -1 / (n * n), {}};
  system.surfaces[0].behind = Glass{"glass", RefractiveIndex(n)};
  system.surfaces[0].thickness_mm = 300 + defocus;  // n R/(n - 1)
  system.aperture = {ApertureKind::entrance_pupil, 6};
  return system;
}

std::vector<Spot> axial_spots(const System& system) {
  return all_spots(system, stop_radius(system), 200).front();
}

TEST(LensSpot, PerfectImageIsAPoint) {
  const auto size = size_of(axial_spots(perfect(0)));
  ASSERT_TRUE(size);
  EXPECT_LT(size->rms_mm, 1e-12);
}

// Out of focus the cone of light forms a disc. Its root mean square is radius/sqrt(2), and its transform 2
// J_1(v)/v with v = 2 pi radius frequency.
TEST(LensSpot, DefocusedPointIsADisc) {
  const System system = perfect(2);
  const auto spots = axial_spots(system);
  const auto size = size_of(spots);
  ASSERT_TRUE(size);
  const double radius = 3.0 / 300 * 2;
  EXPECT_NEAR(size->rms_mm, radius / std::sqrt(2.0), 1e-3 * radius);
  EXPECT_NEAR(size->largest_mm, radius, 1e-2 * radius);
  for (const double per_mm : {5.0, 20.0, 35.0}) {
    const double v = 2 * std::numbers::pi * radius * per_mm;
    const double expected = std::abs(2 * std::cyl_bessel_j(1.0, v) / v);
    EXPECT_NEAR(geometric_mtf(spots, per_mm, {0, 1}), expected, 2e-3) << per_mm;
    EXPECT_NEAR(geometric_mtf(spots, per_mm, {1, 0}), expected, 2e-3) << per_mm;
  }
  EXPECT_EQ(geometric_mtf(spots, 0, {0, 1}), 1);
}

TEST(LensFocus, BestFocusFindsThePoint) {
  EXPECT_NEAR(best_focus(perfect(2)).value(), -2, 1e-9);
  EXPECT_NEAR(best_focus(perfect(-0.5)).value(), 0.5, 1e-9);
}

TEST(LensFocus, ParallelBeamsHaveNone) {
  System hole;
  hole.surfaces.resize(1);
  hole.surfaces[0].thickness_mm = 100;
  hole.aperture = {ApertureKind::stop, 0.5};
  hole.fields = {0, 20, 40, 60};
  hole.wavelengths_nm = {486, 588, 656};
  EXPECT_FALSE(best_focus(hole));
  EXPECT_FALSE(best_focus(all_spots(hole, 0.5, 100)));
  hole.object_distance_mm = 50;
  hole.fields = {0};
  EXPECT_NEAR(best_focus(hole).value(), -150, 1e-9);
}

TEST(LensFocus, FileMayAskForTheLeastSpots) {
  const auto with_focus = [](const std::string& focus) {
    return test::sound_lens_of(R"({"f_number": 4, "focus": ")" + focus + R"(", "surfaces": [
      {"radius": 50, "thickness": 4, "glass": "N-BK7", "stop": true}, [-50, 40]]})");
  };
  const System paraxial = with_focus("paraxial");
  const System best = with_focus("best");
  const FirstOrder first = first_order(SystemAt(paraxial, 587.5618));
  EXPECT_EQ(paraxial.surfaces.back().thickness_mm, first.back_focus_mm);
  EXPECT_EQ(with_focus("given").surfaces.back().thickness_mm, 40);
  // Undercorrected: rays from the edge meet nearer to the lens. At the best focus, no displacement improves
  // the spot.
  EXPECT_LT(best.surfaces.back().thickness_mm, first.back_focus_mm - 0.1);
  EXPECT_NEAR(best_focus(best).value(), 0, 1e-3);
  double least = size_of(axial_spots(best))->rms_mm;
  for (const double shift : {-0.05, 0.05}) {
    System moved = best;
    moved.surfaces.back().thickness_mm += shift;
    EXPECT_GT(size_of(axial_spots(moved))->rms_mm, least);
  }
}

// A bare hole follows the fourth power of the cosine.
TEST(LensField, HoleDarkensByTheFourthPowerOfTheCosine) {
  System hole;
  hole.surfaces.resize(1);
  hole.surfaces[0].thickness_mm = 10;
  hole.aperture = {ApertureKind::stop, 0.5};
  hole.fields = {0, 20, 40};
  const SystemAt at(hole, 550);
  const auto spots = all_spots(hole, 0.5, 150);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const double cosine = std::cos(hole.fields[i] * std::numbers::pi / 180);
    const auto found = relative_illumination(at, hole.fields[i], 0.5, spots[i][0], spots[0][0]);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found / std::pow(cosine, 4), 1, 5e-3) << hole.fields[i];
  }
}

// A bare hole with a near object: the projected solid angle of the hole.
TEST(LensField, HoleBeforeANearObjectDarkensAlike) {
  System hole;
  hole.surfaces.resize(1);
  hole.surfaces[0].thickness_mm = 10;
  hole.aperture = {ApertureKind::stop, 0.5};
  hole.object_distance_mm = 50;
  hole.fields = {0, 30};
  const auto spots = all_spots(hole, 0.5, 150);
  const double cosine = 50 / std::hypot(30, 50);
  const auto found = relative_illumination(SystemAt(hole, 550), 30, 0.5, spots[1][0], spots[0][0]);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found / std::pow(cosine, 4), 1, 5e-3);
}

TEST(LensField, FarObjectsDarkenAsThoseAtInfinity) {
  const auto illumination = [](const std::string& object) {
    const System system = test::sound_lens_of(R"({"f_number": 4, "fields_deg": [0, 5], "focus": "paraxial",
      )" + object + R"("surfaces": [{"radius": 51.68, "thickness": 4, "glass": "N-BK7", "stop": true},
      [-51.68, 50]]})");
    const double radius = stop_radius(system);
    const auto spots = all_spots(system, radius, 150);
    return relative_illumination(SystemAt(system, system.primary_nm()), system.fields[1], radius,
                                 spots[1][system.primary], spots[0][system.primary])
        .value();
  };
  const double at_infinity = illumination("");
  EXPECT_NEAR(at_infinity, 0.9864, 1e-4);
  for (const double distance : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9})
    EXPECT_NEAR(illumination(R"("object_distance": )" + std::to_string(distance) + ","), at_infinity,
                1e-6 + 1 / distance)
        << distance;
}

TEST(LensField, SpeedCountsTheLossesOfSurfaces) {
  const System system = test::double_gauss_of(test::kStatedIndices);
  const SystemAt at(system, 587.6);
  const auto found = speed(at, stop_radius(system), 60);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->entrance_diameter_mm, 50, 1e-9);
  EXPECT_NEAR(found->f_number, 2.0001, 5e-5);
  // The listed slope of the marginal ray behind the lens.
  EXPECT_NEAR(found->working_f_number, std::sqrt(1 + 1 / (0.258832 * 0.258832)) / 2, 1e-4);
  double normal = 1;  // for light along the axis
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double r = (at.n[i + 1] - at.n[i]) / (at.n[i + 1] + at.n[i]);
    normal *= 1 - r * r;
  }
  EXPECT_LT(found->transmittance, normal);
  EXPECT_GT(found->transmittance, normal - 0.02);
  EXPECT_NEAR(found->t_stop, found->f_number / std::sqrt(found->transmittance), 1e-12);
  EXPECT_NEAR(found->airy_radius_um, 1.2196699 * 0.5876 * found->working_f_number, 1e-6);
}

TEST(LensField, FansAgreeWithTheListedRays) {
  const System system = test::double_gauss_of(test::kResolvedIndices);
  const SystemAt at(system, 587.6);
  const auto beam = Beam::of(at, 0, stop_radius(system));
  ASSERT_TRUE(beam);
  const RayFan fan = ray_fan(*beam, {0, 0}, 3);
  EXPECT_NEAR(*fan.tangential[2], 0.014138, 1e-6);
  EXPECT_NEAR(*fan.sagittal[0], -0.014138, 1e-6);
  EXPECT_NEAR(*fan.tangential[1], 0, 1e-12);
}

TEST(LensField, VignettingIsTheShareThatAperturesTake) {
  System system = perfect(0);
  system.surfaces[0].semi_aperture_mm = 3 / std::sqrt(2.0);
  const auto spots = axial_spots(system);
  EXPECT_NEAR(*spots[0].vignetting(), 0.5, 5e-3);
  EXPECT_FALSE(Spot{}.vignetting()) << "of no ray that was aimed";
}

// A plano-convex lens of 100 mm before its stop; its surfaces or the stop are displaced.
System displaced_lens(const std::string& lens, const std::string& stop) {
  return test::sound_lens_of(R"({"entrance_pupil": 10, "focus": "paraxial", "surfaces": [
    {"radius": 51.68, "thickness": 4, "glass": 1.5168)" +
                             lens + R"(}, {"radius": 0, "thickness": 30)" + lens +
                             R"(}, {"stop": true, "thickness": 50)" + stop + "}]}");
}

TEST(LensField, SpeedDoesNotDependOnTheDirectionOfADisplacement) {
  const auto speed_of = [](const std::string& lens, const std::string& stop) {
    const System system = displaced_lens(lens, stop);
    return speed(SystemAt(system, 550), stop_radius(system), 60).value();
  };
  const Speed centred = speed_of("", "");
  const auto expect_alike = [&](const Speed& x, const Speed& y, double bound) {
    EXPECT_NEAR(x.entrance_diameter_mm / y.entrance_diameter_mm, 1, bound);
    EXPECT_NEAR(x.working_f_number / y.working_f_number, 1, bound);
    EXPECT_NEAR(x.t_stop / y.t_stop, 1, 1e-4);
    EXPECT_NEAR(x.f_number / centred.f_number, 1, 0.02);
    EXPECT_NEAR(x.working_f_number / centred.working_f_number, 1, 0.02);
  };
  const Speed upwards = speed_of(R"(, "decenter": [0, 4])", "");
  expect_alike(speed_of(R"(, "decenter": [4, 0])", ""), upwards, 1e-10);
  expect_alike(speed_of(R"(, "tilt_deg": [5, 0])", ""), speed_of(R"(, "tilt_deg": [0, 5])", ""), 1e-10);
  expect_alike(speed_of("", R"(, "decenter": [-4, 0])"), speed_of("", R"(, "decenter": [0, -4])"), 1e-10);
  // Pupil aberrations make the beam slightly smaller than an ellipse.
  expect_alike(speed_of(R"(, "decenter": [2.4, 3.2])", ""), upwards, 1e-6);
}

// The paraxial height is 0 there, whatever the distance of the image from the paraxial focus.
TEST(LensField, TiltedLensesHaveNoDistortionOnTheAxis) {
  System system = displaced_lens(R"(, "tilt_deg": [5, 0])", "");
  system.surfaces.back().thickness_mm += 0.3;
  const auto chief = chief_ray(SystemAt(system, 587.5618), 0, stop_radius(system));
  ASSERT_TRUE(chief);
  EXPECT_FALSE(chief->distortion);
}

// Half of the beam is cut. Blades whose polygon contains the other half do not change it.
TEST(LensField, TStopCountsAperturesThatCutTheAxialBeam) {
  System system = perfect(0);
  system.surfaces.insert(system.surfaces.begin(), Surface{});
  system.surfaces[1].semi_aperture_mm = 3 / std::sqrt(2.0);
  for (const int blades : {0, 7}) {
    if (blades > 0) system.surfaces[0].iris = Iris(blades, 0);
    const auto found = speed(SystemAt(system, 550), 3, 200);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->f_number, 50, 1e-9);
    EXPECT_NEAR(std::pow(found->f_number / found->t_stop, 2) / found->transmittance, 0.5, 5e-3) << blades;
  }
}

}  // namespace
}  // namespace abbe::lens
