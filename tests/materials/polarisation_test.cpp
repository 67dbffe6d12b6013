// Laws that the Mueller matrices of all scattering models obey, and the matrices of mixtures.
#include "materials/bsdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/interface/mueller.h"
#include "materials/interface/thin_sheet.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/mueller_rounding.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

using Imath::V3f;

// Laws of all models. A matrix is passive if no Stokes vector gains power in either direction. It is physical
// if Cloude's coherency matrix has no negative eigenvalue. For matrices of this form the eigenvalues are (1 +
// p +- 2 |(d, c + is)|)/4 and, twice, (1 - p)/4.
void expect_physical(const MuellerMatrix& m, const V3f& wo, const V3f& wi) {
  EXPECT_NEAR(m.axis.length(), 1, 1e-5);
  EXPECT_NEAR(m.axis.dot(wo), 0, 1e-5);
  EXPECT_NEAR(m.axis.dot(wi), 0, 1e-5);
  for (int lane = 0; lane < kLanes; ++lane) {
    const double p = m.p[lane];
    const double rest = std::hypot(m.d[lane], m.c[lane], m.s[lane]);
    ASSERT_TRUE(std::isfinite(rest));
    EXPECT_LE(p, 1 + 1e-6);
    EXPECT_LE(2 * rest, 1 + p + 1e-5) << "lane " << lane;
  }
}

// The larger of the fractions that survive of two orthogonal polarisations.
double greatest_share(const SampledSpectrum& power, const MuellerMatrix& m) {
  double greatest = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    greatest = std::max(greatest, static_cast<double>(power[lane] * (1 + std::abs(m.d[lane]))));
  return greatest;
}

template <typename Model>
class MuellerLaws : public testing::Test {};
template <typename List>
struct TypesOf;
template <typename... Models>
struct TypesOf<std::variant<Models...>> {
  using type = testing::Types<Models...>;
};
TYPED_TEST_SUITE(MuellerLaws, TypesOf<Bsdf>::type);

std::vector<V3f> directions_of_arrival() {
  std::vector<V3f> all{{0, 0, 1}, {0, 0, -1}, direction(1e-3, 1), direction(-1e-5, 2)};
  Uniform u(3);
  for (int i = 0; i < 60; ++i) all.push_back(direction(2 * u() - 1, 6.28 * u()));
  return all;
}

void expect_same(const MuellerMatrix& a, const MuellerMatrix& b, int lane) {
  EXPECT_NEAR(a.d[lane], b.d[lane], 2e-4);
  EXPECT_NEAR(a.p[lane], b.p[lane], 2e-4);
  EXPECT_NEAR(a.c[lane], b.c[lane], 2e-4);
  EXPECT_NEAR(a.s[lane], b.s[lane], 2e-4);
}

TYPED_TEST(MuellerLaws, EventsArePhysicalAndTheSameBothWays) {
  Uniform u(11);
  for (const TypeParam& model : examples<TypeParam>()) {
    const Bsdf bsdf = model;
    for (const V3f& wo : directions_of_arrival())
      for (int hero = 0; hero < kLanes; hero += 7)
        for (int i = 0; i < 4; ++i) {
          const auto event = sample(bsdf, wo, u.event(), hero, TransportMode::power);
          if (!event) continue;
          const auto m = mueller(bsdf, wo, event->wi, event->delta);
          if (!m) continue;
          expect_physical(*m, wo, event->wi);
          const auto back = mueller(bsdf, event->wi, wo, event->delta);
          ASSERT_TRUE(back);
          if (event->weight[hero] > 0) expect_same(*m, *back, hero);
          if (testing::Test::HasFailure()) return;
        }
  }
}

// In delta events and in all events together, neither polarisation gains power.
TYPED_TEST(MuellerLaws, NeitherPolarisationGainsPower) {
  for (const TypeParam& model : examples<TypeParam>()) {
    const Bsdf bsdf = model;
    for (const V3f& wo : directions_of_arrival())
      for (const float lobe : {0.0F, 0x1.fffffep-1F}) {
        const auto event = sample(bsdf, wo, {lobe, {0.3F, 0.6F}}, 0, TransportMode::power);
        if (!event || !event->delta) continue;
        const auto m = mueller(bsdf, wo, event->wi, true);
        if (!m) continue;
        EXPECT_LE(greatest_share(event->weight * event->pdf, *m), 1 + 1e-5) << wo;
      }
  }
}

