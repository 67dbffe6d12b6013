// The goniometer must be able to detect a fault.
#include "validation/goniometer/lobes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/bsdf/warp.h"
#include "tests/angles.h"
#include "validation/goniometer/sphere_cells.h"

namespace abbe {
namespace {

using Imath::V3f;

std::optional<BsdfSample> event(const V3f& wi) {
  return BsdfSample{.wi = wi, .weight = {}, .pdf = 1};
}

TEST(SphereCells, CoverTheSphereOnce) {
  std::vector<V3f> narrow;
  for (int i = 0; i < 10000; ++i) {
    const double angle = 1e-3 * std::sqrt((i + 0.5) / 10000);
    narrow.push_back(direction_at(std::cos(angle), 2.4 * i));
  }
  const SphereCells cells(narrow, 100);
  EXPECT_GT(cells.count(), 200);
  double area = 0;
  for (const double part : cells.integrate([](const V3f&) { return 1.0; })) area += part;
  EXPECT_NEAR(area, 4 * kPi, 1e-9);
  std::vector<int> held(cells.count(), 0);
  for (const V3f& w : narrow) ++held[cells.cell_of(w)];
  for (const int h : held) EXPECT_LE(h, 100);
}

TEST(SphereCells, IntegrateALobeAsNarrowAsANeedle) {
  // A Gaussian of width 1e-3 around the pole, in the tangent plane.
  const double sigma = 1e-3;
  std::vector<V3f> guides;
  for (int i = 0; i < 20000; ++i) {
    const double radius = sigma * std::sqrt(-2 * std::log((i + 0.5) / 20000));
    guides.push_back(direction_at(std::sqrt(1 - radius * radius), 2.39996 * i));
  }
  const SphereCells cells(guides, 50);
  double total = 0;
  for (const double part : cells.integrate([&](const V3f& w) {
         const double r2 = static_cast<double>(w.x) * w.x + static_cast<double>(w.y) * w.y;
         return w.z > 0 ? std::exp(-r2 / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma) * w.z : 0.0;
       }))
    total += part;
  EXPECT_NEAR(total, 1, 1e-3);
}

// Without known directions a lobe of width 1e-3 lies in cells of a tenth of a steradian, and no node hits it.
// Samples inside the lobe reveal it.
TEST(SphereCells, FindALobeBetweenTheNodes) {
  const double sigma = 1e-3;
  std::vector<V3f> found;
  for (int i = 0; i < 100; ++i) {
    const double radius = sigma * std::sqrt(-2 * std::log((i + 0.5) / 100));
    found.push_back(direction_at(std::sqrt(1 - radius * radius), 2.39996 * i));
  }
  const SphereCells cells({}, 10);
  double total = 0;
  for (const double part : cells.integrate(
           [&](const V3f& w) {
             const double r2 = static_cast<double>(w.x) * w.x + static_cast<double>(w.y) * w.y;
             return w.z > 0 ? std::exp(-r2 / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma) * w.z : 0.0;
           },
           found))
    total += part;
  EXPECT_NEAR(total, 1, 1e-4);
}

// Directions uniform over a hemisphere, against a uniform pdf and a tilted one.
TEST(CheckDensity, SeesAFewPerCentOfTilt) {
  const LobeSampler uniform = [](const BsdfRandom& u, int) {
    return event(
        direction_at(static_cast<double>(u.direction.x), 2 * kPi * static_cast<double>(u.direction.y)));
  };
  const auto flat = [](const V3f& w) { return w.z > 0 ? 0.5 / kPi : 0.0; };
  const DensityCheck good = check_density(uniform, flat, 0);
  EXPECT_GT(good.p, 1e-3);
  EXPECT_NEAR(good.integral, 1, 1e-9);
  EXPECT_LT(check_density(
                uniform, [](const V3f& w) { return std::max(0.0F, w.z) / kPi; }, 0)
                .p,
            1e-12);
  EXPECT_LT(check_density(
                uniform, [&](const V3f& w) { return flat(w) * (1 + 0.05 * w.x); }, 0, 800000)
                .p,
            1e-6);
}

TEST(CheckDensity, SeesEventsThatAreMissing) {
  const LobeSampler some = [](const BsdfRandom& u, int) -> std::optional<BsdfSample> {
    if (u.lobe < 0.02F) return std::nullopt;
    return event(cosine_hemisphere(u.direction));
  };
  const auto lambert = [](const V3f& w) { return std::max(0.0F, w.z) / kPi; };
  EXPECT_LT(check_density(some, lambert, 0).p, 1e-12);
  EXPECT_GT(check_density(
                some, [&](const V3f& w) { return 0.98 * lambert(w); }, 0)
                .p,
            1e-3);
}

TEST(CheckDensity, LeavesSingleDirectionsOut) {
  const LobeSampler half = [](const BsdfRandom& u, int) {
    auto s = event(u.lobe < 0.5F ? V3f(0, 0, 1) : cosine_hemisphere(u.direction));
    s->delta = u.lobe < 0.5F;
    return s;
  };
  const DensityCheck check = check_density(
      half, [](const V3f& w) { return std::max(0.0F, w.z) / (2 * kPi); }, 0);
  EXPECT_GT(check.p, 1e-3);
  EXPECT_NEAR(check.integral, 0.5, 1e-6);
}

// A fiftieth of the light in a lobe of width 1e-3, as glass reflects it. The samples are too few to refine
// the cells.
TEST(CheckDensity, JudgesANeedleOfFewSamples) {
  const double sigma = 1e-3;
  const auto needle_of = [&](float share) {
    return [&, share](const BsdfRandom& u, int) {
      if (u.lobe >= share) return event(-cosine_hemisphere(u.direction));
      const double radius = sigma * std::sqrt(-2 * std::log1p(-static_cast<double>(u.direction.x)));
      const double phi = 2 * kPi * static_cast<double>(u.direction.y);
      return event(
          V3f(Imath::V3d(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - radius * radius))));
    };
  };
  const auto density = [&](const V3f& w) {
    if (w.z <= 0) return 0.98 * static_cast<double>(-w.z) / kPi;
    const double r2 = static_cast<double>(w.x) * w.x + static_cast<double>(w.y) * w.y;
    return 0.02 * std::exp(-r2 / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma) * w.z;
  };
  const DensityCheck check = check_density(needle_of(0.02F), density, 0);
  EXPECT_NEAR(check.integral, 1, 1e-5);
  EXPECT_GT(check.p, 1e-3);
  EXPECT_LT(check_density(needle_of(0.03F), density, 0).p, 1e-12);
}

// Half a sphere tilted by `tilt_deg`, clipped at the surface. Slices of cells along the edge are thinner than
// the distances between nodes.
LobeSampler leaning(double tilt_deg) {
  return [tilt_deg](const BsdfRandom& u, int) -> std::optional<BsdfSample> {
    const V3f w =
        direction_at(static_cast<double>(u.direction.x), 2 * kPi * static_cast<double>(u.direction.y));
    const auto sine = static_cast<float>(std::sin(tilt_deg * kPi / 180));
    const auto cosine = static_cast<float>(std::cos(tilt_deg * kPi / 180));
    const V3f leant(cosine * w.x + sine * w.z, w.y, cosine * w.z - sine * w.x);
    if (leant.z <= 0) return std::nullopt;
    return event(leant);
  };
}
SphereDensity leaning_density(double tilt_deg) {
  return [tilt_deg](const V3f& w) {
    const double along = std::sin(tilt_deg * kPi / 180) * static_cast<double>(w.x) +
                         std::cos(tilt_deg * kPi / 180) * static_cast<double>(w.z);
    return w.z > 0 && along > 0 ? 0.5 / kPi : 0.0;
  };
}

TEST(CheckDensity, JudgesASliceAtTheHorizon) {
  for (const double tilt_deg : {60.0, 75.0, 80.0, 89.9}) {
    const DensityCheck check = check_density(leaning(tilt_deg), leaning_density(tilt_deg), 0);
    EXPECT_NEAR(check.integral, 1 - tilt_deg / 180, 1e-4) << tilt_deg;
    EXPECT_GT(check.p, 1e-4) << tilt_deg;
  }
}

TEST(CheckDensity, SeesWhatIsDrawnWhereThereShouldBeNothing) {
  constexpr float kAstray = 1e-4F;
  for (const double tilt_deg : {0.0, 75.0}) {
    const LobeSampler astray = [&](const BsdfRandom& u, int hero) {
      return u.lobe < kAstray ? event(-cosine_hemisphere(u.direction)) : leaning(tilt_deg)(u, hero);
    };
    EXPECT_LT(check_density(astray, leaning_density(tilt_deg), 0).p, 1e-12) << tilt_deg;
  }
}

// A lobe of width 1e-4 around the normal, where z has hardly a digit left.
TEST(CheckDensity, JudgesANeedle) {
  const LobeSampler needle = [](const BsdfRandom& u, int) {
    const double radius = 1e-4 * std::sqrt(-2 * std::log1p(-static_cast<double>(u.direction.x)));
    const double phi = 2 * kPi * static_cast<double>(u.direction.y);
    return event(
        V3f(Imath::V3d(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - radius * radius))));
  };
  const auto gaussian = [](double sigma) {
    return [sigma](const V3f& w) {
      const double r2 = static_cast<double>(w.x) * w.x + static_cast<double>(w.y) * w.y;
      return w.z > 0 ? std::exp(-r2 / (2 * sigma * sigma)) / (2 * kPi * sigma * sigma) * w.z : 0.0;
    };
  };
  EXPECT_GT(check_density(needle, gaussian(1e-4), 0).p, 1e-3);
  EXPECT_LT(check_density(needle, gaussian(1.03e-4), 0).p, 1e-6);
}

