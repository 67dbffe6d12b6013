// Matter that scatters light.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "validation/cases/film_case.h"
#include "validation/cases/radiative_transfer.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

// A layer of albedo 0.9 below a sky of 1 cd/m^2, deep enough to have no end, under some cosines of its
// normal.
std::vector<Case> layer_cases() {
  constexpr double kAlbedo = 0.9;  // as `deep_layer.json` has it
  constexpr double kDistance = 5;
  const ChandrasekharH h(kAlbedo);
  const double unit = pinhole_exposure(0.1);
  std::vector<Case> cases;
  for (const double mu : {1.0, 0.2})
    cases.push_back(film_case(
        fmt::format("layer-{}", mu), fmt::format("deep layer that scatters evenly, cosine {}", mu),
        "1 - H(μ) sqrt(1 - ϖ) [Chandrasekhar1960, sec. 33]", "deep_layer.json",
        {{"/camera/from", fmt::format("[0, {}, {}]", -kDistance * std::sqrt(1 - mu * mu), kDistance * mu)}},
        unit * (1 - h(mu) * std::sqrt(1 - kAlbedo)), 768));
  return cases;
}

// A lamp of 1 cd half a metre beside the line of sight in fog, and paths of one event.
Case single_case() {
  constexpr double kG = 0.5;  // mean cosine of the phase function [HenyeyGreenstein1941]
  const auto phase = [](double cosine) {
    return (1 - kG * kG) / (4 * std::numbers::pi * std::pow(1 + kG * kG - 2 * kG * cosine, 1.5));
  };
  return film_case("scattered-once", "lamp in fog, light scattered once",
                   "the integral along the line of sight [Chandrasekhar1960, sec. 7]", "lamp_in_fog.json", {},
                   pinhole_exposure(0.01) * scattered_once({0.3, 0.4, phase}, 0.5, 5, 95), 256);
}

}  // namespace

std::vector<Case> scattering_cases() {
  std::vector<Case> all = layer_cases();
  all.push_back(single_case());
  return all;
}

}  // namespace abbe
