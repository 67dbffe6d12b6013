#pragma once

#include <boost/math/distributions/chi_squared.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "materials/bsdf/bsdf.h"

namespace abbe {

/// Numbers in [0, 1) with 24 bits, as samplers give them.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : rng_(seed) {}
  float operator()() { return static_cast<float>(rng_() >> 8U) * 0x1p-24F; }

 private:
  std::mt19937 rng_;
};

using Sampler = std::function<std::optional<BsdfSample>(const BsdfRandom&, int hero)>;
using Density = std::function<double(const Imath::V3f& wi)>;

inline Imath::V3f direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  return Imath::V3f(Imath::V3d(sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta));
}

/// Cells of equal solid angle covering the sphere.
class SphereCells {
 public:
  static constexpr int kRows = 20, kColumns = 24, kFine = 6;
  static constexpr int kCount = kRows * kColumns;
  static constexpr double kTwoPi = 2 * std::numbers::pi;

  static int of(const Imath::V3f& w) {
    const double phi = std::atan2(w.y, w.x) + (w.y < 0 ? kTwoPi : 0);
    const int row = std::min(static_cast<int>((w.z + 1) / 2 * kRows), kRows - 1);
    return row * kColumns + std::min(static_cast<int>(phi / kTwoPi * kColumns), kColumns - 1);
  }
  /// Integral of `density` over each cell by the midpoint rule.
  static std::vector<double> integrate(const Density& density) {
    std::vector<double> integral(kCount, 0.0);
    constexpr double kArea = 2 * kTwoPi / (kCount * kFine * kFine);
    for (int i = 0; i < kRows * kFine; ++i) {
      for (int j = 0; j < kColumns * kFine; ++j) {
        const auto w =
            direction(2 * (i + 0.5) / (kRows * kFine) - 1, kTwoPi * (j + 0.5) / (kColumns * kFine));
        integral[static_cast<std::size_t>(i / kFine * kColumns + j / kFine)] += density(w) * kArea;
      }
    }
    return integral;
  }
};

/// Probability of directions at least as far from `density` as those `sampler` draws, were they drawn from
/// it. Cells that expect fewer than 5 are pooled.
inline double chi_square_p(const Sampler& sampler, const Density& density, int hero, int samples = 200000) {
  Uniform random(17);
  std::vector<double> counted(SphereCells::kCount, 0.0);
  for (int i = 0; i < samples; ++i) {
    const BsdfRandom u{random(), {random(), random()}};
    if (const auto s = sampler(u, hero)) counted[static_cast<std::size_t>(SphereCells::of(s->wi))] += 1;
  }
  const std::vector<double> expected = SphereCells::integrate(density);
  double statistic = 0, pool_expected = 0, pool_counted = 0;
  int cells = 0;
  const auto add = [&](double count, double expect) {
    statistic += (count - expect) * (count - expect) / expect;
    ++cells;
  };
  for (std::size_t i = 0; i < counted.size(); ++i) {
    const double expect = expected[i] * samples;
    if (expect >= 5) {
      add(counted[i], expect);
    } else {
      pool_expected += expect;
      pool_counted += counted[i];
    }
  }
  if (pool_expected > 0) add(pool_counted, pool_expected);
  if (pool_expected == 0 && pool_counted > 0) return 0;
  return boost::math::cdf(complement(boost::math::chi_squared(cells - 1), statistic));
}

/// What a surface returns per lane under constant light, by the balanced estimator over lanes with a hero
/// drawn evenly: the mean of kLanes weight_j / sum_k lane_pdf_k.
inline std::array<double, kLanes> mean_albedo(const Sampler& sampler, int lobes = 4096) {
  Uniform random(5);
  std::array<double, kLanes> albedo{};
  for (int i = 0; i < lobes; ++i) {
    for (int hero = 0; hero < kLanes; ++hero) {
      const BsdfRandom u{(static_cast<float>(i) + random()) / static_cast<float>(lobes),
                         {random(), random()}};
      const auto s = sampler(u, hero);
      if (!s) continue;
      for (int j = 0; j < kLanes; ++j)
        albedo[static_cast<std::size_t>(j)] += double(s->weight[j]) / s->lane_pdf.sum() / lobes;
    }
  }
  return albedo;
}

}  // namespace abbe
