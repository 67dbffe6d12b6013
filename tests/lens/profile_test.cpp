#include "lens/profile.h"

#include <cfenv>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace abbe::lens {
namespace {

using Imath::V3d;

// A ray at a height, parallel to the axis.
Ray parallel(double y, double from = -100) {
  return {V3d(0, y, from), V3d(0, 0, 1)};
}

double hit_z(const Profile& profile, const Ray& ray) {
  const auto t = profile.intersect(ray);
  return t ? ray.origin.z + *t * ray.direction.z : std::numeric_limits<double>::quiet_NaN();
}

TEST(LensProfile, ConicsAreHitWhereTheirEquationsSay) {
  const double r2 = 36;
  EXPECT_NEAR(hit_z({0.1, 0, {}}, parallel(6)), 2, 1e-13);  // 10 - sqrt(100 - 36)
  EXPECT_NEAR(hit_z({-0.1, 0, {}}, parallel(6)), -2, 1e-13);
  EXPECT_NEAR(hit_z({0.1, -1, {}}, parallel(6)), r2 / 20, 1e-13);
  EXPECT_NEAR(hit_z({0.1, -2, {}}, parallel(6)), -10 + std::sqrt(100 + r2), 1e-13);  // x^2 - z^2 - 20 z = 0
  EXPECT_EQ(hit_z({0, 0, {}}, parallel(6)), 0);
  EXPECT_NEAR(hit_z({0.1, 0, {}}, parallel(6, -1e6)), 2, 1e-9);
}

TEST(LensProfile, RaysThatMissEndWithoutAPoint) {
  EXPECT_FALSE(Profile({0.1, 0, {}}).intersect(parallel(10.5)));
  EXPECT_FALSE(Profile({0.1, 0, {}}).intersect(parallel(std::numeric_limits<double>::quiet_NaN())));
  // Through the back half of the sphere only, and through the other sheet of a hyperboloid.
  EXPECT_FALSE(Profile({0.1, 0, {}}).intersect({V3d(0, 0, 15), V3d(0, 1, 0)}));
  EXPECT_FALSE(Profile({0.1, -5, {}}).intersect({V3d(0, 8, -20), V3d(0, 0.99, std::sqrt(1 - 0.99 * 0.99))}));
  EXPECT_FALSE(Profile({0.1, 0, {0, 1e-6}}).intersect(parallel(10.5)));
}

// Light reflected back by ghosts arrives at planes from behind.
TEST(LensProfile, RaysThatLeadAwayFromAPlaneDivideByNothing) {
  std::feclearexcept(FE_ALL_EXCEPT);
  EXPECT_FALSE(Profile({0, 0, {}}).intersect({V3d(1, 2, 15), V3d(0.6, 0, -0.8)}));
  EXPECT_FALSE(Profile({0, 0, {}}).intersect({V3d(1, 2, 15), V3d(0, 0, -1)}));
  EXPECT_FALSE(Profile({0, 0, {}}).intersect({V3d(1, 2, 15), V3d(1, 0, 0)}));
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW), 0);
}

// Of the two intersections with a sphere, the one on the front half counts, also for a ray across the axis.
TEST(LensProfile, RaysAcrossTheAxisPassFromFrontToBack) {
  const Profile sphere{0.1, 0, {}};
  const auto t = sphere.intersect({V3d(0, 0, 2), V3d(0, 1, 0)});
  ASSERT_TRUE(t);
  EXPECT_NEAR(*t, -6, 1e-13);
}

TEST(LensProfile, AspheresAreHitOnTheirSag) {
  const Profile asphere{0.02, -0.7, {1e-4, 3e-6, -2e-9, 1e-12, 0, 0, 0, 0, 0, 1e-27}};
  const Ray ray{V3d(3, -7, -40), V3d(0.1, 0.25, 1).normalized()};
  const auto t = asphere.intersect(ray);
  ASSERT_TRUE(t);
  const V3d p = ray.origin + *t * ray.direction;
  const double r2 = p.x * p.x + p.y * p.y;
  const double c = 0.02;
  const double said = c * r2 / (1 + std::sqrt(1 - 0.3 * c * c * r2)) + 1e-4 * r2 + 3e-6 * std::pow(r2, 2) -
                      2e-9 * std::pow(r2, 3) + 1e-12 * std::pow(r2, 4) + 1e-27 * std::pow(r2, 10);
  EXPECT_NEAR(p.z, said, 1e-13);
}

TEST(LensProfile, NormalsAreAcrossTheSurface) {
  for (const Profile& profile :
       {Profile{0.05, 0.4, {}}, Profile{0.05, -3, {}}, Profile{0.05, 0.4, {1e-3, 2e-6, 1e-9}}}) {
    const double x = 3;
    const double y = 5;
    const auto z = [&](double px, double py) { return profile.sag(px * px + py * py); };
    const double h = 1e-5;
    const V3d expected(-(z(x + h, y) - z(x - h, y)) / (2 * h), -(z(x, y + h) - z(x, y - h)) / (2 * h), 1);
    const V3d normal = profile.normal(V3d(x, y, z(x, y)));
    EXPECT_LT((normal - expected.normalized()).length(), 1e-9);
  }
}

}  // namespace
}  // namespace abbe::lens
