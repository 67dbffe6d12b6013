#include "spectral/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <random>

#include "io/data_directory.h"
#include "io/error.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The definition of a curve, by linear search.
double slow_value(const std::vector<Knot>& knots, double nm) {
  nm = std::clamp<double>(nm, kMinWavelengthNm, kMaxWavelengthNm);
  std::size_t after = 0;
  while (after < knots.size() && knots[after].wavelength_nm <= nm) ++after;
  if (after == 0) return knots.front().value;
  if (after == knots.size()) return knots.back().value;
  const Knot a = knots[after - 1];
  const Knot b = knots[after];
  return a.value + (b.value - a.value) * (nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm);
}

/// Random knots: some on whole nanometres, some crowded, some jumps, some outside the range.
std::vector<Knot> random_knots(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> place(280, 1120);
  std::uniform_real_distribution<double> value(-1, 2);
  std::vector<Knot> knots;
  for (int i = 0; i < count; ++i) {
    const double nm = i % 3 == 0 ? std::floor(place(random)) : place(random);
    knots.push_back({nm, value(random)});
    if (i % 4 == 0) knots.push_back({nm, value(random)});
    if (i % 5 == 0) knots.push_back({nm + 1e-3, value(random)});
  }
  std::stable_sort(knots.begin(), knots.end(),
                   [](const Knot& a, const Knot& b) { return a.wavelength_nm < b.wavelength_nm; });
  return knots;
}

TEST(Curve, evaluates_as_defined_everywhere) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(290, 1110);
  for (const int count : {1, 2, 10, 400, 3000}) {
    const std::vector<Knot> knots = random_knots(random, count);
    const Curve curve(knots);
    for (int i = 0; i < 2000; ++i) {
      const double nm = place(random);
      ASSERT_NEAR(curve(nm), slow_value(knots, nm), 1e-9) << nm << " nm of " << count;
    }
    for (const Knot& knot : knots) {
      ASSERT_NEAR(curve(knot.wavelength_nm), slow_value(knots, knot.wavelength_nm), 1e-12)
          << knot.wavelength_nm;
    }
  }
}

TEST(Curve, nodes_of_a_measured_table_are_exact) {
  Diagnostics diagnostics;
  const auto gold =
      read_table(data_directory() / "metal" / "Au_Johnson.csv", TableOrigin::shipped, diagnostics);
  ASSERT_TRUE(gold) << diagnostics.text();
  const auto nm = *gold->numbers(*gold->column("wavelength_nm"), diagnostics);
  const auto n = *gold->numbers(*gold->column("n"), diagnostics);
  const Curve curve = table_curve(nm, n, Outside::clamp);
  int inside = 0;
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (nm[i] < kMinWavelengthNm || nm[i] > kMaxWavelengthNm) continue;
    EXPECT_EQ(curve(nm[i]), n[i]) << nm[i];
    ++inside;
  }
  EXPECT_GT(inside, 20);
  EXPECT_NEAR(curve(550), 0.424149, 5e-7);
}

TEST(Curve, jump_takes_the_value_on_its_right) {
  const Curve curve = band(500.25, 600);
  EXPECT_EQ(curve(500.25), 1);
  EXPECT_EQ(curve(std::nextafter(500.25, 0)), 0);
  EXPECT_EQ(curve(600), 0);
  EXPECT_EQ(curve(std::nextafter(600, 0)), 1);
}

TEST(Curve, wavelengths_outside_take_the_nearer_end) {
  const Curve curve(std::vector<Knot>{{300, 1}, {1100, 3}});
  EXPECT_EQ(curve(-5), 1);
  EXPECT_EQ(curve(300), 1);
  EXPECT_EQ(curve(1100), 3);
  EXPECT_EQ(curve(1e9), 3);
  EXPECT_EQ(curve(std::numeric_limits<double>::quiet_NaN()), 1);
}

TEST(Curve, is_cut_at_the_range) {
  const Curve curve(std::vector<Knot>{{200, 0}, {400, 2}, {1000, 2}, {1200, 0}});
  EXPECT_DOUBLE_EQ(curve(300), 1);
  EXPECT_DOUBLE_EQ(curve(1100), 1);
  EXPECT_EQ(curve.knots().front().wavelength_nm, 300);
  EXPECT_EQ(curve.knots().back().wavelength_nm, 1100);
  EXPECT_DOUBLE_EQ(curve.integral(), 150 + 1200 + 150);
}