// Light scattered by a single facet has its polarisation; multiply scattered light has none.
template <typename Rough>
void expect_facets(const Rough& rough, const V3f& wo, const V3f& wi, const MuellerElements<double>& facet) {
  const auto m = mueller(Bsdf(rough), wo, wi, false);
  ASSERT_TRUE(m);
  const double share = m->p[0];
  EXPECT_GT(share, 0.5);
  EXPECT_LT(share, 1);
  EXPECT_NEAR(m->d[0], share * facet.d, 2 * kMuellerFloat);
  EXPECT_NEAR(m->c[0], share * facet.c, 2 * kMuellerFloat);
  EXPECT_NEAR(m->s[0], share * facet.s, 2 * kMuellerFloat);
}
TEST(Mueller, OfRoughMatterIsThatOfItsFacets) {
  const V3f wo = direction(0.7, 1);
  const auto metal = examples<RoughConductorBsdf>()[2];
  const V3f wi = direction(0.6, 2.5);
  expect_facets(metal, wo, wi, reflection_mueller<double>((wo + wi).length() / 2, 0.2, 3));
  const auto glass = examples<RoughDielectricBsdf>()[1];  // n = 1.5
  expect_facets(glass, wo, wi, reflection_mueller<double>((wo + wi).length() / 2, 1.5, 0));
  const V3f below = direction(-0.9, 4.3);
  const Imath::V3d facet = (Imath::V3d(wo) + 1.5 * Imath::V3d(below)).normalized();
  expect_facets(glass, wo, below, refraction_mueller(std::abs(facet.dot(Imath::V3d(wo))), 1.5));
  expect_facets(glass, below, wo, refraction_mueller(std::abs(facet.dot(Imath::V3d(wo))), 1.5));
}

// The specular part of the mixture's light has the polarisation of its mirror, the rest that of the other
// components.
TEST(Mueller, OfAMixtureIsTheMeanOfWhatItsPartsSend) {
  const auto part = [](double weight, MaterialModel model) {
    return MixtureMaterial::Component{Curve(weight),
                                      std::make_shared<const Material>(Material{"part", std::move(model)})};
  };
  const RefractiveIndex glass(1.5);
  const MixtureMaterial mixture{{part(0.5, ThinGlassMaterial{"glass", glass}),
                                 part(0.2, ConductorMaterial{"metal", RefractiveIndex(0.2, 3)}),
                                 part(0.3, DiffuseMaterial{Curve(0.5)})}};
  const SampledSpectrum nm = packet();
  const Bsdf bsdf = MixtureBsdf(mixture, {nm});
  const V3f wo = direction(0.4, 1);
  const auto m = mueller(bsdf, wo, {-wo.x, -wo.y, wo.z}, true);
  ASSERT_TRUE(m);
  const auto pane = sheet_mueller(0.4, 1.5, 0.0).reflected;
  const auto metal = reflection_mueller(0.4, 0.2, 3.0);
  const double of_pane = 0.5 * sheet_power(0.4, 1.5, 0.0).R();
  const double of_metal = 0.2 * fresnel_conductor(0.4, 0.2, 3.0).R();
  EXPECT_NEAR(m->d[1], (of_pane * pane.d + of_metal * metal.d) / (of_pane + of_metal), kMuellerFloat);
  EXPECT_NEAR(m->s[1], (of_pane * pane.s + of_metal * metal.s) / (of_pane + of_metal), kMuellerFloat);
  const auto through = mueller(bsdf, wo, -wo, true);
  ASSERT_TRUE(through);
  EXPECT_NEAR(through->d[1], sheet_mueller(0.4, 1.5, 0.0).through.d, kMuellerFloat);
  EXPECT_FALSE(mueller(bsdf, wo, direction(0.4, 2), false)) << "what is scattered is not polarised";
}

TEST(Mueller, OfPaintIsThatOfItsCoatInTheMirrorsDirection) {
  const auto paint = examples<CoatedDiffuseBsdf>()[0];
  const V3f wo = direction(0.5, 1);
  const V3f wi(-wo.x, -wo.y, wo.z);
  const auto m = mueller(Bsdf(paint), wo, wi, true);
  ASSERT_TRUE(m);
  EXPECT_NEAR(m->d[0], reflection_mueller(0.5, 1.5, 0.0).d, kMuellerFloat);
  EXPECT_FALSE(mueller(Bsdf(paint), wo, wi, false));
}

}  // namespace
}  // namespace abbe
