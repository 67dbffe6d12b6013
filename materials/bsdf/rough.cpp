#include "materials/bsdf/rough.h"

#include <algorithm>
#include <cmath>

namespace abbe {
namespace {

// Table of the energy that perfectly reflecting facets lose.
EnergyCompensation lost_by_mirror(const Microfacets<float>& facets) {
  return EnergyCompensation::tabulate(facets, 1, [&](const Imath::V3f& w, std::span<double> energies) {
    energies[0] = mirror_energy(facets, w);
  })[0];
}

// The relative index n at a coordinate x: the inverse of `RoughInterface::coordinate`.
float index_at(float coordinate) {
  return 1 + coordinate * std::abs(coordinate);
}

// Relative indices at the coordinates for light from outside, followed by those for light from inside.
std::vector<float> both_sides(std::span<const float> coordinates) {
  std::vector<float> etas;
  for (const float x : coordinates) etas.push_back(index_at(x));
  for (const float x : coordinates) etas.push_back(1 / index_at(x));
  return etas;
}

// Largest error of quadratic interpolation of the energies between two coordinates, tested at one and three
// quarters. The cotangents of the tested directions are multiples of the width of slopes.
double interpolation_error(const Microfacets<float>& facets, float low, float high) {
  const float step = (high - low) / 4;
  const std::vector<float> etas =
      both_sides(std::array{low, low + step, low + 2 * step, low + 3 * step, high});
  std::vector<double> energies(etas.size());
  double largest = 0;
  for (const Imath::V2f& along : {Imath::V2f(1, 0), Imath::V2f(0, 1)})
    for (const float cotangent : {0.25F, 0.5F, 1.0F, 2.0F, 4.0F}) {
      const float width = facets.projected_alpha({along.x, along.y, 0});
      dielectric_energies(facets, Imath::V3f(along.x, along.y, cotangent * width).normalized(), etas,
                          energies);
      for (const double* e : {&energies[0], &energies[5]})
        largest = std::max({largest, std::abs(0.375 * e[0] + 0.75 * e[2] - 0.125 * e[4] - e[1]),
                            std::abs(0.375 * e[4] + 0.75 * e[2] - 0.125 * e[0] - e[3])});
    }
  return largest;
}

// Adds the coordinates above `low` up to `high`. The interval is halved up to `halvings` times while the
// interpolation error exceeds 2e-3 of the light, the precision of a table in direction.
void add_coordinates(const Microfacets<float>& facets, float low, float high, int halvings,
                     std::vector<float>& coordinates) {
  constexpr double kTolerance = 2e-3;
  const float center = (low + high) / 2;
  if (halvings == 0 || interpolation_error(facets, low, high) < kTolerance) {
    coordinates.insert(coordinates.end(), {center, high});
    return;
  }
  add_coordinates(facets, low, center, halvings - 1, coordinates);
  add_coordinates(facets, center, high, halvings - 1, coordinates);
}

std::vector<float> tabulated_coordinates(const Microfacets<float>& facets, float low_n, float high_n) {
  const float low = RoughInterface::coordinate(low_n);
  const float high = RoughInterface::coordinate(high_n);
  std::vector<float> coordinates{low};
  if (low < 0 && high > 0) {
    add_coordinates(facets, low, 0, 2, coordinates);
    add_coordinates(facets, 0, high, 2, coordinates);
  } else if (low < high) {
    add_coordinates(facets, low, high, 3, coordinates);
  }
  return coordinates;
}

}  // namespace

RoughMetal::RoughMetal(const Microfacets<float>& of) : facets(of), lost(lost_by_mirror(of)) {}

RoughInterface::RoughInterface(const Microfacets<float>& of, float low, float high)
    : facets(of), low_n(low), high_n(high), coordinates(tabulated_coordinates(of, low, high)) {
  const std::vector<float> etas = both_sides(coordinates);
  const std::vector<EnergyCompensation> tables =
      EnergyCompensation::tabulate(facets, etas.size(), [&](const Imath::V3f& w, std::span<double> energies) {
        dielectric_energies(facets, w, etas, energies);
      });
  const auto inner = tables.begin() + static_cast<std::ptrdiff_t>(coordinates.size());
  lost[0].assign(tables.begin(), inner);
  lost[1].assign(inner, tables.end());
  const float n = index_at(coordinates[sampling_index()]);
  const float inside = n * n * lost[1][sampling_index()].total();
  inside_probability = inside / (lost[0][sampling_index()].total() + inside);
}

}  // namespace abbe
