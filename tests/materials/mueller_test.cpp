// Mueller matrices of surfaces and media against textbook amplitudes.
#include "materials/interface/mueller.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "materials/bsdf.h"
#include "materials/interface/coating.h"
#include "materials/interface/thin_film.h"
#include "materials/interface/thin_sheet.h"
#include "materials/medium/phase.h"
#include "sampling/angle.h"
#include "tests/materials/fresnel_amplitudes.h"
#include "tests/materials/mueller_rounding.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

using Amplitude = std::complex<double>;
using Imath::V3f;

constexpr double kMuellerDouble = 1e-12;

// Elements by the definition, from amplitudes of the fields perpendicular to the plane of incidence and in
// it.
MuellerElements<double> of_amplitudes(const Amplitude& s, const Amplitude& p) {
  const double sum = std::norm(s) + std::norm(p);
  const Amplitude sp = 2.0 * s * std::conj(p) / sum;
  return {(std::norm(s) - std::norm(p)) / sum, 1, sp.real(), sp.imag()};
}

template <typename T>
double difference(const MuellerElements<T>& a, const MuellerElements<double>& b) {
  return std::max(
      std::max(std::abs(static_cast<double>(a.d) - b.d), std::abs(static_cast<double>(a.p) - b.p)),
      std::max(std::abs(static_cast<double>(a.c) - b.c), std::abs(static_cast<double>(a.s) - b.s)));
}

struct Incidence {
  float cos_i, eta, k;
};
// Random angles and indices, and those with cancellation: along the normal, at grazing angles, near
// Brewster's angle and the critical angle, and for nearly equal indices.
std::vector<Incidence> incidences(bool absorbing) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Incidence> all;
  for (int i = 0; i < 20000; ++i) {
    const double eta = std::exp(3 * (u(rng) - 0.5));
    const double near = std::pow(10, -7 * u(rng)) * (u(rng) < 0.5 ? -1 : 1);
    double cos_i = u(rng);
    if (i % 5 == 1) cos_i = std::abs(near);
    if (i % 5 == 2) cos_i = 1 - std::abs(near);
    if (i % 5 == 3) cos_i = 1 / std::hypot(1, eta) + near;
    if (i % 5 == 4 && eta < 1) cos_i = std::sqrt(1 - eta * eta) + near;
    all.push_back({static_cast<float>(std::clamp(cos_i, 0.0, 1.0)),
                   static_cast<float>(i % 7 == 0 ? 1 + near : eta),
                   static_cast<float>(absorbing ? 8 * u(rng) : 0)});
  }
  return all;
}

TEST(Mueller, FollowsFromFresnelsAmplitudes) {
  for (const bool absorbing : {false, true})
    for (const auto& [cos_i, eta, k] : incidences(absorbing)) {
      const FresnelAmplitudes f = fresnel_amplitudes(cos_i, {eta, k});
      // The textbook amplitudes themselves lose precision when the indices are nearly equal.
      const double lost = std::abs(Amplitude(eta, k) - 1.0);
      if (lost < 1e-3 || cos_i < 1e-4F) continue;
      const auto reflected = of_amplitudes(f.rs, f.rp);
      ASSERT_LT(difference(reflection_mueller<double>(cos_i, eta, k), reflected), 1e-9)
          << cos_i << " " << eta << " " << k;
      const bool total = !absorbing && !(refracted_cosine<double>(cos_i, eta) > 0);
      if (absorbing || total) continue;
      ASSERT_LT(difference(refraction_mueller<double>(cos_i, eta), of_amplitudes(f.ts, f.tp)), 1e-9)
          << cos_i << " " << eta;
    }
}

TEST(Mueller, KeepsItsDigitsInFloat) {
  for (const bool absorbing : {false, true})
    for (const auto& [cos_i, eta, k] : incidences(absorbing)) {
      ASSERT_LT(difference(reflection_mueller(cos_i, eta, k), reflection_mueller<double>(cos_i, eta, k)),
                kMuellerFloat)
          << cos_i << " " << eta << " " << k;
      if (!(refracted_cosine(cos_i, eta) > 0)) continue;
      ASSERT_LT(difference(refraction_mueller(cos_i, eta), refraction_mueller<double>(cos_i, eta)),
                kMuellerFloat)
          << cos_i << " " << eta;
    }
}

// S/(S + P) of the elements agrees with the powers.
TEST(Mueller, AgreesWithThePowers) {
  for (const bool absorbing : {false, true})
    for (const auto& [cos_i, eta, k] : incidences(absorbing)) {
      const auto f =
          absorbing ? fresnel_conductor<double>(cos_i, eta, k) : fresnel_dielectric<double>(cos_i, eta);
      const auto r = reflection_mueller<double>(cos_i, eta, k);
      ASSERT_NEAR(r.d * f.R(), (f.Rs - f.Rp) / 2, 1e-12);
      if (absorbing) continue;
      const auto t = refraction_mueller<double>(cos_i, eta);
      ASSERT_NEAR(t.d * f.transmitted(), (f.Ts - f.Tp) / 2, 1e-12);
      // Neither polarisation loses power.
      ASSERT_NEAR((1 + r.d) * f.R() + (1 + t.d) * f.transmitted(), 1, 1e-12);
      ASSERT_NEAR((1 - r.d) * f.R() + (1 - t.d) * f.transmitted(), 1, 1e-12);
    }
}

