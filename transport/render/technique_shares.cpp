#include "transport/render/technique_shares.h"

#include <algorithm>
#include <cmath>

#include "transport/render/technique_pilots.h"

namespace abbe {
namespace {

constexpr int kMostHalvings = 3;

// How often a share, from 1, is halved to come nearest to the root of `wanted` over `whole`: no more than an
// eighth is left of it, and where nothing is known of either it is left whole.
int halvings(double wanted, double whole) {
  if (!(wanted < whole)) return 0;
  if (!(wanted > 0)) return kMostHalvings;
  return static_cast<int>(
      std::min(std::round((std::log2(whole) - std::log2(wanted)) / 2), 1.0 * kMostHalvings));
}

}  // namespace

std::optional<TechniqueCosts> set_technique_shares(Plan& plan, int threads) {
  if (plan.techniques.size() < 2) return std::nullopt;
  const auto pixels = static_cast<double>(plan.photons);
  const PilotFindings found = try_techniques(plan, threads);
  plan.photons_part = found.rays_of_parting.has_value();
  const auto parted =
      static_cast<int>(std::lround(std::log2(std::max(1.0, found.rays_of_parting.value_or(1)))));
  const double photon_variance = std::ldexp(found.photon_variance, parted);
  const double photon_rays = std::ldexp(found.photon_rays, -parted);
  const int fewer_photons = halvings(photon_variance * found.path_rays, found.path_variance * photon_rays);
  const int fewer_paths = halvings(found.path_square * photon_rays, photon_variance * found.path_rays);
  plan.photons = std::max<std::uint64_t>(1, plan.photons >> (parted + fewer_photons));
  plan.path_interval = 1U << fewer_paths;
  return TechniqueCosts{{found.path_variance / pixels, found.path_rays},
                        {found.photon_variance / pixels, found.photon_rays}};
}

}  // namespace abbe
