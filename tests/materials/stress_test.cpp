// Interfaces in numerically difficult cases, in the float precision of the render.
// docs/reference/validation.md lists all stress tests.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "materials/bsdf.h"
#include "tests/materials/index_of.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;

// Relative comparison with `exact`, which is computed in long double.
void expect_digits(float got, long double exact, double tolerance, const std::string& at) {
  const auto reference = static_cast<double>(exact);
  EXPECT_NEAR(got, reference, tolerance * reference) << at;
}

// Steps of 1e-9 rad within 1e-7 on both sides of the critical angle, between pairs of real media and of
// nearly equal ones.
TEST(Stress, CriticalAngleWithinATenMillionthKeepsReflectanceInBounds) {
  for (const double n : {1.0001, 1.01, 1.128, 1.333, 1.5, 2.417, 4.0}) {
    const double critical = std::asin(1 / n);
    double last = 0;
    for (int i = -100; i <= 100; ++i) {
      const double c = std::cos(critical + i * 1e-9);
      const auto single = fresnel_dielectric(static_cast<float>(c), static_cast<float>(1 / n));
      for (const float r : {single.Rs, single.Rp, single.Ts, single.Tp})
        ASSERT_TRUE(r >= 0 && r <= 1) << n << ' ' << i;
      const auto f = fresnel_dielectric(c, 1 / n);
      ASSERT_TRUE(f.R() >= last && f.R() <= 1) << n << ' ' << i;
      last = f.R();
      if (i > 0) {
        ASSERT_EQ(f.R(), 1) << n << ' ' << i;
      }
      const DielectricBsdf bsdf{SampledSpectrum(static_cast<float>(n)), false};
      const V3f wo(static_cast<float>(std::sqrt((1 - c) * (1 + c))), 0, static_cast<float>(-c));
      for (const float u : {0.0F, 0.5F, 0x1.fffffep-1F}) {
        const auto s = bsdf.sample(wo, {u, {}}, 0, TransportMode::radiance);
        if (!s) continue;
        ASSERT_TRUE(std::isfinite(s->weight[0]) && s->weight[0] >= 0) << n << ' ' << i;
        ASSERT_NEAR(s->wi.length(), 1, 1e-6) << n << ' ' << i;
      }
    }
  }
}

TEST(Stress, GrazingTransmittanceKeepsFiveDigits) {
  for (const float eta : {0.999F, 1.000001F, 1.001F, 1.128F, 1.5F, 2.417F}) {
    for (const float c : {1e-7F, 3e-7F, 1e-5F}) {
      const auto exact = fresnel_dielectric<long double>(c, eta);
      const auto f = fresnel_dielectric(c, eta);
      expect_digits(f.Ts, exact.Ts, 1e-5, fmt::format("{} {}", eta, c));
      expect_digits(f.Tp, exact.Tp, 1e-5, fmt::format("{} {}", eta, c));
    }
  }
}

TEST(Stress, EqualIndicesTransmitBitForBit) {
  const Coating bare;
  const DielectricBsdf bsdf{SampledSpectrum(1), true};
  Uniform random(8);
  for (int i = 0; i < 100000; ++i) {
    const V3f wo = direction(2 * random() - 1, 6 * random());
    const auto s = bsdf.sample(wo, {i % 2 ? random() : 0.0F, {}}, 0, TransportMode::radiance);
    ASSERT_TRUE(s && s->transmitted);
    ASSERT_EQ(s->wi, -wo);
    ASSERT_EQ(s->weight[0], 1);
    ASSERT_EQ(s->pdf, 1);
    const FresnelPower<double> f = coated_power(bare, 550, 1, 0, std::abs(wo.z), wo.z < 0);
    ASSERT_EQ(f.R(), 0);
  }
}

TEST(Stress, IndicesAMillionthApartBendByAMillionth) {
  for (const float eta : {1 - 1e-6F, 1 + 1e-6F, 1 / (1 + 1e-6F)}) {
    for (double degrees = 0; degrees < 89.8; degrees += 0.25) {
      const double angle = degrees * std::numbers::pi / 180;
      const DielectricBsdf bsdf{SampledSpectrum(eta), false};
      const V3f wo(static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle)));
      const auto s = bsdf.sample(wo, {0x1.fffffep-1F, {}}, 0, TransportMode::power);
      const V3d exact_wo = V3d(wo).normalized();
      const auto exact = refract(exact_wo, V3d(0, 0, 1), static_cast<double>(eta));
      ASSERT_TRUE(s && exact) << degrees;
      const V3d wi(s->wi);
      EXPECT_LT(std::atan2(wi.cross(*exact).length(), wi.dot(*exact)), 1e-6) << eta << ' ' << degrees;
    }
  }
}

// From mirrors that absorb a millionth to metals that hardly reflect.
TEST(Stress, ExtremeMetalsKeepFourDigitsOfAbsorptance) {
  for (const auto& [n, k] : {std::pair{1e-3F, 1e3F}, {1e3F, 1e-3F}, {0.01F, 50.0F}, {1e-3F, 1.0F}}) {
    for (const float c : {1e-7F, 1e-3F, 0.1F, 0.5F, 0.99F, 1.0F}) {
      const auto exact = fresnel_conductor<long double>(c, n, k);
      const auto f = fresnel_conductor(c, n, k);
      expect_digits(f.Ts, exact.Ts, 1e-4, fmt::format("{} {} {}", n, k, c));
      expect_digits(f.Tp, exact.Tp, 1e-4, fmt::format("{} {} {}", n, k, c));
    }
  }
  EXPECT_NEAR(fresnel_conductor(1.0F, 1e-3F, 1e3F).Ts, 4e-9, 1e-4 * 4e-9);
}

TEST(Stress, SellmeierPoleInBandIsALoadError) {
  const auto path = std::filesystem::path(testing::TempDir()) / "pole.yml";
  // C1 = 0.25 um^2: a resonance at 500 nm.
  std::ofstream(path) << "DATA:\n  - type: formula 2\n    wavelength_range: 0.4 0.8\n"
                         "    coefficients: 0 1.04 0.25 0.23 0.02\n";
  Diagnostics diagnostics;
  EXPECT_FALSE(load_index(path.string(), {}, diagnostics));
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
  EXPECT_NE(diagnostics.text().find("resonance at 500 nm"), std::string::npos) << diagnostics.text();
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace abbe
