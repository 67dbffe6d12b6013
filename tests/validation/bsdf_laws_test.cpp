// Laws that every BSDF obeys. The suite runs over the alternatives of Bsdf. A new model cannot be omitted,
// since the file does not compile before `examples` gives instances of it. A model that breaks reciprocity or
// energy conservation by its nature declares so (kReciprocal, kConserving); the test then requires that it
// does break them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/bsdf/warp.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/random_directions.h"
#include "tests/tier.h"
#include "validation/goniometer/lobes.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

constexpr TransportMode kModes[] = {TransportMode::radiance, TransportMode::power};

std::vector<V3f> outgoing() {
  std::vector<V3f> directions;
  for (const double cos_theta : {1.0, 0.83, 0.4, 0.06, -1.0, -0.9, -0.7, -0.2})
    directions.push_back(direction_at(cos_theta, 0.3 + cos_theta));
  return directions;
}
// True if a direction of the examples belongs to the daytime tests. The examples alternate between two pairs:
// a steep direction from above with the flattest from below, and the flattest from above with a steep one
// from below.
bool looked_at_by_day(int turn) {
  const int at = turn % 16;
  return at == 1 || at == 7 || at == 11 || at == 13;
}

template <typename Variant>
struct AsTypes;
template <typename... Models>
struct AsTypes<std::variant<Models...>> {
  using type = testing::Types<Models...>;
  static std::size_t examples_in_all() { return (examples<Models>().size() + ...); }
};

template <typename Model>
constexpr bool reciprocal() {
  if constexpr (requires { Model::kReciprocal; })
    return Model::kReciprocal;
  else
    return true;
}
template <typename Model>
constexpr bool conserving() {
  if constexpr (requires { Model::kConserving; })
    return Model::kConserving;
  else
    return true;
}

template <typename Model>
class BsdfLaws : public testing::Test {
 protected:
  // Calls `check` for every example and outgoing direction.
  template <typename F>
  static void for_all(F check) {
    const std::vector<Model> models = examples<Model>();
    for (std::size_t i = 0; i < models.size(); ++i)
      for (const V3f& wo : outgoing()) {
        SCOPED_TRACE(testing::Message() << "example " << i << ", cos " << wo.z);
        check(Bsdf(models[i]), wo);
      }
  }
};
TYPED_TEST_SUITE(BsdfLaws, AsTypes<Bsdf>::type);

void expect_sound(const Bsdf& bsdf, const V3f& wo, const BsdfSample& s, int hero) {
  EXPECT_NEAR(s.wi.length(), 1, 1e-6);
  EXPECT_EQ(s.transmitted, s.wi.z * wo.z < 0);
  EXPECT_TRUE(s.delta || scatters(bsdf));
  EXPECT_TRUE(s.pdf > 0 && std::isfinite(s.pdf));
  EXPECT_FLOAT_EQ(s.lane_pdf[hero], 1);
  for (int j = 0; j < kLanes; ++j) {
    EXPECT_TRUE(s.weight[j] >= 0 && std::isfinite(s.weight[j]));
    EXPECT_TRUE(s.lane_pdf[j] >= 0 && std::isfinite(s.lane_pdf[j]));
    EXPECT_TRUE(s.lane_pdf[j] > 0 || s.weight[j] == 0) << "a lane that could not have come carries light";
  }
}

// On a grid of lobe choices, the fraction of delta events equals delta_probability. The tolerance is the
// grid's step at each bound between lobes.
TYPED_TEST(BsdfLaws, DeltaProbabilityIsTheShareOfDeltaEvents) {
  const int choices = test::nightly() ? 4096 : 1024;
  const float step = 1 / static_cast<float>(choices);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    const SampledSpectrum told = delta_probability(bsdf, wo);
    for (int hero = 0; hero < kLanes; ++hero) {
      int delta = 0;
      for (int i = 0; i < choices; ++i) {
        const float lobe = (static_cast<float>(i) + 0.5F) * step;
        const auto s = sample(bsdf, wo, {lobe, {0.3F, 0.6F}}, hero, TransportMode::radiance);
        if (s && s->delta) ++delta;
      }
      EXPECT_NEAR(told[hero], static_cast<float>(delta) * step, 8 * step);
    }
  });
}

