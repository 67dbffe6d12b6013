// Scattering media.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "spectral/colorimetry.h"
#include "validation/cases/film_case.h"
#include "validation/cases/radiative_transfer.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

// A layer of albedo 0.9 below a sky of 1 cd/m^2, viewed at some cosines. It is deep enough to count as
// infinite.
std::vector<Case> layer_cases() {
  constexpr double kAlbedo = 0.9;  // as in `deep_layer.json`
  constexpr double kDistance = 5;
  std::vector<Case> cases;
  for (const double mu : {1.0, 0.2})
    cases.push_back(film_case(
        fmt::format("layer-{}", mu), fmt::format("deep isotropically scattering layer, cosine {}", mu),
        "1 - H(μ) sqrt(1 - ϖ) [Chandrasekhar1960, sec. 33]", "deep_layer.json",
        {{"/camera/from", fmt::format("[0, {}, {}]", -kDistance * std::sqrt(1 - mu * mu), kDistance * mu)}},
        [mu] { return pinhole_exposure(0.1) * (1 - ChandrasekharH(kAlbedo)(mu) * std::sqrt(1 - kAlbedo)); },
        768));
  return cases;
}

// A light of 1 cd in fog, half a metre from the line of sight, with paths of one scattering event. The fog
// scatters equally at all wavelengths, or blue more than red. The luminance of the latter is a mean over the
// observer.
std::vector<Case> single_cases() {
  constexpr double kG = 0.5;  // mean cosine of the phase function [HenyeyGreenstein1941]
  const auto phase = [](double cosine) {
    return (1 - kG * kG) / (4 * std::numbers::pi * std::pow(1 + kG * kG - 2 * kG * cosine, 1.5));
  };
  constexpr double kAbsorption = 0.1;  // as in `lamp_in_fog.json`
  const auto radiance = [phase](double scattering) {
    return single_scattering_radiance({scattering, scattering + kAbsorption, phase}, 0.5, 5, 95);
  };
  const auto luminance = [radiance] {
    const Curve& y = color_matching(Observer::cie1931).y;
    double sum = 0;
    double weights = 0;
    for (double nm = 382.5; nm < 780; nm += 5) {
      sum += y(nm) * radiance(1 - 0.9 * (std::clamp(nm, 440.0, 660.0) - 440) / 220);
      weights += y(nm);
    }
    return sum / weights;
  };
  const std::string source = "the integral along the line of sight [Chandrasekhar1960, sec. 7]";
  const double unit = pinhole_exposure(0.01);
  return {film_case(
              "scattered-once", "light in fog, single scattering", source, "lamp_in_fog.json", {},
              [=] { return unit * radiance(0.3); }, 256),
          film_case(
              "scattered-blue", "light in fog that scatters blue light, single scattering", source,
              "lamp_in_fog.json",
              {{"/materials/fog/medium/scattering_per_m",
                R"({"table": {"wavelength_nm": [440, 660], "values": [1, 0.1], "outside": "clamp"}})"}},
              [=] { return unit * luminance(); }, 8192)};
}

}  // namespace

std::vector<Case> scattering_cases() {
  std::vector<Case> all = layer_cases();
  for (Case& item : single_cases()) all.push_back(std::move(item));
  return all;
}

}  // namespace abbe
