#include "materials/bsdf/rough.h"

#include <algorithm>

namespace abbe {
namespace {

EnergyCompensation lost_by_mirror(const Microfacets<float>& facets) {
  return EnergyCompensation::tabulate(facets, 1, [&](const Imath::V3f& w, std::span<double> energies) {
    energies[0] = mirror_energy(facets, w);
  })[0];
}

}  // namespace

RoughMetal::RoughMetal(const Microfacets<float>& of) : facets(of), lost(lost_by_mirror(of)) {}

RoughInterface::RoughInterface(const Microfacets<float>& of, float low, float high)
    : facets(of), low_n(low), high_n(high) {
  const std::array<float, kIndices> n{low, crosses_one() ? 1 : (low + high) / 2, high};
  const std::array<float, 2 * kIndices> etas{n[0], n[1], n[2], 1 / n[0], 1 / n[1], 1 / n[2]};
  const std::vector<EnergyCompensation> tables =
      EnergyCompensation::tabulate(facets, etas.size(), [&](const Imath::V3f& w, std::span<double> energies) {
        dielectric_energies(facets, w, etas, energies);
      });
  std::copy_n(tables.begin(), kIndices, lost[0].begin());
  std::copy_n(tables.begin() + kIndices, kIndices, lost[1].begin());
  const float inside = n[1] * n[1] * lost[1][1].total();
  inside_share = inside / (lost[0][1].total() + inside);
}

}  // namespace abbe
