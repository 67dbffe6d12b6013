#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "spectral/colorimetry.h"
#include "validation/cases/figures.h"
#include "validation/cases/film_case.h"
#include "validation/cases/plate.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

// Mean irradiance [lx] on a wall of a cubic room with edges of `side` m, direct and interreflected.
// flux/area is the direct irradiance; 1/(1 - reflectance) sums the reflections.
double room_irradiance(double flux_lm, double side, double reflectance) {
  return flux_lm / (6 * side * side) / (1 - reflectance);
}

// Configuration factor of a differential area facing a parallel x by y rectangle at unit distance, under its
// corner.
double corner_factor(double x, double y) {
  const double a = std::sqrt(1 + x * x);
  const double b = std::sqrt(1 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * std::numbers::pi);
}

// Configuration factor of a differential area and a perpendicular rectangle of unit height that starts at its
// plane. `x` is the width of the rectangle and `y` its distance.
double perpendicular_factor(double x, double y) {
  const double c = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / c * std::atan(1 / c)) / (2 * std::numbers::pi);
}

// Configuration factor of a differential area and a parallel disc of radius r at distance h. The foot of the
// area is at distance a from the axis.
double disc_factor(double r, double h, double a) {
  const double z = h * h + a * a + r * r;
  return 0.5 * (1 - (h * h + a * a - r * r) / std::sqrt(z * z - 4 * a * a * r * r));
}

// View factor of opposite faces of a cube.
constexpr double kOppositeFaces = 0.19982490;
// View factor of coaxial discs of radius 1 at distance 1: (3 - sqrt(5)) / 2.
constexpr double kCoaxialDiscs = 0.3819660113;

// Transmittance of N plates in series with all reflections between them: (1 - R)/(1 + (2N - 1) R).
double pile_transmittance(int plates, double n) {
  const double r = fresnel_dielectric(1.0, n).R();
  return (1 - r) / (1 + (2 * plates - 1) * r);
}

// Plates of glass 1 m thick and 1 m from each other, as shapes of `slab.json`.
Override plates(int count) {
  std::string shapes;
  for (int face = 0; face < 2 * count; ++face)
    shapes += fmt::format(
        R"({}{{"quad": {{"corner": [-1000, -1000, {}], "edge_u": {}, "edge_v": {}}}, "material": "glass"}})",
        face == 0 ? "" : ", ", face, face % 2 == 0 ? "[0, 2000, 0]" : "[2000, 0, 0]",
        face % 2 == 0 ? "[2000, 0, 0]" : "[0, 2000, 0]");
  return {"/shapes", "[" + shapes + "]"};
}

std::vector<Case> room_cases() {
  std::vector<Case> cases;
  for (const double reflectance : {0.0, 0.2, 0.5, 0.8, 0.95})
    cases.push_back(
        film_case(fmt::format("T1-{}", reflectance),
                  fmt::format("cubic room, reflectance {}: mean irradiance of a wall", reflectance),
                  "balance of a closed enclosure [CIE171, 5.8]", "room.json",
                  {{"/materials/wall/diffuse/reflectance", fmt::format("{}", reflectance)}},
                  room_irradiance(10000, 4, reflectance), reflectance > 0.9 ? 256 : 64));
  const auto direct_at = [](const char* id, const char* where, const char* at, double expected) {
    return film_case(id, fmt::format("cubic room, direct light at {}", where),
                     "inverse square and cosine laws [Lambert1760]", "room.json",
                     {{"/materials/wall/diffuse/reflectance", "0"}, probe_at(at, "[0, 0, 1]")}, expected, 4);
  };
  const double intensity = 10000 / (4 * std::numbers::pi);
  cases.push_back(direct_at("T2-centre", "the centre of a wall", "[0, 0, -2]", intensity / 4));
  cases.push_back(
      direct_at("T2-corner", "a corner", "[1.999999, 1.999999, -2]", intensity / 12 / std::sqrt(3.0)));
  return cases;
}

