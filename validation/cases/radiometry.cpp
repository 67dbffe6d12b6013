#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"
#include "validation/cases/case.h"

namespace abbe {
namespace {

constexpr double kPi = std::numbers::pi;

// Irradiance on a face of the cubic room of side `side` m, direct and interreflected, as the mean over the
// face [lx].
double room_irradiance(double flux_lm, double side, double reflectance) {
  return flux_lm / (6 * side * side) / (1 - reflectance);
}

// Configuration factor of a differential area facing a parallel X x Y rectangle at unit distance, under its
// corner.
double corner_factor(double x, double y) {
  const double a = std::sqrt(1 + x * x);
  const double b = std::sqrt(1 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * kPi);
}

// The same for a perpendicular rectangle that starts at the normal's foot: `x` wide, `y` the distance, unit
// height.
double perpendicular_factor(double x, double y) {
  const double c = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / c * std::atan(1 / c)) / (2 * kPi);
}

// A differential area parallel to a disc of radius r at distance h, its foot at distance a from the axis.
double disc_factor(double r, double h, double a) {
  const double z = h * h + a * a + r * r;
  return 0.5 * (1 - (h * h + a * a - r * r) / std::sqrt(z * z - 4 * a * a * r * r));
}

// What a pinhole of f-number 1 and a square field of view makes of unit radiance: pi/4 times the mean of
// cos^4.
double pinhole_exposure(double fov_deg) {
  constexpr int kSteps = 400;
  const double half = std::tan(fov_deg / 2 * kPi / 180);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = half * (2 * (i + 0.5) / kSteps - 1);
      const double y = half * (2 * (j + 0.5) / kSteps - 1);
      sum += 1 / std::pow(1 + x * x + y * y, 2);
    }
  return kPi / 4 * sum / (kSteps * kSteps);
}

// Transmittance and reflectance of a plate with all internal bounces, the unpolarised reflectance chained,
// `internal` the transmittance of one crossing.
struct Plate {
  double transmittance;
  double reflectance;
};
Plate plate(double angle_deg, double n, double internal) {
  const double r = fresnel_dielectric(std::cos(angle_deg * kPi / 180), n).R();
  const double loop = 1 - r * r * internal * internal;
  return {(1 - r) * (1 - r) * internal / loop, r + (1 - r) * (1 - r) * r * internal * internal / loop};
}

std::vector<Case> room_cases() {
  std::vector<Case> cases;
  for (const double reflectance : {0.0, 0.2, 0.5, 0.8, 0.95})
    cases.push_back({"T1",
                     fmt::format("cubic room, reflectance {}: mean irradiance of a wall", reflectance),
                     "closed-enclosure balance [CIE171, 5.8]",
                     "room.json",
                     {{"/materials/wall/diffuse/reflectance", fmt::format("{}", reflectance)}},
                     "Y",
                     room_irradiance(10000, 4, reflectance),
                     reflectance > 0.9 ? 256 : 64});
  const auto direct_at = [](const char* where, const char* at, double expected) {
    return Case{
        "T2",
        fmt::format("cubic room, direct light at {}", where),
        "inverse square and cosine laws",
        "room.json",
        {{"/materials/wall/diffuse/reflectance", "0"},
         {"/camera", fmt::format(R"({{"irradiance_probe": {{"at": {}, "normal": [0, 0, 1]}}}})", at)}},
        "Y",
        expected,
        4};
  };
  const double intensity = 10000 / (4 * kPi);
  cases.push_back(direct_at("the centre of a wall", "[0, 0, -2]", intensity / 4));
  cases.push_back(direct_at("a corner", "[1.999999, 1.999999, -2]", intensity / 12 / std::sqrt(3.0)));
  return cases;
}

std::vector<Case> form_factor_cases() {
  const auto probe = [](const char* at, const char* normal) {
    return Override{"/camera",
                    fmt::format(R"({{"irradiance_probe": {{"at": {}, "normal": {}}}}})", at, normal)};
  };
  return {
      {"T3",
       "square emitter, under its corner",
       "configuration factor [Howell2010, B-4]",
       "rectangle.json",
       {},
       "Y",
       kPi * corner_factor(1, 1),
       64},
      {"T3",
       "square emitter, under its centre",
       "four corner factors",
       "rectangle.json",
       {probe("[0.5, 0.5, 0]", "[0, 0, 1]")},
       "Y",
       kPi * 4 * corner_factor(0.5, 0.5),
       64},
      {"T3",
       "square emitter facing along x",
       "configuration factor [Howell2010, B-4]",
       "rectangle.json",
       {probe("[0, 0, 0]", "[1, 0, 0]"),
        {"/lights/0/quad/corner", "[1, 0, 0]"},
        {"/lights/0/quad/edge_u", "[0, 0, 1]"},
        {"/lights/0/quad/edge_v", "[0, 1, 0]"}},
       "Y",
       kPi * corner_factor(1, 1),
       64},
      {"T4",
       "square emitter above the receiver's horizon",
       "configuration factor [Howell2010, B-3]",
       "rectangle.json",
       {probe("[0, 0, 0]", "[1, 0, 0]")},
       "Y",
       kPi * perpendicular_factor(1, 1),
       64},
      {"T5",
       "disc emitter, on its axis",
       "configuration factor [Howell2010, B-12]",
       "disc.json",
       {},
       "Y",
       kPi * disc_factor(1, 1, 0),
       64},
      {"T5",
       "disc emitter, off its axis",
       "configuration factor [Howell2010, B-13]",
       "disc.json",
       {probe("[1, 0, 0]", "[0, 0, 1]"), {"/lights/0/disc/radius", "0.5"}},
       "Y",
       kPi * disc_factor(0.5, 1, 1),
       64},
  };
}

