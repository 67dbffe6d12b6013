#include "materials/material.h"

#include <gtest/gtest.h>

#include "tests/materials/index_of.h"

namespace abbe {
namespace {

SampledSpectrum visible() {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j) nm[j] = 400.0F + 40.0F * static_cast<float>(j);
  return SampledSpectrum(nm);
}

TEST(Material, DiffuseTakesItsReflectanceAtThePacket) {
  const Material card{"card", DiffuseMaterial{Curve({{400, 0.2}, {700, 0.8}})}};
  const Bsdf bsdf = make_bsdf(card, {visible()});
  ASSERT_TRUE(std::holds_alternative<DiffuseBsdf>(bsdf));
  EXPECT_FLOAT_EQ(std::get<DiffuseBsdf>(bsdf).reflectance[1], 0.28F);
  EXPECT_FALSE(lobes(card).delta);
  EXPECT_FALSE(is_dispersive(card));
  EXPECT_EQ(interior_index(card), nullptr);
}

TEST(Material, DielectricIsRelativeToAir) {
  const Material drop{"drop", DielectricMaterial{"water_20.0C", index_of("water_20.0C")}};
  const Bsdf bsdf = make_bsdf(drop, {visible()});
  ASSERT_TRUE(std::holds_alternative<DielectricBsdf>(bsdf));
  const auto& model = std::get<DielectricBsdf>(bsdf);
  EXPECT_NEAR(model.n[2], interior_index(drop)->n(480.0), 1e-6);
  EXPECT_LT(model.n[2], interior_index(drop)->catalogued_n(480.0) - 2e-4);
  EXPECT_TRUE(model.dispersive);
  EXPECT_TRUE(lobes(drop).delta);
  EXPECT_TRUE(is_dispersive(drop));

  const Material plain{"plain", DielectricMaterial{"1.5", RefractiveIndex(1.5)}};
  EXPECT_FALSE(is_dispersive(plain));
  EXPECT_FALSE(std::get<DielectricBsdf>(make_bsdf(plain, {visible()})).dispersive);
}

TEST(Material, ConductorLetsNoLightIn) {
  const Material mirror{"mirror", ConductorMaterial{"Al_Rakic", index_of("Al_Rakic")}};
  const Bsdf bsdf = make_bsdf(mirror, {visible()});
  ASSERT_TRUE(std::holds_alternative<ConductorBsdf>(bsdf));
  EXPECT_NEAR(std::get<ConductorBsdf>(bsdf).k[3], index_of("Al_Rakic").k(520.0), 1e-5);
  EXPECT_TRUE(lobes(mirror).delta);
  EXPECT_FALSE(is_dispersive(mirror));
  EXPECT_EQ(interior_index(mirror), nullptr);
}

}  // namespace
}  // namespace abbe
