#include "materials/interface/snell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/materials/reference.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr double kDegree = std::numbers::pi / 180;

TEST(Snell, ReflectsAboutTheNormal) {
  const V3d n = V3d(1, 2, -2) / 3;
  const V3d wo = V3d(0.3, 0.8, 0.1).normalized();
  const V3d wi = reflect(wo, n);
  EXPECT_NEAR(wi.dot(n), wo.dot(n), 1e-15);
  EXPECT_NEAR((wi + wo).cross(n).length(), 0, 1e-15);
}

TEST(Snell, ObeysTheSineLawInThePlaneOfIncidence) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const V3d n = V3d(uniform(rng), uniform(rng), uniform(rng)).normalized();
    V3d wo = V3d(uniform(rng), uniform(rng), uniform(rng)).normalized();
    if (wo.dot(n) < 0) wo = -wo;
    const double eta = std::exp(uniform(rng));
    const auto wi = refract(wo, n, eta);
    const double sin_i = wo.cross(n).length();
    EXPECT_EQ(wi.has_value(), sin_i < eta);
    if (!wi) continue;
    EXPECT_NEAR(wi->length(), 1, 1e-13);
    EXPECT_LT(wi->dot(n), 0);
    EXPECT_NEAR((n.cross(*wi) * eta + n.cross(wo)).length(), 0, 1e-13);
  }
}

TEST(Snell, EqualIndicesChangeNoBit) {
  std::mt19937 rng(2);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 10000; ++i) {
    const V3f n = V3f(normal(rng), normal(rng), normal(rng)).normalized();
    V3f wo = V3f(normal(rng), normal(rng), normal(rng)).normalized();
    if (n.dot(wo) < 0) wo = -wo;
    ASSERT_EQ(refract(wo, n, 1.0F), std::optional(-wo));
    const double c = std::generate_canonical<double, 53>(rng);
    ASSERT_EQ(refracted_cosine(c, 1.0), c);
  }
  EXPECT_EQ(refracted_cosine(1e-30F, 1.0F), 1e-30F);
}

TEST(Snell, NearlyEqualIndicesHardlyBend) {
  for (const float delta : {-1e-6F, 1e-6F}) {
    const float eta = 1 + delta;
    for (const double angle : {0.1, 0.5, 1.0, 1.5}) {
      const V3f wo(static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle)));
      const auto wi = refract(wo, V3f(0, 0, 1), eta);
      const auto exact = refract(V3d(wo), V3d(0, 0, 1), double(eta));
      ASSERT_TRUE(wi && exact);
      EXPECT_LT(std::atan2(V3d(*wi).cross(*exact).length(), V3d(*wi).dot(*exact)), 1e-6);
    }
  }
}

TEST(Snell, CriticalAngles) {
  const double eta = 1 / 1.5;
  const double critical = std::asin(eta);
  EXPECT_NEAR(critical / kDegree, 41.8, 0.05);
  const auto at = [&](double angle) {
    return refract(V3d(std::sin(angle), 0, std::cos(angle)), V3d(0, 0, 1), eta);
  };
  EXPECT_TRUE(at(critical - 1e-12));
  EXPECT_FALSE(at(critical + 1e-12));
}

// Through a prism of apex A by two refractions; its faces have the outward normals (-+cos(A/2), 0, sin(A/2)).
double deviation(double n, double apex, double incidence) {
  const V3d in(-std::cos(apex / 2), 0, std::sin(apex / 2));
  const V3d out(std::cos(apex / 2), 0, std::sin(apex / 2));
  const V3d tangent(-std::sin(apex / 2), 0, -std::cos(apex / 2));
  const V3d to_light = in * std::cos(incidence) + tangent * std::sin(incidence);
  const V3d inside = refract(to_light, in, n).value();
  const V3d leaving = refract(V3d(-inside), V3d(-out), 1 / n).value();
  return std::atan2((-to_light).cross(leaving).length(), (-to_light).dot(leaving));
}

TEST(Snell, PrismDeviatesAsInClosedForm) {
  const Reference prisms("prism_minimum_deviation.csv");
  int compared = 0;
  for (std::size_t row = 0; row < prisms.rows(); ++row) {
    if (prisms.text(row, "min_deviation_deg").empty()) continue;
    const double apex = prisms.number(row, "apex_deg") * kDegree;
    const double n = index_of(prisms.text(row, "id")).catalogued_n(prisms.number(row, "wavelength_nm"));
    const double incidence = std::asin(n * std::sin(apex / 2));
    const double deviated = deviation(n, apex, incidence);
    EXPECT_NEAR(deviated, 2 * incidence - apex, 1e-9);
    EXPECT_NEAR(deviated / kDegree, prisms.number(row, "min_deviation_deg"), 0.51e-6);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(Snell, PrismAtFixedIncidence) {
  const RefractiveIndex bk7 = index_of("N-BK7");
  const auto at = [&](double nm) {
    return deviation(bk7.catalogued_n(nm), 60 * kDegree, 50 * kDegree) / kDegree;
  };
  EXPECT_NEAR(at(656.2725), 38.43841, 1e-5);
  EXPECT_NEAR(at(587.5618), 38.65364, 1e-5);
  EXPECT_NEAR(at(486.1327), 39.14097, 1e-5);
  EXPECT_NEAR(at(404.6561), 39.83544, 1e-5);
}

}  // namespace
}  // namespace abbe