// The other wavelength samples accompany the hero unless the event is dispersive.
TYPED_TEST(BsdfLaws, DeltaPowerIsWhatDeltaEventsCarry) {
  Uniform random(8);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 40; ++i) {
      const int hero = i % kLanes;
      const auto event = sample(bsdf, wo, random.event(), hero, TransportMode::power);
      if (!event || !event->delta) continue;
      ASSERT_TRUE(DeltaModel<TypeParam>);
      const SampledSpectrum told = delta_power(bsdf, wo, event->transmitted);
      const SampledSpectrum carried = event->weight * event->pdf;
      for (int lane = 0; lane < kLanes; ++lane)
        EXPECT_NEAR(carried[lane], lane == hero || !event->dispersive ? told[lane] : 0, 1e-5);
    }
  });
}

TYPED_TEST(BsdfLaws, SamplesAreSound) {
  Uniform random(1);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    int missing = 0;
    for (int i = 0; i < 200; ++i) {
      const auto s = sample(bsdf, wo, random.event(), i % kLanes, kModes[i / 100]);
      if (s)
        expect_sound(bsdf, wo, *s, i % kLanes);
      else
        ++missing;
    }
    EXPECT_LT(missing, 200);
  });
}

TYPED_TEST(BsdfLaws, GrazingLightIsFinite) {
  Uniform random(6);
  for (const TypeParam& model : examples<TypeParam>())
    for (const float cosine : {1e-7F, -1e-7F, 1e-4F, -1e-4F}) {
      const V3f wo = direction_at(cosine, 1.1);
      for (int i = 0; i < 200; ++i) {
        const int hero = i % kLanes;
        const V3f wi = direction_at(2 * random() - 1, 6 * random());
        for (const TransportMode mode : kModes) {
          const auto s = sample(Bsdf(model), wo, random.event(), hero, mode);
          if (s) expect_sound(model, wo, *s, hero);
          const SampledSpectrum f = eval(Bsdf(model), wo, wi, mode);
          const SampledSpectrum p = pdf(Bsdf(model), wo, wi);
          for (int j = 0; j < kLanes; ++j) {
            EXPECT_TRUE(f[j] >= 0 && std::isfinite(f[j]));
            EXPECT_TRUE(p[j] >= 0 && std::isfinite(p[j]));
          }
        }
      }
    }
}

TYPED_TEST(BsdfLaws, WeightsAndDensitiesAgreeWithEvaluation) {
  Uniform random(2);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 100; ++i) {
      const int hero = i % kLanes;
      const TransportMode mode = kModes[i / 50];
      const auto s = sample(bsdf, wo, random.event(), hero, mode);
      if (!s || s->delta) continue;
      const SampledSpectrum f = eval(bsdf, wo, s->wi, mode);
      const SampledSpectrum p = pdf(bsdf, wo, s->wi);
      // Rounding changes a direction by 1e-7, a large part of the narrowest lobes.
      constexpr float kRounding = 2e-3F;
      EXPECT_NEAR(p[hero], s->pdf, kRounding * s->pdf);
      for (int j = 0; j < kLanes; ++j) {
        const float weighed = f[j] * std::abs(s->wi.z);
        EXPECT_NEAR(s->weight[j] * s->pdf, weighed, kRounding * weighed + 1e-6F);
        EXPECT_NEAR(s->lane_pdf[j] * s->pdf, p[j], kRounding * p[j] + 1e-6F * s->pdf);
      }
    }
  });
}

