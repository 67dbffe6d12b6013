// A mixture of one component equals the component. Other mixtures are means weighted by the power that each
// component scatters.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "materials/bsdf.h"
#include "materials/material.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/mueller_rounding.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

using Imath::V3f;

// All models that may be mixed, with several kinds of those that polarise.
const std::vector<MaterialModel>& mixable() {
  static const RefractiveIndex gold(0.2, 3);
  static const std::vector<MaterialModel> all{
      FilmMaterial{broad_coat()},
      FilmMaterial{absorbing_film()},
      ConductorMaterial{"gold", gold},
      ConductorMaterial{"gold", gold, absorbing_film()},
      RoughConductorMaterial("gold", gold, facets_of(FacetShape::ggx, 0.4F, 0.4F)),
      CoatedDiffuseMaterial{Curve(0.5), "1.5", RefractiveIndex(1.5)},
      CoatedDiffuseMaterial{Curve(0.5), "glass", dispersive_glass()},
      ThinGlassMaterial{"glass", dispersive_glass()},
      MirrorMaterial{Curve(0.8)},
      SchlickMaterial{Curve(0.3)},
      DepolariserMaterial{{Curve(0.9)}},
      DiffuseMaterial{Curve(0.5)},
      OrenNayarMaterial{Curve(0.7), 30},
      PrincipledMaterial{Curve(0.5), Principled(PrincipledParameters{})},
      CosinePowerMaterial{Curve(0.5), 3, true},
      PhongMaterial{Curve(0.5), 20},
      RetroreflectorMaterial{Curve(0.5), 20}};
  return all;
}

MixtureMaterial::Component part(double weight, MaterialModel model) {
  return {Curve(weight), std::make_shared<const Material>(Material{"part", std::move(model)})};
}

// Directions on both sides, at small and large angles.
std::vector<V3f> ways_from_both_sides() {
  return {direction(0.98, 1), direction(0.4, 2), direction(0.1, 3), direction(-0.7, 4), direction(-0.2, 5)};
}

TEST(Mixture, TestsHoldEveryModelThatMayBeMixed) {
  std::set<std::size_t> held;
  for (const MaterialModel& model : mixable()) held.insert(model.index());
  using Refused = std::variant<DielectricMaterial, RoughDielectricMaterial, MediumMaterial, MixtureMaterial,
                               PolariserMaterial, WavePlateMaterial>;
  EXPECT_EQ(held.size() + std::variant_size_v<Refused>, std::variant_size_v<MaterialModel>);
}

void expect_near(const SampledSpectrum& a, const SampledSpectrum& b, double relative) {
  for (int lane = 0; lane < kLanes; ++lane)
    EXPECT_NEAR(a[lane], b[lane], relative * std::abs(b[lane]) + 1e-6) << "lane " << lane;
}

// Compares the matrices at wavelengths that receive light.
void expect_same(const std::optional<MuellerMatrix>& a, const std::optional<MuellerMatrix>& b,
                 const SampledSpectrum& weight) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->axis, b->axis);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(weight[lane] > 0)) continue;
    EXPECT_NEAR(a->d[lane], b->d[lane], kMuellerFloat);
    EXPECT_NEAR(a->p[lane], b->p[lane], kMuellerFloat);
    EXPECT_NEAR(a->c[lane], b->c[lane], kMuellerFloat);
    EXPECT_NEAR(a->s[lane], b->s[lane], kMuellerFloat);
  }
}

void expect_same_events(const Bsdf& mixed, const Bsdf& alone, const V3f& wo, TransportMode mode) {
  constexpr double kRounding = 2e-3;  // of directions; it is large relative to narrow lobes
  // Compilers fuse multiplications and additions where a function is inlined, but not where it is called.
  constexpr float kLastDigits = 4 * std::numeric_limits<float>::epsilon();
  Uniform random(5);
  for (int i = 0; i < 40; ++i) {
    const int hero = i % kLanes;
    const BsdfRandom u = random.event();
    const auto expected = sample(alone, wo, u, hero, mode);
    const auto event = sample(mixed, wo, u, hero, mode);
    ASSERT_EQ(event.has_value(), expected.has_value());
    if (!event) continue;
    EXPECT_LE((event->wi - expected->wi).length(), kLastDigits);
    EXPECT_EQ(event->delta, expected->delta);
    EXPECT_NEAR(event->pdf, expected->pdf, kRounding * expected->pdf);
    expect_near(event->weight, expected->weight, kRounding);
    expect_near(event->lane_pdf, expected->lane_pdf, kRounding);
    expect_same(mueller(mixed, wo, event->wi, event->delta), mueller(alone, wo, event->wi, event->delta),
                event->weight);
  }
}

