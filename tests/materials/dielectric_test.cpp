#include <gtest/gtest.h>

#include <cmath>

#include "materials/bsdf.h"
#include "materials/interface/fresnel.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

using Imath::V3f;

const BsdfRandom kReflect{0, {}};
const BsdfRandom kRefract{0x1.fffffep-1F, {}};

// The index `first` at the first wavelength, then those of dispersive glass.
DielectricBsdf glass(float first = 1.5F) {
  SampledSpectrum::Values n{first};
  for (std::size_t j = 1; j < kLanes; ++j) n[j] = 1.5F + 0.02F * static_cast<float>(j);
  return {SampledSpectrum(n), true};
}

TEST(DielectricBsdf, ReflectionKeepsEveryLane) {
  const DielectricBsdf bsdf = glass();
  const V3f wo = direction(0.3, 0.5);
  const int hero = 2;
  const auto s = bsdf.sample(wo, kReflect, hero, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->dispersive);
  EXPECT_EQ(s->wi, V3f(-wo.x, -wo.y, wo.z));
  const float hero_R = fresnel_dielectric(wo.z, bsdf.n[hero]).R();
  EXPECT_FLOAT_EQ(s->pdf, hero_R);
  for (int j = 0; j < kLanes; ++j) {
    const float R = fresnel_dielectric(wo.z, bsdf.n[j]).R();
    EXPECT_NEAR(s->weight[j], R / hero_R, 1e-6);
    EXPECT_NEAR(s->lane_pdf[j], R / hero_R, 1e-6);
  }
}

TEST(DielectricBsdf, TotalReflectionIsCertainOnlyForItsLanes) {
  const DielectricBsdf bsdf =
      glass(1.2F);  // critical angle 56.4 degrees; 41.8 and less at the other wavelengths
  const V3f wo = direction(-std::sqrt(0.5), 0);
  const auto total = bsdf.sample(wo, kRefract, 4, TransportMode::radiance);
  ASSERT_TRUE(total);
  EXPECT_FALSE(total->transmitted);
  EXPECT_EQ(total->pdf, 1);
  EXPECT_EQ(total->weight[7], 1);
  EXPECT_LT(total->lane_pdf[0], 0.1F);
  EXPECT_EQ(total->weight[0], total->lane_pdf[0]);
}

TEST(DielectricBsdf, DispersiveRefractionIsTheHerosAlone) {
  const DielectricBsdf bsdf = glass();
  const V3f wo = direction(0.6, 1.1);
  for (int hero = 0; hero < kLanes; ++hero) {
    const auto s = bsdf.sample(wo, kRefract, hero, TransportMode::power);
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->dispersive && s->transmitted);
    EXPECT_NEAR(std::hypot(s->wi.x, s->wi.y) * bsdf.n[hero], 0.8F, 1e-6);
    for (int j = 0; j < kLanes; ++j) {
      EXPECT_NEAR(s->weight[j], j == hero ? 1 : 0, 1e-6);
      EXPECT_EQ(s->lane_pdf[j], j == hero ? 1 : 0);
    }
  }
}

TEST(DielectricBsdf, PlainRefractionKeepsEveryLane) {
  const DielectricBsdf bsdf{SampledSpectrum(1.5F), false};
  const auto s = bsdf.sample(direction(0.6, 1.1), kRefract, 3, TransportMode::power);
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->dispersive);
  for (int j = 0; j < kLanes; ++j) EXPECT_NEAR(s->weight[j], 1, 1e-6);
  EXPECT_EQ(s->lane_pdf[6], 1);
}

// An interface conserves L/n^2. Radiance inside divides by n^2 seen from outside, and multiplies by n^2 seen
// from inside.
TEST(DielectricBsdf, RefractionScalesRadianceByTheSquaredIndex) {
  const DielectricBsdf bsdf{SampledSpectrum(1.5F), false};
  const auto in = bsdf.sample(direction(0.6, 0), kRefract, 0, TransportMode::radiance);
  ASSERT_TRUE(in);
  EXPECT_NEAR(in->weight[0], 1 / 2.25, 1e-6);
  const auto out = bsdf.sample(in->wi, kRefract, 0, TransportMode::radiance);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->weight[0], 2.25, 1e-6);
  EXPECT_NEAR(in->weight[0] * in->pdf * 2.25, out->weight[0] * out->pdf / 2.25, 1e-6);
}

TEST(DielectricBsdf, BothLobesTogetherLoseNothing) {
  const DielectricBsdf bsdf = glass();
  for (const double cos_theta : {1.0, 0.5, 0.01, -1.0, -0.8, -0.76, -0.3}) {
    const V3f wo = direction(cos_theta, 0);
    std::array<double, kLanes> energy{};
    for (int hero = 0; hero < kLanes; ++hero) {
      const auto reflected = bsdf.sample(wo, kReflect, hero, TransportMode::power).value();
      const auto other = bsdf.sample(wo, kRefract, hero, TransportMode::power).value();
      for (std::size_t j = 0; j < kLanes; ++j) {
        energy[j] += reflected.pdf * reflected.weight[static_cast<int>(j)] / reflected.lane_pdf.sum();
        if (other.transmitted)
          energy[j] += other.pdf * other.weight[static_cast<int>(j)] / other.lane_pdf.sum();
      }
    }
    for (const double e : energy) EXPECT_NEAR(e, 1, 2e-6) << cos_theta;
  }
}

TEST(DielectricBsdf, EqualIndicesPassEverythingUnchanged) {
  const DielectricBsdf bsdf{SampledSpectrum(1), true};
  Uniform random(3);
  for (int i = 0; i < 1000; ++i) {
    V3f wo = direction(2 * random() - 1, 6 * random());
    const auto s = bsdf.sample(wo, {i % 2 ? random() : 0.0F, {}}, 0, TransportMode::radiance);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->wi, -wo);
    EXPECT_EQ(s->weight[0], 1);
    EXPECT_EQ(s->pdf, 1);
  }
}

// At grazing incidence 1 - R has no significant digits left, but T has all of them.
TEST(DielectricBsdf, GrazingTransmissionIsUnbiased) {
  const DielectricBsdf bsdf{SampledSpectrum(1.5F), false};
  const V3f wo(1, 0, 1e-5F);
  const auto s = bsdf.sample(wo, kRefract, 0, TransportMode::power);
  ASSERT_TRUE(s && s->transmitted);
  const double exact = fresnel_dielectric(double(wo.z), 1.5).transmitted();
  EXPECT_NEAR(double(s->weight[0]) * s->pdf, exact, 1e-5 * exact);
}

}  // namespace
}  // namespace abbe