// Bidirectional techniques evaluate the reverse pdf at a vertex reached from the other end. For each
// wavelength sample as hero, it is the pdf with which the BSDF would have sampled the direction in which the
// path arrived.
TYPED_TEST(BsdfLaws, ReverseDensityIsThatOfSamplingFromTheOtherSide) {
  Uniform random(7);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 200; ++i) {
      const int hero = i % kLanes;
      const auto there = sample(bsdf, wo, random.event(), hero, TransportMode::radiance);
      if (!there || there->delta) continue;
      const SampledSpectrum reverse = pdf(bsdf, there->wi, wo);
      const SampledSpectrum f = eval(bsdf, there->wi, wo, TransportMode::power);
      for (int j = 0; j < kLanes; ++j)
        EXPECT_TRUE(reverse[j] > 0 || !(f[j] > 0)) << "light goes where the other way never looks";
      const auto back = sample(bsdf, there->wi, random.event(), hero, TransportMode::power);
      if (!back || back->delta) continue;
      const SampledSpectrum drawn = pdf(bsdf, there->wi, back->wi);
      for (int j = 0; j < kLanes; ++j)
        EXPECT_NEAR(back->lane_pdf[j] * back->pdf, drawn[j], 2e-3F * drawn[j] + 1e-6F * back->pdf);
    }
  });
}

TYPED_TEST(BsdfLaws, SamplesFollowTheirDensity) {
  // Šidák correction over the whole suite.
  const double checks = static_cast<double>(AsTypes<Bsdf>::examples_in_all() * outgoing().size());
  const double significance = 1 - std::pow(1 - 0.01, 1 / checks);
  int turn = 0;
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    if ((!looked_at_by_day(turn++) && !test::nightly()) || !scatters(bsdf)) return;
    constexpr int kHero = 3;
    const auto density = [&](const V3f& wi) { return static_cast<double>(pdf(bsdf, wo, wi)[kHero]); };
    const DensityCheck check = check_density(sampler_of(bsdf, wo, TransportMode::radiance), density, kHero,
                                             test::nightly() ? 200'000 : 8000);
    EXPECT_GT(check.p, significance);
    EXPECT_LE(check.integral, 1 + 1e-3);
  });
}

// Fraction of `u.lobe` that leads to the direction `wi` for the given `u.direction`. The flag is true if no
// other value of it leads to the same side by a non-delta event.
struct Branch {
  double share = 0;
  bool alone = true;
};
Branch branch_of(const Bsdf& bsdf, const V3f& wo, const V2f& u, int hero, const V3f& wi) {
  constexpr int kSteps = 512;
  Branch branch;
  for (int i = 0; i < kSteps; ++i) {
    const float lobe = (static_cast<float>(i) + 0.5F) / kSteps;
    const auto s = sample(bsdf, wo, {lobe, u}, hero, TransportMode::radiance);
    if (!s || s->delta || s->wi.z * wi.z < 0) continue;
    if ((s->wi - wi).length() < 1e-5F)
      branch.share += 1.0 / kSteps;
    else
      branch.alone = false;
  }
  return branch;
}

// Solid angle per unit of random numbers around `u`. Empty if the difference of float directions is too
// imprecise.
std::optional<double> jacobian(const Bsdf& bsdf, const V3f& wo, const BsdfRandom& u, int hero) {
  constexpr float kStep = 0x1p-8F;
  std::array<V3f, 4> at;
  const std::array<V2f, 4> shifts{V2f(kStep, 0), V2f(-kStep, 0), V2f(0, kStep), V2f(0, -kStep)};
  const auto middle = sample(bsdf, wo, u, hero, TransportMode::radiance);
  if (!middle || middle->delta) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto s = sample(bsdf, wo, {u.lobe, u.direction + shifts[i]}, hero, TransportMode::radiance);
    if (!s || s->delta || s->wi.z * middle->wi.z <= 0) return std::nullopt;
    at[i] = s->wi;
  }
  const V3f along = at[0] - at[1];
  const V3f across = at[2] - at[3];
  if (along.length() < 1e-4F || across.length() < 1e-4F || along.length() > 0.05F || across.length() > 0.05F)
    return std::nullopt;
  return static_cast<double>(along.cross(across).length()) / (4.0 * kStep * kStep);
}

TYPED_TEST(BsdfLaws, DensityTimesJacobianIsTheChanceOfTheBranch) {
  Uniform random(3);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 10; ++i) {
      const BsdfRandom u{random(), {0.1F + 0.8F * random(), 0.1F + 0.8F * random()}};
      const int hero = i % kLanes;
      const auto solid_angle = jacobian(bsdf, wo, u, hero);
      if (!solid_angle) continue;
      const auto s = sample(bsdf, wo, u, hero, TransportMode::radiance);
      const Branch branch = branch_of(bsdf, wo, u.direction, hero, s->wi);
      const double chance = static_cast<double>(s->pdf) * *solid_angle;
      EXPECT_GT(chance, branch.share - 0.03 - 0.05 * branch.share);
      if (branch.alone && !kLobesOverlap<TypeParam>) {
        EXPECT_LT(chance, branch.share + 0.03 + 0.05 * branch.share);
      }
    }
  });
}

