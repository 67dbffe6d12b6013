// Enclosures with unlimited interreflection.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "validation/cases/film_case.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

std::vector<Case> integrating_sphere_cases() {
  const double offset = 0.3;
  const double distance2 = 1 + offset * offset;
  const double uniform = 100 / (4 * std::numbers::pi);  // a light of 100 lm at the centre of a sphere of 1 m
  const double direct = uniform / distance2 / std::sqrt(distance2);
  const double reflectance = 0.98;
  const double port = 0.01;  // fraction of the sphere's area, behind the disc
  return {
      film_case("T7", "integrating sphere, light off centre", "sphere multiplier [Goebel1967]",
                "integrating_sphere.json", {}, direct + uniform * 0.5 / (1 - 0.5), 64),
      film_case("T8", "integrating sphere with a port of 1 %, reflectance 0.98",
                "1/(1 - ρ(1 - f)) [Goebel1967]", "port.json", {}, uniform / (1 - reflectance * (1 - port)),
                256),
  };
}

// The smaller of two concentric spheres with r1/r2 = 1/2 has exitance 1; the larger reflects 0.5.
std::vector<Case> concentric_cases() {
  const double view_factor = 0.25;  // fraction of the outer sphere's light that arrives at the inner one
  const double outer = view_factor / (1 - 0.5 * (1 - view_factor));
  const std::string source = "balance of two concentric spheres [Howell2010, app. C]";
  return {
      film_case("T9-outer", "concentric spheres, the outer one", source, "concentric.json", {}, outer, 64),
      film_case("T9-inner", "concentric spheres, the inner one", source, "concentric.json",
                {probe_at("[0, 0, 1.000001]", "[0, 0, 1]")}, 0.5 * outer, 64)};
}

// Illuminances [lx] of two infinite plates of reflectance 0.5; the lower one emits 1 lm/m^2. The light that
// leaves a plate, emitted and reflected, arrives at the other one. `lower` is that of the lower plate.
std::vector<Case> plate_cases() {
  const std::string source = "balance of two infinite plates [Howell2010]";
  const double lower = 1 / (1 - 0.5 * 0.5);
  return {
      film_case("T10-upper", "infinite plates, the dark one", source, "infinite_plates.json", {}, lower, 64),
      film_case("T10-lower", "infinite plates, the emitting one", source, "infinite_plates.json",
                {probe_at("[0.5, 0.5, 0.000001]", "[0, 0, 1]")}, 0.5 * lower, 64)};
}

std::vector<Case> furnace_cases() {
  const std::string source = "geometric series [Howell2010]";
  const auto truncated = [&](int vertices) {
    return film_case(fmt::format("T11-{}", vertices),
                     fmt::format("furnace, paths of at most {} vertices", vertices), source, "furnace.json",
                     {{"/render/max_depth", fmt::format("{}", vertices - 1)}},
                     std::numbers::pi * (1 - std::pow(0.8, vertices)), 16);
  };
  return {film_case("T11", "furnace: emission 0.2, reflectance 0.8", source, "furnace.json", {},
                    std::numbers::pi, 64),
          truncated(4), truncated(16)};
}

}  // namespace

std::vector<Case> enclosure_cases() {
  std::vector<Case> all;
  for (std::vector<Case> (*group)() :
       {integrating_sphere_cases, concentric_cases, plate_cases, furnace_cases})
    for (Case& item : group()) all.push_back(std::move(item));
  return all;
}

}  // namespace abbe
