// Laws every scattering model obeys. The suite runs over the alternatives of Bsdf, so that a new model cannot
// be left out: it does not compile before `examples` gives some instances of it.
#include "materials/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include "materials/bsdf/warp.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/bsdf_statistics.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

constexpr TransportMode kModes[] = {TransportMode::radiance, TransportMode::power};

// Neither absorbs nor lets anything in that it does not pass on.
bool is_lossless(const Bsdf& bsdf) {
  const auto* films = std::get_if<CoatedDielectricBsdf>(&bsdf);
  if (films == nullptr) return std::holds_alternative<DielectricBsdf>(bsdf);
  return std::none_of(films->coating->matters.begin(), films->coating->matters.end(),
                      [](const Coating::Matter& matter) { return matter.index.absorbing(); });
}

std::vector<V3f> outgoing() {
  std::vector<V3f> directions;
  for (const double cos_theta : {1.0, 0.83, 0.4, 0.06, -1.0, -0.9, -0.7, -0.2})
    directions.push_back(direction(cos_theta, 0.3 + cos_theta));
  return directions;
}

template <typename Variant>
struct AsTypes;
template <typename... Models>
struct AsTypes<std::variant<Models...>> {
  using type = testing::Types<Models...>;
};

template <typename Model>
class BsdfLaws : public testing::Test {
 protected:
  // Calls `check` for every example and outgoing direction.
  template <typename F>
  static void for_all(F check) {
    for (const Model& model : examples<Model>())
      for (const V3f& wo : outgoing()) check(Bsdf(model), wo);
  }
  static Sampler sampler(const Bsdf& bsdf, const V3f& wo, TransportMode mode) {
    return [=](const BsdfRandom& u, int hero) { return sample(bsdf, wo, u, hero, mode); };
  }
};
TYPED_TEST_SUITE(BsdfLaws, AsTypes<Bsdf>::type);

TYPED_TEST(BsdfLaws, SamplesAreSound) {
  Uniform random(1);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 200; ++i) {
      const int hero = i % kLanes;
      const auto s = sample(bsdf, wo, {random(), {random(), random()}}, hero, kModes[i / 100]);
      ASSERT_TRUE(s);
      EXPECT_NEAR(s->wi.length(), 1, 1e-6);
      EXPECT_EQ(s->transmitted, s->wi.z * wo.z < 0);
      EXPECT_TRUE(s->delta || scatters(bsdf));
      EXPECT_GT(s->pdf, 0);
      EXPECT_FLOAT_EQ(s->lane_pdf[hero], 1);
      for (int j = 0; j < kLanes; ++j) {
        EXPECT_TRUE(s->weight[j] >= 0 && std::isfinite(s->weight[j]));
        EXPECT_TRUE(s->lane_pdf[j] > 0 || s->weight[j] == 0)
            << "a lane that could not have come carries light";
      }
    }
  });
}

TYPED_TEST(BsdfLaws, WeightsAndDensitiesAgreeWithEvaluation) {
  Uniform random(2);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 50; ++i) {
      const int hero = i % kLanes;
      const auto s = sample(bsdf, wo, {random(), {random(), random()}}, hero, TransportMode::radiance);
      ASSERT_TRUE(s);
      const SampledSpectrum f = eval(bsdf, wo, s->wi, TransportMode::radiance);
      const SampledSpectrum p = pdf(bsdf, wo, s->wi);
      if (s->delta) {
        EXPECT_TRUE(f.is_zero() && p.is_zero());
        continue;
      }
      EXPECT_NEAR(p[hero], s->pdf, 1e-5F * s->pdf);
      for (int j = 0; j < kLanes; ++j) {
        EXPECT_NEAR(s->weight[j] * s->pdf, f[j] * std::abs(s->wi.z), 1e-6);
        EXPECT_NEAR(s->lane_pdf[j] * s->pdf, p[j], 1e-5F * s->pdf);
      }
    }
  });
}

TYPED_TEST(BsdfLaws, DensitiesIntegrateToOne) {
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    if (!scatters(bsdf)) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      double total = 0;
      for (const double part : SphereCells::integrate([&](const V3f& wi) { return pdf(bsdf, wo, wi)[lane]; }))
        total += part;
      EXPECT_NEAR(total, 1, 1e-3);
    }
  });
}

TYPED_TEST(BsdfLaws, SamplesFollowTheirDensity) {
  const double significance = 1 - std::pow(1 - 0.01, 1.0 / 64);  // Sidak, for at most 64 tests
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    if (!scatters(bsdf)) return;
    const int hero = 3;
    const Density density = [&](const V3f& wi) { return pdf(bsdf, wo, wi)[hero]; };
    EXPECT_GT(chi_square_p(this->sampler(bsdf, wo, TransportMode::radiance), density, hero), significance);
  });
}