TEST(Mueller, OfTotalReflectionIsTheTextbooksPhase) {
  for (const double eta : {0.3, 0.66, 0.99})
    for (int i = 1; i < 1000; ++i) {
      const double sine = eta + (1 - eta) * i / 1000;
      const double cosine = std::sqrt((1 - sine) * (1 + sine));
      // [Born1999, sec. 1.5.4]
      const double phase = 2 * std::atan(cosine * std::sqrt(sine * sine - eta * eta) / (sine * sine));
      const auto m = reflection_mueller(cosine, eta, 0.0);
      EXPECT_NEAR(m.d, 0, kMuellerDouble);
      EXPECT_NEAR(m.c, std::cos(phase), 1e-9);
      EXPECT_NEAR(m.s, std::sin(phase), 1e-9);
      const auto in_float = reflection_mueller(static_cast<float>(cosine), static_cast<float>(eta), 0.0F);
      const double mirrored =
          reflection_mueller<double>(static_cast<float>(cosine), static_cast<float>(eta), 0).s;
      EXPECT_NEAR(in_float.s, mirrored, kMuellerFloat);
    }
}

TEST(Mueller, OfTwoTotalReflectionsInFresnelsRhombIsAQuarterWave) {
  // In glass of index 1.51, reflection at 48 degrees 37' or 54 degrees 37' shifts by an eighth of a wave.
  // [Born1999, sec. 1.5.4]
  const auto quarter = [](double degrees) {
    const auto m = reflection_mueller(std::cos(degrees * kDegree), 1 / 1.51, 0.0);
    return 2 * std::atan2(m.s, m.c);
  };
  EXPECT_NEAR(quarter(54 + 37 / 60.0), std::numbers::pi / 2, 1e-3);
  EXPECT_NEAR(quarter(48 + 37 / 60.0), std::numbers::pi / 2, 1e-3);
}

TEST(Mueller, LeavesOneFieldAtBrewstersAngle) {
  for (const double n : {0.7, 1.33, 1.78}) {
    const auto m = reflection_mueller(1 / std::hypot(1, n), n, 0.0);
    EXPECT_NEAR(m.d, 1, kMuellerDouble);
    EXPECT_NEAR(m.c, 0, kMuellerDouble);
  }
}

TEST(Mueller, OfEqualIndicesIsTheIdentity) {
  const Bsdf nothing = DielectricBsdf{SampledSpectrum(1), false};
  for (const V3f& wo : {V3f(0, 0, 1), direction(0.3, 1), direction(-0.9, 2), direction(1e-6, 0)}) {
    const auto m = mueller(nothing, wo, -wo, true);
    ASSERT_TRUE(m);
    EXPECT_EQ(m->d[3], 0);
    EXPECT_EQ(m->p[3], 1);
    EXPECT_EQ(m->c[3], 1);
    EXPECT_EQ(m->s[3], 0);
  }
  const auto along = refraction_mueller(0.0F, 1.0F);
  EXPECT_TRUE(std::isfinite(along.d) && std::isfinite(along.c));
}

// The sheet's reflection is that of the front face plus that of the back face, order by order.
TEST(Mueller, OfASheetAddsUpItsOrders) {
  for (const double eta : {1.5, 2.4, 0.8})
    for (const double cos_i : {1.0, 0.8, 0.62}) {
      const double depth = 0.3;
      const auto f = fresnel_dielectric(cos_i, eta);
      const auto a = fresnel_amplitudes(cos_i, eta);
      const double rsp = a.rs.real() * a.rp.real();
      const double tsp = std::sqrt(f.Ts * f.Tp);
      const double left = std::exp(-depth / f.cos_t);
      double reflected = rsp;
      double passed = 0;
      double inside = tsp * left;
      for (int order = 0; order < 200; ++order) {
        passed += inside * tsp;
        reflected += inside * rsp * left * tsp;
        inside *= rsp * rsp * left * left;
      }
      const auto power = sheet_power(cos_i, eta, depth);
      const auto m = sheet_mueller(cos_i, eta, depth);
      EXPECT_NEAR(m.reflected.c * power.R(), reflected, kMuellerDouble);
      EXPECT_NEAR(m.through.c * power.transmitted(), passed, kMuellerDouble);
      EXPECT_NEAR(m.reflected.d * power.R(), (power.Rs - power.Rp) / 2, kMuellerDouble);
      EXPECT_NEAR(m.through.d * power.transmitted(), (power.Ts - power.Tp) / 2, kMuellerDouble);
    }
}