TEST(Curve, packet_matches_scalar) {
  const Curve curve(std::vector<Knot>{{400, 0}, {400.3, 1}, {555, 0.25}, {555, 0.5}, {800, 0}, {1090, 0.3}});
  for (float first = 290; first < 1110; first += 0.97F) {
    SampledSpectrum::Values at;
    for (std::size_t lane = 0; lane < kLanes; ++lane) at[lane] = first + 0.11F * static_cast<float>(lane);
    const SampledSpectrum values = curve(SampledSpectrum(at));
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      ASSERT_NEAR(values[static_cast<int>(lane)], curve(static_cast<double>(at[lane])), 2e-7) << at[lane];
  }
}

TEST(Curve, integral_is_exact_on_any_interval) {
  const Curve curve = sum(band(500, 600, 2), Curve(std::vector<Knot>{{300, 0}, {1100, 8}}));
  EXPECT_NEAR(curve.integral(), 200 + 3200, 1e-9);
  EXPECT_NEAR(curve.integral(599.5, 600.5), 1 + 3.0, 1e-12);
  EXPECT_NEAR(curve.integral(0, 300), 0, 0);
  EXPECT_NEAR(curve.integral(0, 2000), 3400, 1e-9);
  EXPECT_EQ(curve.integral(700, 600), 0);
}

TEST(Curve, extremes_and_constancy) {
  const Curve curve(std::vector<Knot>{{400, 0.2}, {500, 0.7}, {600, -0.1}});
  EXPECT_EQ(curve.max(), 0.7);
  EXPECT_EQ(curve.min(), -0.1);
  EXPECT_FALSE(curve.is_constant());
  EXPECT_TRUE(Curve(0.3).is_constant());
  EXPECT_TRUE(Curve().is_constant());
  EXPECT_EQ(Curve()(500), 0);
  EXPECT_EQ(Curve(0.3)(1099.5), 0.3);
}

TEST(Curve, combinations_are_exact_at_knots_and_whole_nanometres) {
  std::mt19937 random(11);
  const std::vector<Knot> a_knots = random_knots(random, 60);
  const Curve a(a_knots);
  const Curve b = sum(band(450.125, 451.5, 3), Curve(random_knots(random, 40)));
  const Curve ab = product(a, b);
  const Curve a_plus_b = sum(a, b);
  std::vector<double> at;
  for (int nm = 300; nm <= 1100; ++nm) at.push_back(nm);
  for (const Curve* curve : {&a, &b}) {
    for (const Knot& knot : curve->knots()) {
      at.push_back(knot.wavelength_nm);
      at.push_back(std::nextafter(knot.wavelength_nm, 0));
    }
  }
  for (const double nm : at) {
    ASSERT_NEAR(ab(nm), a(nm) * b(nm), 1e-8) << nm;
    ASSERT_NEAR(a_plus_b(nm), a(nm) + b(nm), 1e-8) << nm;
    ASSERT_NEAR(scaled(a, -2)(nm), -2 * a(nm), 1e-12) << nm;
  }
}

TEST(Curve, product_with_a_constant_scales) {
  const Curve curve = band(500, 510);
  EXPECT_EQ(product(curve, Curve(0.5)).knots().size(), curve.knots().size());
  EXPECT_EQ(product(Curve(0.5), curve)(505), 0.5);
  EXPECT_TRUE(product(curve, Curve()).is_constant());
}

/// The edges and the flat top of a narrow filter.
Curve trapezium() {
  return Curve(std::vector<Knot>{{540, 0}, {541, 1}, {549, 1}, {550, 0}});
}

TEST(Curve, steep_factors_have_the_area_of_their_product) {
  const Curve edges = trapezium();
  EXPECT_NEAR(product(edges, edges).integral(), 8 + 2.0 / 3, 1e-12);
  EXPECT_NEAR(product(product(edges, edges), edges).integral(), 8.5, 2e-4);
  const Curve triangle(std::vector<Knot>{{545, 0}, {546, 1}, {547, 0}});
  EXPECT_NEAR(product(triangle, triangle).integral(), 2.0 / 3, 1e-12);
  // One curve falls where the other rises: the product is 0 at both ends of the nanometre.
  const Curve falling(std::vector<Knot>{{540, 1}, {541, 0}});
  const Curve rising(std::vector<Knot>{{540, 0}, {541, 1}});
  EXPECT_NEAR(product(falling, rising).integral(), 1.0 / 6, 1e-12);
  EXPECT_NEAR(product(falling, scaled(rising, -3)).integral(), -3.0 / 6, 1e-12);
}