TEST(Albedo, SeesLanesLeftOutOfTheBalance) {
  SampledSpectrum::Values n;
  for (std::size_t j = 0; j < kLanes; ++j) n[j] = 1.45F + 0.06F * static_cast<float>(j);
  const DielectricBsdf glass{SampledSpectrum(n), true};
  const V3f wo = direction_at(0.4, 0);
  const auto worst = [&](auto spoil) {
    const AlbedoReplicates all = albedo_replicates(
        [&](const BsdfRandom& u, int hero) {
          auto s = glass.sample(wo, u, hero, TransportMode::power);
          spoil(*s, hero);
          return s;
        },
        wo, 4096);
    double error = 0;
    for (std::size_t j = 0; j < kLanes; ++j)
      error =
          std::max(error, std::abs(estimate(all.reflected[j]).mean + estimate(all.transmitted[j]).mean - 1));
    return error;
  };
  EXPECT_LT(worst([](BsdfSample&, int) {}), 1e-3);
  EXPECT_GT(worst([](BsdfSample& s, int) { s.lane_pdf = SampledSpectrum(1); }), 0.01);
  EXPECT_GT(worst([](BsdfSample& s, int hero) {
              if (!s.transmitted) s.weight = SampledSpectrum::only(hero, s.weight[hero]);
            }),
            0.01);
}