TEST(Mueller, OfNoFilmsIsThatOfTheInterface) {
  for (const auto& [eta, k] : {std::pair{1.5, 0.0}, std::pair{0.7, 0.0}, std::pair{0.2, 3.0}})
    for (const double cos_i : {1.0, 0.8, 0.3, 0.01}) {
      const auto m = film_mueller<double>(cos_i, {}, eta, k);
      EXPECT_LT(difference(m.reflected, reflection_mueller(cos_i, eta, k)), 1e-12);
      const FresnelAmplitudes a = fresnel_amplitudes(cos_i, {eta, k});
      const FilmReflection<double> r = film_reflection<double>(cos_i, {}, eta, k);
      EXPECT_NEAR(std::abs(Amplitude(r.s.re, r.s.im) - a.rs), 0, kMuellerDouble);
      EXPECT_NEAR(std::abs(Amplitude(r.p.re, r.p.im) - a.rp), 0, kMuellerDouble);
      if (k > 0 || !(refracted_cosine(cos_i, eta) > 0)) continue;
      EXPECT_LT(difference(m.through, refraction_mueller(cos_i, eta)), 1e-12);
    }
}

// A single film by Airy's sums, which use no matrices. [Born1999, sec. 1.6.4]
TEST(Mueller, OfOneFilmFollowsFromItsInternalReflections) {
  const double n1 = 1.9;
  const double n2 = 1.52;
  const double waves = 0.17;
  for (const double cos_i : {1.0, 0.7, 0.2}) {
    const double cos_1 = refracted_cosine(cos_i, n1);
    const auto in = fresnel_amplitudes(cos_i, n1);
    const auto on = fresnel_amplitudes(cos_1, n2 / n1);
    const Amplitude turn = std::polar(1.0, 2 * std::numbers::pi * waves * n1 * cos_1);
    const auto reflected = [&](const Amplitude& r1, const Amplitude& r2) {
      return (r1 + r2 * turn * turn) / (1.0 + r1 * r2 * turn * turn);
    };
    const auto passed = [&](const Amplitude& r1, const Amplitude& r2, const Amplitude& t) {
      return t * turn / (1.0 + r1 * r2 * turn * turn);
    };
    const std::array layer{FilmLayer<double>{n1, 0, waves}};
    const auto m = film_mueller<double>(cos_i, layer, n2, 0);
    EXPECT_LT(difference(m.reflected, of_amplitudes(reflected(in.rs, on.rs), reflected(in.rp, on.rp))),
              kMuellerDouble);
    EXPECT_LT(difference(m.through, of_amplitudes(passed(in.rs, on.rs, in.ts * on.ts),
                                                  passed(in.rp, on.rp, in.tp * on.tp))),
              kMuellerDouble);
    const Coating coating{{{"film", RefractiveIndex(n1)}}, {{0, waves * 500}}};
    const auto reflection = coated_reflection(coating, 500, n2, 0, cos_i, false);
    const Amplitude r_s(reflection.s.re, reflection.s.im);
    EXPECT_NEAR(std::abs(r_s - reflected(in.rs, on.rs)), 0, kMuellerDouble);
  }
}

TEST(Mueller, OfRayleighScatteringPolarisesAcross) {
  const V3f from(0, 0, 1);
  for (const double cosine : {1.0, 0.7, 0.0, -0.4, -1.0}) {
    const V3f to = direction(cosine, 0.5);
    const auto m = mueller(PhaseFunction(RayleighPhase{}), from, to);
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->d[0], (1 - cosine * cosine) / (1 + cosine * cosine), 1e-6);
    EXPECT_NEAR(m->c[0], 2 * cosine / (1 + cosine * cosine), 1e-6);
    EXPECT_NEAR(m->axis.dot(from), 0, 1e-6);
    EXPECT_NEAR(m->axis.dot(to), 0, 1e-6);
  }
  EXPECT_FALSE(mueller(PhaseFunction(IsotropicPhase{}), from, from));
}

TEST(Mueller, OfMetalsIsThatOfTheirAmplitudes) {
  const Bsdf metal = ConductorBsdf{SampledSpectrum(0.2F), SampledSpectrum(3)};
  const V3f wo = direction(0.4, 1);
  const auto m = mueller(metal, wo, {-wo.x, -wo.y, wo.z}, true);
  ASSERT_TRUE(m);
  const FresnelAmplitudes f = fresnel_amplitudes(0.4, {0.2, 3});
  const auto expected = of_amplitudes(f.rs, f.rp);
  EXPECT_NEAR(m->d[2], expected.d, kMuellerFloat);
  EXPECT_NEAR(m->c[2], expected.c, kMuellerFloat);
  EXPECT_NEAR(m->s[2], expected.s, kMuellerFloat);
  EXPECT_NEAR(m->axis.z, 0, 1e-6) << "across the plane of incidence";
}

}  // namespace
}  // namespace abbe