TYPED_TEST(BsdfLaws, BothWaysOfTransportAgree) {
  for (const TypeParam& model : examples<TypeParam>()) EXPECT_LT(adjoint_error(model).largest, 2e-3);
}

TYPED_TEST(BsdfLaws, LightMayBeReversed) {
  for (const TypeParam& model : examples<TypeParam>()) {
    const Asymmetry error = reciprocity_error(model);
    if (reciprocal<TypeParam>())
      EXPECT_LT(error.largest, 2e-3);
    else
      EXPECT_GT(error.mean, 2e-3) << "reciprocal after all";
  }
}

TYPED_TEST(BsdfLaws, SingleDirectionsMayBeReversed) {
  Uniform random(4);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 50; ++i) {
      const int hero = i % kLanes;
      const auto there = sample(bsdf, wo, random.event(), hero, TransportMode::power);
      if (!there || !there->delta) continue;
      // The reverse direction, among all possible events.
      for (int step = 0; step < 64; ++step) {
        const float lobe = (static_cast<float>(step) + 0.5F) / 64;
        const auto back = sample(bsdf, there->wi, {lobe, {0, 0}}, hero, TransportMode::power);
        if (!back || !back->delta || back->transmitted != there->transmitted) continue;
        EXPECT_LT((back->wi - wo).length(), 1e-5);
        EXPECT_NEAR(back->pdf * back->weight[hero], there->pdf * there->weight[hero], 2e-5);
        const float n = back->transmitted ? index_inside(bsdf, hero) : 1;
        const float squared_eta = there->wi.z > 0 ? n * n : 1 / (n * n);
        const auto seen = sample(bsdf, there->wi, {lobe, {0, 0}}, hero, TransportMode::radiance);
        const SampledSpectrum a = delta_density(bsdf, *there, 1, TransportMode::power);
        const SampledSpectrum b = delta_density(bsdf, *seen, squared_eta, TransportMode::radiance);
        for (int lane = 0; lane < kLanes; ++lane) EXPECT_NEAR(a[lane], b[lane], 2e-5) << lane;
        break;
      }
    }
  });
}

TYPED_TEST(BsdfLaws, NoEnergyAppears) {
  double most = 0;
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    const AlbedoReplicates white =
        albedo_replicates(sampler_of(bsdf, wo, TransportMode::power), wo, test::nightly() ? 32768 : 8192);
    const std::optional<double> lossless = lossless_within(std::get<TypeParam>(bsdf));
    for (int j = 0; j < kLanes; ++j) {
      const auto lane = static_cast<std::size_t>(j);
      const Estimate reflected = estimate(white.reflected[lane]);
      const Estimate transmitted = estimate(white.transmitted[lane]);
      // Replicates of such uniform sequences often differ in few events and then underestimate the error.
      const double noise = 12 * std::hypot(reflected.standard_error, transmitted.standard_error);
      const double total = reflected.mean + transmitted.mean;
      most = std::max(most, total);
      if (conserving<TypeParam>()) {
        EXPECT_LE(total, 1 + lossless.value_or(1e-3) + noise);
      }
      if (lossless) {
        EXPECT_GE(total, 1 - *lossless - noise);
      }
    }
  });
  if (!conserving<TypeParam>()) {
    EXPECT_GT(most, 1.001) << "conserves energy after all";
  }
}

TYPED_TEST(BsdfLaws, NothingLeavesAlongTheSurface) {
  this->for_all([&](const Bsdf& bsdf, const V3f&) {
    EXPECT_FALSE(sample(bsdf, V3f(1, 0, 0), {0.5F, {0.3F, 0.4F}}, 0, TransportMode::radiance));
  });
}

}  // namespace
}  // namespace abbe