// A material with equal random numbers at every wavelength has equal replicates of the albedo.
TEST(Albedo, HasReplicatesByTheSameNumbers) {
  const V3f wo = direction_at(0.2, 0);
  const auto replicates = [&](float reflectance) {
    return albedo_replicates(
        [&](const BsdfRandom& u, int hero) {
          auto s = event(cosine_hemisphere(u.direction));
          s->lane_pdf = SampledSpectrum(1);
          s->weight = SampledSpectrum(hero % 2 == 0 ? reflectance * u.lobe : reflectance);
          return s;
        },
        wo, 256);
  };
  const AlbedoReplicates bright = replicates(1);
  const AlbedoReplicates dim = replicates(0.5F);
  for (std::size_t r = 0; r < kReplicates; ++r)
    EXPECT_NEAR(dim.reflected[3][r], bright.reflected[3][r] / 2, 1e-12);
  EXPECT_NE(bright.reflected[3][0], bright.reflected[3][1]);
  const Estimate equal =
      estimate({0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1});
  EXPECT_EQ(equal.mean, 0.1);
  EXPECT_EQ(equal.standard_error, 0);
}

TEST(Albedo, TellsReflectionFromTransmission) {
  const DielectricBsdf glass{SampledSpectrum(1.5F), false};
  const V3f wo(0, 0, -1);
  const AlbedoReplicates all = albedo_replicates(sampler_of(glass, wo, TransportMode::power), wo, 1 << 14);
  EXPECT_NEAR(estimate(all.reflected[2]).mean, 0.04, 2e-4);
  EXPECT_NEAR(estimate(all.transmitted[2]).mean, 0.96, 2e-4);
}

TEST(Reciprocity, OfLambertIsExact) {
  const Asymmetry error = reciprocity_error(DiffuseBsdf{SampledSpectrum(0.5F)});
  EXPECT_EQ(error.largest, 0);
  EXPECT_EQ(error.mean, 0);
}

}  // namespace
}  // namespace abbe
