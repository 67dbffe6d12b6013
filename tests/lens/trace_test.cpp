#include "lens/trace.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "lens/beam.h"
#include "lenses.h"
#include "tests/angles.h"

namespace abbe::lens {
namespace {

using Imath::V3d;
constexpr double kPrinted = 1e-6;  // half of the last digit of the listing

// The listing of the double Gauss: heights at each surface and slopes behind it.
constexpr std::array<double, 11> kAxial{25,        24.109772, 22.844992, 20.958242, 16.784894, 15.702464,
                                        14.610682, 15.815163, 16.882946, 16.583956, 16.261006};
constexpr std::array<double, 11> kAxialSlope{-0.185302, -0.200953, -0.394267, -0.395393, -0.112583, -0.112583,
                                             0.153430,  0.151784,  -0.057039, -0.071127, -0.258832};
constexpr std::array<double, 11> kChief{-10.199122, -8.751050, -8.439261, -5.580229, -4.530431, 0,
                                        3.832982,   4.755774,  7.078566,  7.404392,  8.254743};

// A ray outside the planes of symmetry, from the listing's "1.00 -0.01".
constexpr std::array<double, 11> kSkewX{25,        24.207033, 22.813382, 21.169658, 16.783340, 15.727108,
                                        14.651350, 15.952291, 16.995052, 16.682332, 16.407589};
constexpr std::array<double, 11> kSkewY{-9.180390, -8.423361, -6.659673, -5.647541, -2.946639, -0.223552,
                                        2.549878,  4.310591,  5.721879,  7.180915,  7.707488};

void expect_axial(const System& system, double within) {
  const SystemAt at(system, 587.6);
  const RayPath path = trace(at, {V3d(0, 25, 0), V3d(0, 0, 1)}, Apertures::obeyed);
  ASSERT_TRUE(path.reached());
  for (std::size_t i = 0; i < kAxial.size(); ++i) {
    EXPECT_NEAR(path.hits[i].point.y, kAxial[i], within) << "surface " << i + 1;
    const V3d& d = path.hits[i].direction;
    EXPECT_NEAR(d.y / d.z, kAxialSlope[i], within) << "surface " << i + 1;
  }
  EXPECT_NEAR(path.last.origin.y, 0.014138, within);
}

TEST(LensTrace, AxialRayOfTheDoubleGaussHasTheListedHeights) {
  expect_axial(test::double_gauss_of(test::kResolvedIndices), kPrinted);
}

// The catalogue's indices differ from those by 7e-8, six digits of them by up to 5e-7.
TEST(LensTrace, CatalogueAndStatedIndicesGiveTheListedHeightsAsFarAsTheyKnowThem) {
  expect_axial(test::lens_named("double_gauss"), 5e-6);
  expect_axial(test::double_gauss_of(test::kStatedIndices), 5e-5);
}

TEST(LensTrace, ChiefRayOfTheDoubleGaussHasTheListedHeights) {
  const System system = test::double_gauss_of(test::kResolvedIndices);
  const SystemAt at(system, 587.6);
  const auto beam = Beam::of(at, 10, stop_radius(system));
  ASSERT_TRUE(beam);
  const RayPath path = trace(at, beam->launch(beam->chief()), Apertures::obeyed);
  ASSERT_TRUE(path.reached());
  for (std::size_t i = 0; i < kChief.size(); ++i)
    EXPECT_NEAR(path.hits[i].point.y, kChief[i], kPrinted) << "surface " << i + 1;
  EXPECT_NEAR(path.last.origin.y, 17.485856, kPrinted);
  const Ray before = beam->launch(beam->chief());
  EXPECT_NEAR(before.origin.z - before.origin.y * before.direction.z / before.direction.y, 58.7753, 5e-5);
}

TEST(LensTrace, SkewRayOfTheDoubleGaussHasTheListedHeights) {
  const System system = test::double_gauss_of(test::kResolvedIndices);
  const SystemAt at(system, 587.6);
  const V3d direction(0, std::sin(10 * kDegree), std::cos(10 * kDegree));
  const RayPath path = trace(at, {V3d(kSkewX[0], kSkewY[0], 6.710684), direction}, Apertures::obeyed);
  ASSERT_TRUE(path.reached());
  for (std::size_t i = 0; i < kSkewX.size(); ++i) {
    EXPECT_NEAR(path.hits[i].point.x, kSkewX[i], 3 * kPrinted) << "surface " << i + 1;
    EXPECT_NEAR(path.hits[i].point.y, kSkewY[i], 3 * kPrinted) << "surface " << i + 1;
  }
  EXPECT_NEAR(path.last.origin.x, 0.054750, 3 * kPrinted);
  EXPECT_NEAR(path.last.origin.y, 17.485856 + 0.001022, 3 * kPrinted);
}

// A plane of glass of index n at the vertex, then air.
System plate(double n, double thickness, Imath::V2d tilt_deg = {0, 0}, double k = 0) {
  System system;
  system.surfaces.resize(2);
  system.surfaces[0].behind = Glass{"glass", RefractiveIndex(n, k)};
  system.surfaces[0].thickness_mm = thickness;
  system.surfaces[1].thickness_mm = 10;
  for (Surface& surface : system.surfaces) surface.tilt_deg = tilt_deg;
  return system;
}

double transmitted(const System& system, const Ray& ray) {
  const SystemAt at(system, 550);
  const RayPath path = trace(at, ray, Apertures::obeyed);
  EXPECT_TRUE(path.reached()) << reason(path);
  return transmittance(at, ray, path);
}

TEST(LensTrace, PlateTransmitsWhatFresnelSays) {
  const Ray axial{V3d(0, 0, -1), V3d(0, 0, 1)};
  EXPECT_NEAR(transmitted(plate(1.5, 2), axial), 0.96 * 0.96, 1e-14);
  const FresnelPower<double> f = fresnel_dielectric(0.5, 1.5);
  EXPECT_NEAR(transmitted(plate(1.5, 2), {V3d(0, 0, -1), V3d(0, std::sqrt(0.75), 0.5)}),
              (f.Ts * f.Ts + f.Tp * f.Tp) / 2, 1e-14);
  EXPECT_NEAR(transmitted(plate(1.5, 2, {60, 0}), axial), (f.Ts * f.Ts + f.Tp * f.Tp) / 2, 1e-14);
}

// s for a plate tilted about x is p for one tilted about y.
TEST(LensTrace, PolarisationIsCarriedFromPlateToPlate) {
  System crossed = plate(1.5, 2, {60, 0});
  crossed.surfaces[1].thickness_mm = 40;
  for (const Surface& surface : plate(1.5, 2, {0, 60}).surfaces) crossed.surfaces.push_back(surface);
  const FresnelPower<double> f = fresnel_dielectric(0.5, 1.5);
  EXPECT_NEAR(transmitted(crossed, {V3d(0, 0, -1), V3d(0, 0, 1)}), f.Ts * f.Ts * f.Tp * f.Tp, 1e-13);
}

TEST(LensTrace, GlassAbsorbsAlongTheRay) {
  const double k = 1e-6;
  const double depth = 4 * std::numbers::pi * k / 550e-6 * 7;
  EXPECT_NEAR(transmitted(plate(1.5, 7, {0, 0}, k), {V3d(0, 0, -1), V3d(0, 0, 1)}), 0.9216 * std::exp(-depth),
              1e-12);
}

// A quarter wave of index sqrt(1.5) on both sides removes the reflections on entering and leaving.
TEST(LensTrace, CoatingsCountFromEitherSide) {
  System coated = plate(1.5, 2);
  const double n = std::sqrt(1.5);
  for (Surface& surface : coated.surfaces)
    surface.coating = {{{"film", RefractiveIndex(n)}}, {{0, 550 / (4 * n)}}};
  EXPECT_NEAR(transmitted(coated, {V3d(0, 0, -1), V3d(0, 0, 1)}), 1, 1e-12);
}

// Layers are listed from the air inwards on either face. Two unlike layers transmit the same on both faces.
TEST(LensTrace, CoatingsLieFromTheAirInwards) {
  const Coating layers{{{"low", RefractiveIndex(1.38)}, {"high", RefractiveIndex(2.1)}}, {{0, 90}, {1, 40}}};
  System front = plate(1.7, 2);
  System back = front;
  front.surfaces[0].coating = layers;
  back.surfaces[1].coating = layers;
  const Ray axial{V3d(0, 0, -1), V3d(0, 0, 1)};
  EXPECT_NEAR(transmitted(front, axial), transmitted(back, axial), 1e-12);
  EXPECT_GT(transmitted(front, axial), transmitted(plate(1.7, 2), axial) + 0.01);
}

// A prism's second face beyond the critical angle of 41.8 degrees.
TEST(LensTrace, RaysThatEndSayWhyAndWhere) {
  System system = plate(1.5, 20);
  system.surfaces[1].tilt_deg = {45, 0};
  const RayPath reflected = trace(SystemAt(system, 550), {V3d(0, 0, -1), V3d(0, 0, 1)}, Apertures::obeyed);
  EXPECT_EQ(reflected.end, RayEnd::total_reflection);
  EXPECT_EQ(reason(reflected), "is totally reflected at surface 2");
  system = plate(1.5, 20);
  system.surfaces[1].semi_aperture_mm = 3;
  const Ray high{V3d(2.9, 0.9, -1), V3d(0, 0, 1)};
  EXPECT_EQ(reason(trace(SystemAt(system, 550), high, Apertures::obeyed)),
            "is stopped by the aperture of surface 2");
  EXPECT_TRUE(trace(SystemAt(system, 550), high, Apertures::ignored).reached());
  system.surfaces[0].profile.curvature = 1;
  EXPECT_EQ(reason(trace(SystemAt(system, 550), high, Apertures::obeyed)), "misses surface 1");
}

TEST(LensTrace, DecentredSurfaceStandsAside) {
  System system = plate(1.5, 5);
  system.surfaces[0].profile.curvature = 0.02;
  const RayPath centred = trace(SystemAt(system, 550), {V3d(0, 3, -1), V3d(0, 0, 1)}, Apertures::obeyed);
  for (Surface& surface : system.surfaces) surface.decenter_mm = {1, 2};
  const RayPath moved = trace(SystemAt(system, 550), {V3d(1, 5, -1), V3d(0, 0, 1)}, Apertures::obeyed);
  EXPECT_LT((moved.last.origin - centred.last.origin - V3d(1, 2, 0)).length(), 1e-13);
}

// A plane surface with a tilt: the ray leaves by Snell's law at the tilted normal.
TEST(LensTrace, TiltTurnsAboutXThenAboutTheTiltedY) {
  System system = plate(1.5, 5);
  system.surfaces[0].tilt_deg = {20, 10};
  const SystemAt at(system, 550);
  const RayPath path = trace(at, {V3d(0, 0, -1), V3d(0, 0, 1)}, Apertures::obeyed);
  const double a = 20 * kDegree;
  const double b = 10 * kDegree;
  // z rotated about x by a, then about the rotated y by b.
  const V3d normal(std::sin(b), -std::sin(a) * std::cos(b), std::cos(a) * std::cos(b));
  EXPECT_LT((path.hits[0].normal - normal).length(), 1e-14);
}

}  // namespace
}  // namespace abbe::lens