std::vector<Case> form_factor_cases() {
  return {
      film_case("T3-corner", "square emitter, under its corner", "configuration factor [Howell2010, B-4]",
                "rectangle.json", {}, std::numbers::pi * corner_factor(1, 1), 64),
      film_case("T3-centre", "square emitter, under its centre", "four corner factors [Howell2010, B-4]",
                "rectangle.json", {probe_at("[0.5, 0.5, 0]", "[0, 0, 1]")},
                std::numbers::pi * 4 * corner_factor(0.5, 0.5), 64),
      film_case("T3-x", "square emitter facing along x", "configuration factor [Howell2010, B-4]",
                "rectangle.json",
                {probe_at("[0, 0, 0]", "[1, 0, 0]"),
                 {"/lights/0/quad/corner", "[1, 0, 0]"},
                 {"/lights/0/quad/edge_u", "[0, 0, 1]"},
                 {"/lights/0/quad/edge_v", "[0, 1, 0]"}},
                std::numbers::pi * corner_factor(1, 1), 64),
      film_case("T4", "square emitter above the receiver's horizon", "configuration factor [Howell2010, B-3]",
                "rectangle.json", {probe_at("[0, 0, 0]", "[1, 0, 0]")},
                std::numbers::pi * perpendicular_factor(1, 1), 64),
      film_case("T5-axis", "disc emitter, on its axis", "configuration factor [Howell2010, B-12]",
                "disc.json", {}, std::numbers::pi * disc_factor(1, 1, 0), 64),
      film_case("T5-off", "disc emitter, off its axis", "configuration factor [Howell2010, B-13]",
                "disc.json", {probe_at("[1, 0, 0]", "[0, 0, 1]"), {"/lights/0/disc/radius", "0.5"}},
                std::numbers::pi * disc_factor(0.5, 1, 1), 64),
      film_case("T6-opposite", "opposite faces of a cube", "view factor [Howell2010, C-11]",
                "cube_faces.json", {}, std::numbers::pi * kOppositeFaces, 64),
      film_case("T6-adjacent", "adjacent faces of a cube", "view factors add up to 1 [Howell2010, C-14]",
                "cube_faces.json",
                {{"/camera/irradiance_probe/quad",
                  R"({"corner": [0, 0, 0], "edge_u": [0, 1, 0], "edge_v": [0, 0, 1]})"}},
                std::numbers::pi * (1 - kOppositeFaces) / 4, 64),
      film_case("T6-discs", "coaxial discs", "view factor [Howell2010, C-41]", "coaxial_discs.json", {},
                std::numbers::pi * kCoaxialDiscs, 64),
  };
}

std::vector<Case> dome_cases() {
  const auto sphere_of = [](const std::string& material, const std::string& what) {
    return film_case("T12-" + material, what + " sphere under a uniform dome", "nothing is lost [Pharr2023]",
                     "dome.json", {{"/shapes/0/material", material}}, pinhole_exposure(12), 256);
  };
  std::vector<Case> cases{sphere_of("glass", "glass"), sphere_of("diamond", "diamond"),
                          sphere_of("mirror", "mirror"), sphere_of("white", "white Lambertian")};
  // Z of FL11 per unit luminance, from the tables.
  const Curve fl11 = shipped_illuminant("FL11");
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  const double blue = product(fl11, cmf.z).integral() / product(fl11, cmf.y).integral();
  cases.push_back(film_case("T12-FL11", "diamond sphere under a dome of illuminant FL11, blue channel",
                            "nothing is lost [Pharr2023]", "dome.json",
                            {{"/shapes/0/material", "diamond"}, {"/lights/0/emission/illuminant", "FL11"}},
                            pinhole_exposure(12) * blue, 256, "Z"));
  return cases;
}

std::vector<Case> slab_cases() {
  const double unit = pinhole_exposure(0.2);
  const Override oblique{"/camera/from", "[-34.64101615137755, 0, -20]"};
  const Override absorbing{"/materials/glass/dielectric/absorption_per_m", "1"};
  const double chained = fresnel_dielectric(std::cos(std::numbers::pi / 3), 1.5).R();
  const std::string bounces = "all internal bounces [Born1999, sec. 7.6]";
  return {
      film_case("T13-0", "plate along its normal", bounces, "slab.json", {},
                unit * plate(0, 1.5, 1).transmittance, 64),
      film_case("T13-60", "plate at 60°, s and p separate", bounces, "slab.json", {oblique},
                unit * plate(60, 1.5, 1).transmittance, 256),
      film_case("T13-60-off", "plate at 60°, polarisation off",
                "chained unpolarised reflectances, " + bounces, "slab.json",
                {oblique, {"/render/polarisation", "off"}}, unit * plate_of(chained, 1).transmittance, 256),
      film_case("T14-2", "two plates along their normal", "pile of plates [Stokes1862]", "slab.json",
                {plates(2)}, unit * pile_transmittance(2, 1.5), 64),
      film_case("T14-3", "three plates along their normal", "pile of plates [Stokes1862]", "slab.json",
                {plates(3)}, unit * pile_transmittance(3, 1.5), 64),
      film_case("T15-T", "absorbing plate, transmitted", "Beer's law and " + bounces, "slab.json",
                {absorbing}, unit * plate(0, 1.5, std::exp(-1.0)).transmittance, 256),
      film_case("T15-R", "absorbing plate, reflected", "Beer's law and " + bounces, "slab.json",
                {absorbing,
                 {"/lights/0/quad/corner", "[-1000, -1000, -50]"},
                 {"/lights/0/quad/edge_u", "[2000, 0, 0]"},
                 {"/lights/0/quad/edge_v", "[0, 2000, 0]"}},
                unit * plate(0, 1.5, std::exp(-1.0)).reflectance, 1024),
      film_case("T16-outside", "glass in diffuse light, viewed from outside",
                "Fresnel's formulas over a hemisphere [Born1999, sec. 1.5.2]", "interface.json", {},
                std::numbers::pi * 0.09177796, 2048),
      film_case("T16-inside", "glass in diffuse light, viewed from inside",
                "Fresnel's formulas over a hemisphere [Born1999, sec. 1.5.2]", "interface.json",
                {{"/materials/glass/dielectric/ior", fmt::format("{}", 1 / 1.5)}},
                std::numbers::pi * 0.59634576, 64),
  };
}

