#include "transport/render/technique_balance.h"

#include <algorithm>
#include <cmath>

#include "transport/render/technique_pilots.h"

namespace abbe {
namespace {

constexpr int kMaxHalvings = 3;

// Number of halvings, from 1, that comes nearest to sqrt(wanted / whole): at most three, and none if neither
// value is known.
int halvings(double wanted, double whole) {
  if (!(wanted < whole)) return 0;
  if (!(wanted > 0)) return kMaxHalvings;
  return static_cast<int>(
      std::min(std::round((std::log2(whole) - std::log2(wanted)) / 2), 1.0 * kMaxHalvings));
}

}  // namespace

std::optional<TechniqueCosts> balance_techniques(Plan& plan, int threads) {
  if (plan.techniques.size() < 2) return std::nullopt;
  const auto pixels = static_cast<double>(plan.photons);
  const TechniqueStatistics statistics = measure_techniques(plan, threads);
  plan.photons_split_wavelengths = statistics.split_ray_ratio.has_value();
  const auto log2_split_ratio =
      static_cast<int>(std::lround(std::log2(std::max(1.0, statistics.split_ray_ratio.value_or(1)))));
  const double photon_variance = std::ldexp(statistics.photon_variance, log2_split_ratio);
  const double photon_rays = std::ldexp(statistics.photon_rays, -log2_split_ratio);
  const int fewer_photons =
      halvings(photon_variance * statistics.path_rays, statistics.path_variance * photon_rays);
  const int fewer_paths =
      halvings(statistics.path_square * photon_rays, photon_variance * statistics.path_rays);
  plan.photons = std::max<std::uint64_t>(1, plan.photons >> (log2_split_ratio + fewer_photons));
  plan.path_interval = 1U << fewer_paths;
  return TechniqueCosts{{statistics.path_variance / pixels, statistics.path_rays},
                        {statistics.photon_variance / pixels, statistics.photon_rays}};
}

}  // namespace abbe