// Curves without overlap: nothing is divided by their largest product.
TEST(Curve, product_of_curves_apart_is_dark_without_invalid_operations) {
  const Curve blue({{500, 0}, {501, 1}, {502, 0}});
  const Curve red({{600, 0}, {601, 1}, {602, 0}});
  std::feclearexcept(FE_ALL_EXCEPT);
  const Curve dark = product(blue, red);
  EXPECT_EQ(std::fetestexcept(FE_INVALID | FE_DIVBYZERO), 0);
  EXPECT_EQ(dark.integral(), 0);
}

TEST(Curve, product_follows_its_factors_everywhere) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> place(300, 1100);
  const Curve a(random_knots(random, 60));
  const Curve b(random_knots(random, 40));
  const Curve ab = product(a, b);
  const double greatest = std::max(ab.max(), -ab.min());
  for (int i = 0; i < 20000; ++i) {
    const double nm = place(random);
    ASSERT_NEAR(ab(nm), a(nm) * b(nm), 2e-4 * greatest) << nm;
  }
  const Curve squared = product(trapezium(), trapezium());
  EXPECT_GE(squared.min(), 0);
  EXPECT_LE(squared.max(), 1);
}

TEST(Curve, product_of_smooth_curves_takes_no_further_knots) {
  std::vector<Knot> bell;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    bell.push_back({static_cast<double>(nm), std::exp(-std::pow((nm - 550) / 60.0, 2))});
  EXPECT_EQ(product(Curve(bell), planck(2856)).knots().size(), bell.size());
}

TEST(Curve, product_of_tables_that_end_together_holds_at_their_last_row) {
  const std::vector<double> nm{500, 510.25};
  const std::vector<double> values{0.5, 0.6};
  const Curve table = table_curve(nm, values, Outside::zero);
  const Curve squared = product(table, table);
  EXPECT_EQ(squared(510.25), 0.6 * 0.6);
  EXPECT_EQ(squared(510.2500001), 0);
  EXPECT_EQ(squared.knots().size(), 804U);
}

TEST(Curve, integral_of_product_is_exact_where_the_product_curve_is_not) {
  const Curve up(std::vector<Knot>{{300, 0}, {1100, 800}});
  const Curve down(std::vector<Knot>{{300, 800}, {1100, 0}});
  // Integral of x (800 - x) over [0, 800].
  EXPECT_NEAR(integral_of_product(up, down), 800.0 * 800 * 800 / 6, 1e-4);
  EXPECT_NEAR(integral_of_product(up, band(400, 400.001)), 0.1 + 5e-7, 1e-9);
}

TEST(Curve, table_beyond_its_rows) {
  const std::vector<double> nm = {380, 500.5, 780};
  const std::vector<double> values = {1, 2, 3};
  const Curve clamped = table_curve(nm, values, Outside::clamp);
  EXPECT_EQ(clamped(350), 1);
  EXPECT_EQ(clamped(900), 3);
  const Curve zero = table_curve(nm, values, Outside::zero);
  EXPECT_EQ(zero(379.999), 0);
  EXPECT_EQ(zero(380), 1);
  EXPECT_EQ(zero(500.5), 2);
  EXPECT_EQ(zero(780), 3);
  EXPECT_EQ(zero(780.001), 0);
  EXPECT_EQ(zero(300), 0);
  EXPECT_EQ(zero(1100), 0);
}

TEST(Curve, table_reaching_beyond_the_range) {
  const std::vector<double> nm = {200, 400, 1200};
  const std::vector<double> values = {0, 2, 10};
  const Curve curve = table_curve(nm, values, Outside::zero);
  EXPECT_DOUBLE_EQ(curve(300), 1);
  EXPECT_DOUBLE_EQ(curve(1100), 9);
}

TEST(Curve, refuses_impossible_knots) {
  EXPECT_THROW(Curve(std::vector<Knot>{}), Error);
  EXPECT_THROW(Curve(std::vector<Knot>{{500, 1}, {400, 1}}), Error);
  EXPECT_THROW(Curve(std::vector<Knot>{{500, kInfinity}}), Error);
  EXPECT_THROW(Curve(std::vector<Knot>{{std::nan(""), 1}}), Error);
  EXPECT_THROW((void)table_curve(std::vector<double>{400, 400}, std::vector<double>{1, 2}, Outside::clamp),
               Error);
  EXPECT_THROW((void)table_curve(std::vector<double>{400}, std::vector<double>{1, 2}, Outside::clamp), Error);
}

}  // namespace
}  // namespace abbe