TYPED_TEST(BsdfLaws, LightMayBeReversed) {
  Uniform random(4);
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (int i = 0; i < 50; ++i) {
      const int hero = i % kLanes;
      const auto there = sample(bsdf, wo, {random(), {random(), random()}}, hero, TransportMode::power);
      ASSERT_TRUE(there);
      if (!there->delta) {
        const SampledSpectrum forth = eval(bsdf, wo, there->wi, TransportMode::power);
        const SampledSpectrum back = eval(bsdf, there->wi, wo, TransportMode::power);
        for (int j = 0; j < kLanes; ++j) EXPECT_FLOAT_EQ(forth[j], back[j]);
        continue;
      }
      const float lobe = there->transmitted ? 0x1.fffffep-1F : 0.0F;
      const auto back = sample(bsdf, there->wi, {lobe, {0, 0}}, hero, TransportMode::power);
      ASSERT_TRUE(back);
      EXPECT_LT((back->wi - wo).length(), 1e-5);
      EXPECT_NEAR(back->pdf * back->weight[hero], there->pdf * there->weight[hero], 2e-5);
    }
  });
}

TYPED_TEST(BsdfLaws, NoEnergyAppears) {
  this->for_all([&](const Bsdf& bsdf, const V3f& wo) {
    for (const double albedo : mean_albedo(this->sampler(bsdf, wo, TransportMode::power))) {
      EXPECT_LE(albedo, 1 + 1e-3);
      EXPECT_GE(albedo, is_lossless(bsdf) ? 1 - 1e-3 : 0);
    }
  });
}

TYPED_TEST(BsdfLaws, NothingLeavesAlongTheSurface) {
  this->for_all([&](const Bsdf& bsdf, const V3f&) {
    EXPECT_FALSE(sample(bsdf, V3f(1, 0, 0), {0.5F, {0.3F, 0.4F}}, 0, TransportMode::radiance));
  });
}

TEST(DiffuseBsdf, WeighsEveryDirectionByItsReflectance) {
  const DiffuseBsdf bsdf{ramp(0, 0.8F)};
  const auto s = bsdf.sample(V3f(0, 0, -1), {0, {0.2F, 0.7F}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_LT(s->wi.z, 0);
  for (int j = 0; j < kLanes; ++j) EXPECT_EQ(s->weight[j], bsdf.reflectance[j]);
}

TEST(ConductorBsdf, ReflectsEachLaneByItsFresnelReflectance) {
  const ConductorBsdf bsdf{SampledSpectrum(1.0152F), SampledSpectrum(6.6273F)};
  const auto s = bsdf.sample(direction(0.5, 1), {0.9F, {}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->weight[0], 0.900335, 1e-6);
  EXPECT_EQ(s->lane_pdf[5], 1);
}

TEST(Warp, KeepsTheDiscRoundAndItsCentre) {
  EXPECT_EQ(concentric_disc({0.5F, 0.5F}), V2f(0, 0));
  for (int i = 0; i < 100; ++i) {
    const auto edge = static_cast<float>(i) / 100;
    EXPECT_NEAR(concentric_disc({edge, 0}).length(), 1, 1e-6);
    EXPECT_NEAR(concentric_disc({1, edge}).length(), 1, 1e-6);
  }
  for (const V2f& diagonal : {V2f(0.8F, 0.8F), V2f(0.2F, 0.8F), V2f(0.2F, 0.2F), V2f(0.8F, 0.2F)}) {
    const V2f step(1e-4F, 0);
    EXPECT_LT((concentric_disc(diagonal + step) - concentric_disc(diagonal - step)).length(), 1e-3);
  }
  const V3f w = cosine_hemisphere({0.9F, 0.25F});
  EXPECT_NEAR(w.length(), 1, 1e-6);
}

// The tools above must be able to see a fault.
TEST(BsdfStatistics, ChiSquareSeesAUniformHemisphere) {
  const Sampler uniform = [](const BsdfRandom& u, int) {
    return std::optional(BsdfSample{.wi = direction(u.direction.x, 6.2831853 * u.direction.y), .weight = {}});
  };
  const auto flat = [](const V3f& w) { return w.z > 0 ? 0.5 / std::numbers::pi : 0.0; };
  EXPECT_GT(chi_square_p(uniform, flat, 0), 1e-3);
  EXPECT_LT(chi_square_p(
                uniform, [](const V3f& w) { return std::max(0.0F, w.z) / std::numbers::pi; }, 0),
            1e-12);
  const auto tilted = [&](const V3f& w) { return flat(w) * (1 + 0.08 * w.x); };
  EXPECT_LT(chi_square_p(uniform, tilted, 0), 1e-6);
}

TEST(BsdfStatistics, AlbedoSeesLanesLeftOutOfTheBalance) {
  const DielectricBsdf glass{ramp(1.45F, 1.9F), true};
  const V3f wo = direction(0.4, 0);
  const auto worst = [&](auto spoil) {
    double error = 0;
    for (const double albedo : mean_albedo([&](const BsdfRandom&u, int hero) {
           auto s = glass.sample(wo, u, hero, TransportMode::power);
           spoil(*s, hero);
           return s;
         }))
      error = std::max(error, std::abs(albedo - 1));
    return error;
  };
  EXPECT_LT(worst([](BsdfSample&, int) {}), 1e-3);
  EXPECT_GT(worst([](BsdfSample& s, int) { s.lane_pdf = SampledSpectrum(1); }), 0.01);
  EXPECT_GT(worst([](BsdfSample& s, int) {
              if (!s.transmitted) s.weight = SampledSpectrum(1);
            }),
            0.01);
  EXPECT_GT(worst([](BsdfSample& s, int) { s.weight *= 1.005F; }), 4e-3);
}

}  // namespace
}  // namespace abbe