// A prism of 60 degrees at minimum deviation, with the glass's index at the d line. Light crosses both faces
// at the same angle. Internally reflected light leaves outside the field of view.
Case minimum_deviation_case(const char* glass) {
  const double n = shipped_index(glass).catalogued_n(kLineD_nm);
  const double entering = std::asin(n / 2);
  const double elevation = entering - std::numbers::pi / 6;
  const double c = std::cos(elevation);
  const double s = std::sin(elevation);
  const FresnelPower<double> face = fresnel_dielectric(std::cos(entering), n);
  const double through = (std::pow(1 - face.Rs, 2) + std::pow(1 - face.Rp, 2)) / 2;
  const auto json_point = [](double x, double y, double z) { return fmt::format("[{}, {}, {}]", x, y, z); };
  constexpr double kAway = 0.1;
  constexpr double kHalf = 0.002;  // of the light
  return film_case(fmt::format("prism-{}", glass), fmt::format("prism of {} at minimum deviation", glass),
                   "Fresnel's formulas, s and p separate [Born1999, sec. 1.5.2]", "least_deviation.json",
                   {{"/materials/glass/dielectric/ior", fmt::format(R"({{"n": {}}})", n)},
                    {"/camera/from", json_point(-0.0075 - kAway * c, 0, 0.0043301270 - kAway * s)},
                    {"/lights/0/quad/corner", json_point(0.0075 + kAway * c - kHalf * s, -kHalf,
                                                         0.0043301270 - kAway * s - kHalf * c)},
                    {"/lights/0/quad/edge_u", json_point(2 * kHalf * s, 0, 2 * kHalf * c)},
                    {"/lights/0/quad/edge_v", json_point(0, 2 * kHalf, 0)}},
                   pinhole_exposure(0.2) * through, 256);
}

// A Lambertian sphere of radius 1 m at a phase angle. The light, which gives 1 lx at the sphere, and the
// camera are both 10 km away.
Case phase_case(double phase_deg) {
  constexpr double kDistance = 1e4;
  constexpr double kFovDeg = 0.0126;
  const double phase = phase_deg * std::numbers::pi / 180;
  const double intensity =
      2.0 / 3 / std::numbers::pi * (std::sin(phase) + (std::numbers::pi - phase) * std::cos(phase));
  const double width = 2 * kDistance * std::tan(kFovDeg / 2 * std::numbers::pi / 180);
  return film_case(fmt::format("T17-{}", phase_deg),
                   fmt::format("Lambertian sphere at a phase angle of {}°", phase_deg),
                   "sin α + (π - α) cos α [Lambert1760]", "phase.json",
                   {{"/camera/pinhole/fov_deg", fmt::format("{}", kFovDeg)},
                    {"/lights/0/point/at",
                     fmt::format("[{}, 0, {}]", kDistance * std::sin(phase), kDistance * std::cos(phase))},
                    {"/lights/0/emission/luminous_flux_lm",
                     fmt::format("{}", 4 * std::numbers::pi * kDistance * kDistance)}},
                   std::numbers::pi / 4 * intensity / (width * width), 64);
}

}  // namespace

double pinhole_exposure(double fov_deg) {
  constexpr int kSteps = 400;
  const double half = std::tan(fov_deg / 2 * std::numbers::pi / 180);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = half * (2 * (i + 0.5) / kSteps - 1);
      const double y = half * (2 * (j + 0.5) / kSteps - 1);
      sum += 1 / std::pow(1 + x * x + y * y, 2);
    }
  return std::numbers::pi / 4 * sum / (kSteps * kSteps);
}

Override probe_at(const std::string& point, const std::string& normal) {
  return {"/camera", fmt::format(R"({{"irradiance_probe": {{"at": {}, "normal": {}}}}})", point, normal)};
}

std::vector<Case> radiometry_cases() {
  std::vector<Case> all;
  for (std::vector<Case> (*group)() : {room_cases, form_factor_cases, dome_cases, slab_cases})
    for (Case& item : group()) all.push_back(std::move(item));
  for (const char* glass : {"N-BK7", "N-SF11"}) all.push_back(minimum_deviation_case(glass));
  for (const double phase : {0.0, 60.0, 90.0}) all.push_back(phase_case(phase));
  return all;
}

}  // namespace abbe