TEST(Mixture, OfOnePartIsThatPart) {
  const SampledSpectrum nm = packet();
  for (const MaterialModel& model : mixable()) {
    const Material mixture{"mixture", MixtureMaterial{{part(1, model)}}};
    const Material alone{"alone", model};
    for (const V3f& wo : ways_from_both_sides())
      for (const TransportMode mode : {TransportMode::radiance, TransportMode::power}) {
        SCOPED_TRACE(testing::Message() << "model " << model.index() << ", cos " << wo.z);
        expect_same_events(make_bsdf(mixture, {nm}), make_bsdf(alone, {nm}), wo, mode);
        if (testing::Test::HasFailure()) return;
      }
  }
}

// Directions near Brewster's angle of the film, whose reflection is mainly s-polarised.
TEST(Mixture, OfFilmAndMirrorIsTheMeanByTheirPowers) {
  constexpr double kCos = 0.56;
  const Coating film{{{"2", RefractiveIndex(2)}}, {{0, 100}}};
  const MixtureMaterial mixture{{part(0.5, FilmMaterial{film}), part(0.5, MirrorMaterial{Curve(0.8)})}};
  const SampledSpectrum nm = packet();
  const Bsdf bsdf = mixture.bsdf({nm});
  const V3f wo = direction(kCos, 1);
  const auto reflected = mueller(bsdf, wo, {-wo.x, -wo.y, wo.z}, true);
  const auto through = mueller(bsdf, wo, -wo, true);
  ASSERT_TRUE(reflected && through);
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto power = coated_power(film, nm[lane], 1, 0, kCos, false);
    const auto own = coated_mueller(film, nm[lane], 1, 0, kCos, false);
    const double of_film = power.R() / (power.R() + 0.8);
    EXPECT_GT(own.reflected.d * of_film, 0.02);
    EXPECT_NEAR(reflected->d[lane], of_film * own.reflected.d, kMuellerFloat);
    EXPECT_NEAR(reflected->p[lane], 1, kMuellerFloat);
    EXPECT_NEAR(reflected->c[lane], of_film * own.reflected.c - (1 - of_film), kMuellerFloat);
    EXPECT_NEAR(reflected->s[lane], of_film * own.reflected.s, kMuellerFloat);
    EXPECT_NEAR(through->d[lane], own.through.d, kMuellerFloat);
    EXPECT_NEAR(delta_power(bsdf, wo, true)[lane], 0.5 * power.transmitted(), kMuellerFloat);
  }
}

void expect_elements(const std::optional<MuellerMatrix>& m, int lane, const MuellerElements<double>& traced) {
  EXPECT_NEAR(m ? m->d[lane] : 0, traced.d, 2 * kMuellerFloat);
  EXPECT_NEAR(m ? m->p[lane] : 0, traced.p, 2 * kMuellerFloat);
  EXPECT_NEAR(m ? m->c[lane] : 0, traced.c, 2 * kMuellerFloat);
  EXPECT_NEAR(m ? m->s[lane] : 0, traced.s, 2 * kMuellerFloat);
}

// A ray trace in double precision agrees with the matrices of paths.
void expect_traced(const Material& material, const V3f& wo) {
  const SampledSpectrum nm = packet();
  const Bsdf bsdf = make_bsdf(material, {nm});
  for (int lane = 0; lane < kLanes; ++lane) {
    const SmoothLookup at{nm[lane], std::abs(wo.z), wo.z < 0};
    const auto power = smooth_power(material, at);
    const auto traced = smooth_mueller(material, at);
    ASSERT_TRUE(power && traced);
    EXPECT_NEAR(delta_power(bsdf, wo, false)[lane], power->R(), kMuellerFloat);
    EXPECT_NEAR(delta_power(bsdf, wo, true)[lane], power->transmitted(), kMuellerFloat);
    expect_elements(mueller(bsdf, wo, {-wo.x, -wo.y, wo.z}, true), lane, traced->matrices.reflected);
    expect_elements(mueller(bsdf, wo, -wo, true), lane, traced->matrices.through);
  }
}

TEST(Mixture, IsRenderedAsItIsTraced) {
  for (const MaterialModel& model : mixable()) {
    const Material mixture{"mixture",
                           MixtureMaterial{{part(0.6, model), part(0.4, MirrorMaterial{Curve(0.8)})}}};
    for (const V3f& wo : ways_from_both_sides()) {
      SCOPED_TRACE(testing::Message() << "model " << model.index() << ", cos " << wo.z);
      expect_traced(mixture, wo);
    }
  }
}

}  // namespace
}  // namespace abbe
