#include "materials/interface/coating.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/interface/thin_film.h"
#include "materials/material.h"
#include "tests/materials/index_of.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

// A quarter wave of MgF2 at 550 nm, the usual antireflection coating.
Coating coat(double thickness_nm = 99.6) {
  return {{{"MgF2", index_of("MgF2")}}, {{0, thickness_nm}}};
}
Coating mirror() {
  return {{{"high", RefractiveIndex(2.35)}, {"low", RefractiveIndex(1.38)}},
          {{0, 58.5}, {1, 99.6}, {0, 58.5}}};
}

TEST(Coating, OfMgF2LetsGlassReflectAThirdAtItsWavelength) {
  const double n = index_of("N-BK7").n(550.0);
  const double f = index_of("MgF2").n(550.0);
  const double d = 550 / (4 * f);
  const double r = (n - f * f) / (n + f * f);
  EXPECT_NEAR(coated_power(coat(d), 550, n, 0, 1, false).R(), r * r, 1e-9);
  EXPECT_NEAR(r * r, 0.0126, 2e-4);
}

TEST(Coating, WithoutLayersIsTheBareSurface) {
  const auto glass = coated_power({}, 550, 1.5, 0, 0.6, false);
  EXPECT_DOUBLE_EQ(glass.Rp, fresnel_dielectric(0.6, 1.5).Rp);
  EXPECT_DOUBLE_EQ(coated_power({}, 550, 1.5, 0, 0.6, true).Rp, fresnel_dielectric(0.6, 1 / 1.5).Rp);
  EXPECT_DOUBLE_EQ(coated_power({}, 550, 0.9, 6.7, 0.6, false).Rp, fresnel_conductor(0.6, 0.9, 6.7).Rp);
}

TEST(Coating, IsTurnedRoundSeenFromInside) {
  const Coating films{{{"a", RefractiveIndex(2.3)}, {"b", RefractiveIndex(1.4, 0.1)}}, {{0, 70}, {1, 130}}};
  const auto in = coated_power(films, 500, 1.5, 0, 0.8, false);
  const auto out = coated_power(films, 500, 1.5, 0, in.cos_t, true);
  EXPECT_NEAR(in.Ts, out.Ts, 1e-12);
  EXPECT_NEAR(in.Tp, out.Tp, 1e-12);
  EXPECT_NEAR(out.cos_t, 0.8, 1e-12);
  EXPECT_GT(std::abs(in.Rs - out.Rs), 1e-3) << "absorbing films have two faces";
  const double beyond = std::cos(std::asin(1 / 1.5)) * 0.9;
  EXPECT_NEAR(coated_power(mirror(), 500, 1.5, 0, beyond, true).R(), 1, 1e-12);
}

TEST(Coating, IsTheSameForPackets) {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j) nm[j] = 400.0F + 40.0F * static_cast<float>(j);
  const Coating films = coat();
  const CoatingAt at(films, SampledSpectrum(nm));
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto own = at.power(lane, 1.5F, 0, 0.4F, false);
    const auto exact = coated_power(films, nm[static_cast<std::size_t>(lane)], 1.5, 0, double(0.4F), false);
    EXPECT_NEAR(own.Rs, exact.Rs, 1e-6);
    EXPECT_NEAR(own.Rp, exact.Rp, 1e-6);
    EXPECT_NEAR(own.Tp, exact.Tp, 1e-6);
    EXPECT_NEAR(own.cos_t, exact.cos_t, 1e-6);
  }
}

TEST(Coating, MakesItsMaterialsScatterByIt) {
  SampledSpectrum nm(550.0F);
  const Material coated{"lens", DielectricMaterial{"N-BK7", index_of("N-BK7"), coat()}};
  const Bsdf lens = make_bsdf(coated, {nm});
  ASSERT_TRUE(std::holds_alternative<CoatedDielectricBsdf>(lens));
  EXPECT_FLOAT_EQ(index_inside(lens, 3), static_cast<float>(index_of("N-BK7").n(550.0)));
  EXPECT_FLOAT_EQ(index_inside(make_bsdf({"m", DielectricMaterial{"", RefractiveIndex(1.5)}}, {nm}), 3),
                  1.5F);
  EXPECT_EQ(index_inside(make_bsdf({"m", ConductorMaterial{"", RefractiveIndex(0.1, 3)}}, {nm}), 3), 1);
  const auto s = sample(lens, {0, 0, 1}, {0, {}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->pdf, coated_power(coat(), 550, index_of("N-BK7").n(550.0), 0, 1, false).R(), 1e-6);
  const Material oxide{"steel", ConductorMaterial{"", RefractiveIndex(2.9, 3), mirror()}};
  const auto r = sample(make_bsdf(oxide, {nm}), direction(0.5, 0), {0, {}}, 0, TransportMode::radiance);
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->weight[4], coated_power(mirror(), 550, 2.9, 3, 0.5, false).R(), 1e-6);
  EXPECT_GT(std::abs(double(r->weight[4]) - fresnel_conductor(0.5, 2.9, 3.0).R()), 0.01);
}

// All eight wavelengths pass a medium of constant index together, and each loses what its film absorbs.
TEST(Coating, PlainMatterPassesEveryLane) {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j) nm[j] = 400.0F + 40.0F * static_cast<float>(j);
  const Coating films{{{"grey", RefractiveIndex(1.6, 0.2)}}, {{0, 120}}};
  const RefractiveIndex plain(1.5);
  const CoatedDielectricBsdf bsdf{SampledSpectrum(nm), &plain, &films};
  const int hero = 2;
  const auto s = bsdf.sample(direction(0.6, 1), {0x1.fffffep-1F, {}}, hero, TransportMode::power);
  ASSERT_TRUE(s && s->transmitted && !s->dispersive);
  const auto radiance = bsdf.sample(direction(0.6, 1), {0x1.fffffep-1F, {}}, hero, TransportMode::radiance);
  for (int j = 0; j < kLanes; ++j) {
    const auto f = coated_power(films, nm[static_cast<std::size_t>(j)], 1.5, 0, double(0.6F), false);
    EXPECT_NEAR(s->weight[j] * s->pdf, f.transmitted(), 1e-6) << j;
    EXPECT_NEAR(s->lane_pdf[j] * s->pdf, f.transmitted() / (f.R() + f.transmitted()), 1e-6) << j;
    EXPECT_NEAR(radiance->weight[j], s->weight[j] / 2.25F, 1e-6);
  }
}

}  // namespace
}  // namespace abbe