std::vector<Case> enclosure_cases() {
  const double offset = 0.3;
  const double distance2 = 1 + offset * offset;
  const double direct = 100 / (4 * kPi * distance2) / std::sqrt(distance2);
  const auto truncated = [](int vertices) {
    return Case{"T11",
                fmt::format("furnace, paths of at most {} vertices", vertices),
                "geometric series",
                "furnace.json",
                {{"/render/max_depth", fmt::format("{}", vertices - 1)}},
                "Y",
                kPi * (1 - std::pow(0.8, vertices)),
                16};
  };
  return {
      {"T7",
       "integrating sphere, lamp off centre",
       "sphere multiplier",
       "integrating_sphere.json",
       {},
       "Y",
       direct + 100 / (4 * kPi) * 0.5 / (1 - 0.5),
       64},
      {"T11", "furnace: emission 0.2, reflectance 0.8", "geometric series", "furnace.json", {}, "Y", kPi, 64},
      truncated(4),
      truncated(16),
  };
}

std::vector<Case> dome_cases() {
  const auto sphere_of = [](const char* material, const char* what) {
    return Case{"T12",
                fmt::format("{} sphere under a uniform dome", what),
                "energy conservation",
                "dome.json",
                {{"/shapes/0/material", material}},
                "Y",
                pinhole_exposure(12),
                256};
  };
  std::vector<Case> cases{sphere_of("glass", "glass"), sphere_of("diamond", "diamond"),
                          sphere_of("mirror", "mirror"), sphere_of("white", "white Lambertian")};
  Case lamp = sphere_of("diamond", "diamond");
  lamp.title += " of a fluorescent lamp, blue channel";
  lamp.settings.push_back({"/lights/0/emission/illuminant", "FL11"});
  lamp.channel = "Z";
  // FL11's Z per unit luminance, by the tables themselves.
  Diagnostics diagnostics;
  const std::optional<NamedCurve> fl11 = load_illuminant("FL11", {}, diagnostics);
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  lamp.expected *= product(fl11->curve, cmf.z).integral() / product(fl11->curve, cmf.y).integral();
  cases.push_back(lamp);
  return cases;
}

std::vector<Case> slab_cases() {
  const double unit = pinhole_exposure(0.2);
  const Override oblique{"/camera/from", "[-34.64101615137755, 0, -20]"};
  const Override absorbing{"/materials/glass/dielectric/absorption_per_m", "1"};
  return {
      {"T13",
       "plate along its normal",
       "all internal bounces",
       "slab.json",
       {},
       "Y",
       unit * plate(0, 1.5, 1).transmittance,
       64},
      {"T13",
       "plate at 60 degrees, polarisation not carried",
       "unpolarised reflectance chained",
       "slab.json",
       {oblique},
       "Y",
       unit * plate(60, 1.5, 1).transmittance,
       256},
      {"T15",
       "absorbing plate, transmitted",
       "Beer and all internal bounces",
       "slab.json",
       {absorbing},
       "Y",
       unit * plate(0, 1.5, std::exp(-1.0)).transmittance,
       256},
      {"T15",
       "absorbing plate, reflected",
       "Beer and all internal bounces",
       "slab.json",
       {absorbing,
        {"/lights/0/quad/corner", "[-1000, -1000, -50]"},
        {"/lights/0/quad/edge_u", "[2000, 0, 0]"},
        {"/lights/0/quad/edge_v", "[0, 2000, 0]"}},
       "Y",
       unit * plate(0, 1.5, std::exp(-1.0)).reflectance,
       1024},
  };
}

}  // namespace

std::vector<Case> radiometry_cases() {
  std::vector<Case> all;
  for (std::vector<Case> (*group)() :
       {room_cases, form_factor_cases, enclosure_cases, dome_cases, slab_cases})
    for (Case& item : group()) all.push_back(std::move(item));
  return all;
}

}  // namespace abbe
