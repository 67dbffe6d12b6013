#include "materials/index/refractive_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "spectral/air.h"
#include "tests/materials/index_of.h"

namespace abbe {
namespace {

const DispersionFormula kBk7{
    .id = 2,
    .c = {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653},
    .terms = 7};

SampledSpectrum spread_packet(double low_nm, double high_nm) {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j)
    nm[j] = static_cast<float>(low_nm + (high_nm - low_nm) * static_cast<double>(j) / (kLanes - 1));
  return SampledSpectrum(nm);
}

TEST(RefractiveIndex, PacketsAgreeWithDoubles) {
  for (const char* name : {"N-BK7", "N-SF11", "fused_silica", "water_20.0C", "BAF10_hoya", "rutile_o", "ZnS",
                           "air_15C", "Al_Rakic", "water_segelstein"}) {
    const RefractiveIndex index = index_of(name);
    for (int offset = 0; offset < 30; ++offset) {
      const SampledSpectrum nm = spread_packet(300.3 + offset, 1070.0 + offset);
      const SampledSpectrum n = index.n(nm);
      for (int j = 0; j < kLanes; ++j) {
        const double exact = index.n(double(nm[j]));
        EXPECT_NEAR(n[j], exact, 1e-5 * exact) << name << " at " << nm[j];
        EXPECT_NEAR(index.k(nm)[j], index.k(double(nm[j])), 1e-6 * index.k(double(nm[j])));
        const double alpha = index.absorption_per_m(double(nm[j]));
        EXPECT_NEAR(index.absorption_per_m(nm)[j], alpha, 1e-5 * alpha);
      }
    }
  }
}

TEST(RefractiveIndex, SellmeierPacketsAreExactToFloat) {
  const RefractiveIndex index(kBk7, std::nullopt, IndexMedium::air, 300, 2500);
  const SampledSpectrum nm = spread_packet(390, 1010);
  for (int j = 0; j < kLanes; ++j) EXPECT_NEAR(index.n(nm)[j], index.n(double(nm[j])), 3e-7);
}

TEST(RefractiveIndex, IsHeldOutsideItsRange) {
  const RefractiveIndex index(kBk7, std::nullopt, IndexMedium::air, 400, 700);
  EXPECT_EQ(index.n(350.0), index.n(400.0));
  EXPECT_EQ(index.n(900.0), index.n(700.0));
  EXPECT_EQ(index.n(SampledSpectrum(350))[3], index.n(SampledSpectrum(400))[3]);
  EXPECT_NE(index.n(405.0), index.n(400.0));
  EXPECT_EQ(index.low_nm(), 400);
  EXPECT_EQ(index.high_nm(), 700);
}

TEST(RefractiveIndex, VacuumTablesAreDividedByAir) {
  const RefractiveIndex vacuum(kBk7, std::nullopt, IndexMedium::vacuum, 300, 2500);
  const RefractiveIndex air(kBk7, std::nullopt, IndexMedium::air, 300, 2500);
  EXPECT_EQ(vacuum.catalogued_n(550), air.catalogued_n(550));
  EXPECT_EQ(air.n(550.0), air.catalogued_n(550));
  EXPECT_DOUBLE_EQ(vacuum.n(550.0), air.n(550.0) / air_index(550));
  EXPECT_NEAR(vacuum.n(SampledSpectrum(550))[0], vacuum.n(550.0), 3e-7);
  const RefractiveIndex table(Curve(1.5), Curve(), IndexMedium::vacuum, 300, 1100);
  EXPECT_NEAR(table.n(SampledSpectrum(632.8F))[0], 1.5 / air_index(632.8), 1e-7);
  EXPECT_NEAR(index_of("water_20.0C").n(589.2938), 1.33299, 1.1e-5);  // as tabulated against air
}

TEST(RefractiveIndex, ExtinctionsOfVacuumTablesAreDividedByAirToo) {
  const Curve k({{300, 0.2}, {1100, 0.4}});
  const RefractiveIndex vacuum(Curve(1.5), k, IndexMedium::vacuum, 300, 1100);
  const RefractiveIndex formula(kBk7, Extinction{k, {300, 1100}}, IndexMedium::vacuum, 300, 2500);
  EXPECT_EQ(vacuum.catalogued_k(550), k(550));
  for (const RefractiveIndex& index : {vacuum, formula}) {
    EXPECT_DOUBLE_EQ(index.k(550.0), k(550) / air_index(550));
    EXPECT_NEAR(index.k(SampledSpectrum(550))[0], index.k(550.0), 3e-7);
    // k and the wavelength are both smaller in air, so a metre absorbs the same fraction.
    const double alpha = 4e9 * std::numbers::pi * k(550) / air_to_vacuum(550);
    EXPECT_NEAR(index.absorption_per_m(550.0), alpha, 1e-8 * alpha);
  }
  EXPECT_EQ(RefractiveIndex(Curve(1.5), k, IndexMedium::air, 300, 1100).k(550.0), k(550));
}

TEST(RefractiveIndex, KnowsWhereItsExtinctionIsMeasured) {
  const RefractiveIndex glass(kBk7, Extinction{Curve({{400, 1e-6}, {500, 1e-7}}), {400, 500}},
                              IndexMedium::air, 300, 2500);
  EXPECT_FALSE(glass.has_measured_k(399));
  EXPECT_TRUE(glass.has_measured_k(400));
  EXPECT_FALSE(glass.has_measured_k(501));
  EXPECT_EQ(glass.k(350.0), 1e-6) << "held";
  const RefractiveIndex clear(kBk7, std::nullopt, IndexMedium::air, 300, 2500);
  EXPECT_FALSE(clear.k_range());
  EXPECT_EQ(clear.k(500.0), 0);
  EXPECT_TRUE(RefractiveIndex(1.5).has_measured_k(500)) << "which is said to be 0";
  EXPECT_FALSE(RefractiveIndex(Curve(1.5), Curve(), IndexMedium::air, 400, 700).has_measured_k(350));
}

TEST(RefractiveIndex, ConstantsAndTablesKnowTheirNature) {
  const RefractiveIndex glass(1.5);
  EXPECT_FALSE(glass.dispersive());
  EXPECT_FALSE(glass.absorbing());
  EXPECT_EQ(glass.n(SampledSpectrum(500))[7], 1.5F);
  EXPECT_TRUE(RefractiveIndex(1.5, 1e-6).absorbing());
  const RefractiveIndex flat(Curve(1.5), Curve(), IndexMedium::air, 300, 1100);
  EXPECT_FALSE(flat.dispersive());
  EXPECT_TRUE(index_of("N-SF11").dispersive());
  EXPECT_TRUE(index_of("N-SF11").absorbing());
  EXPECT_FALSE(index_of("fused_silica").absorbing());
  EXPECT_TRUE(index_of("Al_Rakic").dispersive());
}

TEST(RefractiveIndex, TablesAreLinearBetweenTheirRows) {
  const RefractiveIndex index(Curve({{400, 1.5}, {500, 1.7}}), Curve({{400, 2}, {500, 3}}), IndexMedium::air,
                              400, 500);
  EXPECT_DOUBLE_EQ(index.n(425.0), 1.55);
  EXPECT_DOUBLE_EQ(index.k(475.0), 2.75);
  EXPECT_DOUBLE_EQ(index.n(399.0), 1.5);
}

}  // namespace
}  // namespace abbe
