#include "materials/interface/fresnel.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/angles.h"
#include "tests/materials/fresnel_amplitudes.h"

namespace abbe {
namespace {

double cosine(double degrees) {
  return degrees == 90 ? 0 : std::cos(degrees * kDegree);
}

TEST(Fresnel, GlassAtNormalIncidenceAndSchlick) {
  const double r0 = fresnel_dielectric(1.0, 1.5).R();
  EXPECT_NEAR(r0, 0.04, 1e-15);
  EXPECT_NEAR(schlick(cosine(60), r0), 0.07, 1e-12);
}

TEST(Fresnel, LosesNothing) {
  for (const double eta : {0.3, 0.66, 0.999999, 1.000001, 1.5, 4.0, 30.0}) {
    for (const double c : {1e-12, 1e-7, 1e-3, 0.2, 0.75, 0.9999, 1.0}) {
      const auto f = fresnel_dielectric(c, eta);
      EXPECT_NEAR(f.Rs + f.Ts, 1, 4e-15);
      EXPECT_NEAR(f.Rp + f.Tp, 1, 4e-15);
      const auto metal = fresnel_conductor(c, eta, 0.7);
      EXPECT_NEAR(metal.Rs + metal.Ts, 1, 4e-15);
      EXPECT_NEAR(metal.Rp + metal.Tp, 1, 4e-15);
    }
  }
}

TEST(Fresnel, IsTheSameFromBothSides) {
  for (const double c : {0.05, 0.4, 0.9}) {
    const auto in = fresnel_dielectric(c, 1.5);
    const auto out = fresnel_dielectric(in.cos_t, 1 / 1.5);
    EXPECT_NEAR(in.Rs, out.Rs, 1e-14);
    EXPECT_NEAR(in.Rp, out.Rp, 1e-14);
    EXPECT_NEAR(out.cos_t, c, 1e-14);
  }
}

TEST(Fresnel, EqualIndicesReflectNothing) {
  for (const float c : {1e-30F, 1e-7F, 0.1F, 0.7F, 1.0F}) {
    const auto f = fresnel_dielectric(c, 1.0F);
    EXPECT_EQ(f.R(), 0.0F);
    EXPECT_EQ(f.transmitted(), 1.0F);
    EXPECT_EQ(f.cos_t, c);
  }
}

TEST(Fresnel, ConductorWithoutAbsorptionIsADielectric) {
  for (const double eta : {0.5, 1.0, 1.5}) {
    for (const double c : {0.1, 0.6, std::sqrt(0.75), 1.0}) {
      const auto dielectric = fresnel_dielectric(c, eta);
      const auto conductor = fresnel_conductor(c, eta, 0.0);
      EXPECT_NEAR(conductor.Rs, dielectric.Rs, 1e-7);  // sqrt of the rounding at the critical angle
      EXPECT_NEAR(conductor.Rp, dielectric.Rp, 1e-7);
      EXPECT_NEAR(conductor.Tp, dielectric.Tp, 1e-7);
    }
  }
}

TEST(Fresnel, AmplitudesGiveThePowers) {
  for (const std::complex<double> eta :
       {std::complex(1.5, 0.0), std::complex(0.6, 0.0), std::complex(1.0, 6.6)}) {
    for (const double c : {0.1, 0.5, 0.95}) {
      const FresnelAmplitudes a = fresnel_amplitudes(c, eta);
      const auto f =
          eta.imag() > 0 ? fresnel_conductor(c, eta.real(), eta.imag()) : fresnel_dielectric(c, eta.real());
      EXPECT_NEAR(std::norm(a.rs), f.Rs, 1e-13);
      EXPECT_NEAR(std::norm(a.rp), f.Rp, 1e-13);
      EXPECT_NEAR(std::abs(1.0 + a.rs - a.ts), 0, 1e-13);  // the tangential field is continuous
      EXPECT_NEAR(std::abs((1.0 + a.rp) - eta * a.tp), 0, 1e-13);
    }
  }
  const FresnelAmplitudes total = fresnel_amplitudes(cosine(60), 1 / 1.5);
  const double shift = 2 * std::atan(std::sqrt(0.75 - 1 / 2.25) / 0.5);
  EXPECT_NEAR(std::arg(total.rs), -shift, 1e-13);
}

TEST(Fresnel, DifferentiatesWithDualNumbers) {
  using Jet = ceres::Jet<double, 2>;
  const double h = 1e-6, c = 0.4, n = 1.3, k = 0.8;
  const auto d = fresnel_dielectric(Jet(c), Jet(n, 0));
  EXPECT_NEAR(d.R().v[0], (fresnel_dielectric(c, n + h).R() - fresnel_dielectric(c, n - h).R()) / (2 * h),
              1e-8);
  const auto m = fresnel_conductor(Jet(c), Jet(n, 0), Jet(k, 1));
  EXPECT_NEAR(m.R().v[1], (fresnel_conductor(c, n, k + h).R() - fresnel_conductor(c, n, k - h).R()) / (2 * h),
              1e-8);
}

TEST(Fresnel, ThePerfectMirrorReflectsAllAlongTheNormalToo) {
  for (const double c : {1.0, 0.5, 1e-3}) {
    const auto mirror = fresnel_conductor(c, 0.0, 0.0);
    EXPECT_EQ(mirror.R(), 1) << c;
    EXPECT_EQ(mirror.transmitted(), 0) << c;
  }
}

}  // namespace
}  // namespace abbe
