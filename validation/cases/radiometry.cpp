// The suite radiometry: films of enclosures, form factors, refracted light and scattering media.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "spectral/colorimetry.h"
#include "validation/cases/radiative_transfer.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

constexpr double kPi = std::numbers::pi;

// Power transmittance and reflectance of a plate, with all internal reflections [Born1999, sec. 7.6].
struct Plate {
  double transmittance;
  double reflectance;
};

// Plate whose faces both reflect the fraction `r` < 1. `internal` is the transmittance of one crossing.
Plate plate_of(double r, double internal) {
  const double loop = 1 - r * r * internal * internal;
  return {(1 - r) * (1 - r) * internal / loop, r + (1 - r) * (1 - r) * r * internal * internal / loop};
}

// Plate of index `n` relative to its surroundings, in unpolarised light: the mean of s and p, which do not
// mix at parallel faces. `angle_deg` is the angle of incidence in [0, 90). `internal` is the transmittance
// of one crossing at that angle.
Plate plate(double angle_deg, double n, double internal) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(angle_deg * kPi / 180), n);
  const Plate s = plate_of(face.Rs, internal);
  const Plate p = plate_of(face.Rp, internal);
  return {(s.transmittance + p.transmittance) / 2, (s.reflectance + p.reflectance) / 2};
}

// Fraction of unpolarised light that enters clear glass, is reflected inside `bounces` times and then
// leaves. It is the mean of (1 - R)^2 R^bounces over s and p. All faces reflect as `face`: those of a plate,
// or the points of a ball that a ray hits.
double transmittance_after_bounces(const FresnelPower<double>& face, int bounces) {
  const auto fraction = [&](double r) { return (1 - r) * (1 - r) * std::pow(r, bounces); };
  return (fraction(face.Rs) + fraction(face.Rp)) / 2;
}

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
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * kPi);
}

// Configuration factor of a differential area and a perpendicular rectangle of unit height that starts at its
// plane. `x` is the width of the rectangle and `y` its distance.
double perpendicular_factor(double x, double y) {
  const double c = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / c * std::atan(1 / c)) / (2 * kPi);
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
  const double intensity = 10000 / (4 * kPi);
  cases.push_back(direct_at("T2-centre", "the centre of a wall", "[0, 0, -2]", intensity / 4));
  cases.push_back(
      direct_at("T2-corner", "a corner", "[1.999999, 1.999999, -2]", intensity / 12 / std::sqrt(3.0)));
  return cases;
}

std::vector<Case> form_factor_cases() {
  return {
      film_case("T3-corner", "square emitter, under its corner", "configuration factor [Howell2010, B-4]",
                "rectangle.json", {}, kPi * corner_factor(1, 1), 64),
      film_case("T3-centre", "square emitter, under its centre", "four corner factors [Howell2010, B-4]",
                "rectangle.json", {probe_at("[0.5, 0.5, 0]", "[0, 0, 1]")}, kPi * 4 * corner_factor(0.5, 0.5),
                64),
      film_case("T3-x", "square emitter facing along x", "configuration factor [Howell2010, B-4]",
                "rectangle.json",
                {probe_at("[0, 0, 0]", "[1, 0, 0]"),
                 {"/lights/0/quad/corner", "[1, 0, 0]"},
                 {"/lights/0/quad/edge_u", "[0, 0, 1]"},
                 {"/lights/0/quad/edge_v", "[0, 1, 0]"}},
                kPi * corner_factor(1, 1), 64),
      film_case("T4", "square emitter above the receiver's horizon", "configuration factor [Howell2010, B-3]",
                "rectangle.json", {probe_at("[0, 0, 0]", "[1, 0, 0]")}, kPi * perpendicular_factor(1, 1), 64),
      film_case("T5-axis", "disc emitter, on its axis", "configuration factor [Howell2010, B-12]",
                "disc.json", {}, kPi * disc_factor(1, 1, 0), 64),
      film_case("T5-off", "disc emitter, off its axis", "configuration factor [Howell2010, B-13]",
                "disc.json", {probe_at("[1, 0, 0]", "[0, 0, 1]"), {"/lights/0/disc/radius", "0.5"}},
                kPi * disc_factor(0.5, 1, 1), 64),
      film_case("T6-opposite", "opposite faces of a cube", "view factor [Howell2010, C-11]",
                "cube_faces.json", {}, kPi * kOppositeFaces, 64),
      film_case("T6-adjacent", "adjacent faces of a cube", "view factors add up to 1 [Howell2010, C-14]",
                "cube_faces.json",
                {{"/camera/irradiance_probe/quad",
                  R"({"corner": [0, 0, 0], "edge_u": [0, 1, 0], "edge_v": [0, 0, 1]})"}},
                kPi * (1 - kOppositeFaces) / 4, 64),
      film_case("T6-discs", "coaxial discs", "view factor [Howell2010, C-41]", "coaxial_discs.json", {},
                kPi * kCoaxialDiscs, 64),
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
  const double chained = fresnel_dielectric(std::cos(kPi / 3), 1.5).R();
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
                kPi * 0.09177796, 2048),
      film_case("T16-inside", "glass in diffuse light, viewed from inside",
                "Fresnel's formulas over a hemisphere [Born1999, sec. 1.5.2]", "interface.json",
                {{"/materials/glass/dielectric/ior", fmt::format("{}", 1 / 1.5)}}, kPi * 0.59634576, 64),
  };
}

// A prism of 60 degrees at minimum deviation, with the glass's index at the d line. Light crosses both faces
// at the same angle. Internally reflected light leaves outside the field of view.
Case minimum_deviation_case(const char* glass) {
  const double n = shipped_index(glass).catalogued_n(kLineD_nm);
  const double entering = std::asin(n / 2);
  const double elevation = entering - kPi / 6;
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
  const double phase = phase_deg * kPi / 180;
  const double intensity = 2.0 / 3 / kPi * (std::sin(phase) + (kPi - phase) * std::cos(phase));
  const double width = 2 * kDistance * std::tan(kFovDeg / 2 * kPi / 180);
  return film_case(
      fmt::format("T17-{}", phase_deg), fmt::format("Lambertian sphere at a phase angle of {}°", phase_deg),
      "sin α + (π - α) cos α [Lambert1760]", "phase.json",
      {{"/camera/pinhole/fov_deg", fmt::format("{}", kFovDeg)},
       {"/lights/0/point/at",
        fmt::format("[{}, 0, {}]", kDistance * std::sin(phase), kDistance * std::cos(phase))},
       {"/lights/0/emission/luminous_flux_lm", fmt::format("{}", 4 * kPi * kDistance * kDistance)}},
      kPi / 4 * intensity / (width * width), 64);
}

std::vector<Case> prism_cases() {
  return {minimum_deviation_case("N-BK7"), minimum_deviation_case("N-SF11")};
}
std::vector<Case> phase_cases() {
  return {phase_case(0), phase_case(60), phase_case(90)};
}

std::vector<Case> integrating_sphere_cases() {
  const double offset = 0.3;
  const double distance2 = 1 + offset * offset;
  const double uniform = 100 / (4 * kPi);  // a light of 100 lm at the centre of a sphere of 1 m
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
                     kPi * (1 - std::pow(0.8, vertices)), 16);
  };
  return {film_case("T11", "furnace: emission 0.2, reflectance 0.8", source, "furnace.json", {}, kPi, 64),
          truncated(4), truncated(16)};
}

constexpr double kGlass = 1.5;  // index of refraction in all of these scenes
constexpr int kMidpoints = 100000;
constexpr int kMaxChords = 24;  // about 1e-4 of grazing light remains after eight chords

// A ray that hits a sphere of radius 1 at this incidence and leaves after `chords` chords through it
// [VanDeHulst1957, sec. 12.21]. It stays in the plane of incidence. With 0 chords it is reflected at the
// outside.
// `turn` is the angle at the sphere's centre between the points of entry and exit. `power` is the fraction of
// unpolarised power, averaged over s and p.
struct LeavingRay {
  double turn;
  double power;
};
LeavingRay leaving_ray(double incidence, int chords) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(incidence), kGlass);
  const double inside = std::asin(std::sin(incidence) / kGlass);
  return {chords * (kPi - 2 * inside),
          chords == 0 ? face.R() : transmittance_after_bounces(face, chords - 1)};
}

// Distance from the axis at which a ray crosses the plane z = `height`; infinite if it never does. The ray
// leaves the sphere at `position` in `direction`; both angles are measured from the +z axis.
double distance_in_plane(double position, double direction, double height) {
  const double distance = (height - std::cos(position)) / std::cos(direction);
  return distance > 0 ? std::abs(std::sin(position) + distance * std::sin(direction)) : INFINITY;
}

// Irradiance over a disc of `radius` on the axis, at distance `below` under the centre of a ball of radius 1.
// Parallel light of irradiance 1 arrives from above. A ring of incidence i has the fraction sin 2i di of the
// ball's cross-section. All rays of 0 (reflected at the outside) to `max_chords` chords are summed.
double irradiance_behind_ball(double below, double radius, int max_chords) {
  const auto integrand = [&](double incidence) {
    double sum = 0;
    for (int chords = 0; chords <= max_chords; ++chords) {
      const LeavingRay ray = leaving_ray(incidence, chords);
      const double position = incidence + ray.turn;
      if (distance_in_plane(position, position + incidence, -below) <= radius) sum += ray.power;
    }
    return sum * std::sin(2 * incidence);
  };
  return midpoint_integral(integrand, 0, kPi / 2, kMidpoints) / (radius * radius);
}

// Irradiance at a point on the axis, at distance `below` under the centre of a ball of radius 1. A disc of
// radiance 1 and `radius` lies at height `above` the centre. Rays are traced backwards from the point. The
// scene must ensure that the disc is not visible past the ball.
double irradiance_below_ball(double below, double above, double radius) {
  const auto integrand = [&](double theta) {
    const double incidence = std::asin(below * std::sin(theta));
    double sum = 0;
    for (int chords = 1; chords <= kMaxChords; ++chords) {
      const LeavingRay ray = leaving_ray(incidence, chords);
      const double position = theta + kPi - incidence - ray.turn;
      if (distance_in_plane(position, position - incidence, above) <= radius) sum += ray.power;
    }
    return sum * std::sin(2 * theta);
  };
  return kPi * midpoint_integral(integrand, 0, std::asin(1 / below), kMidpoints);
}

// Irradiance at a point from a parallel disc of radiance 1 and `radius`, through `air` of air and a pane of
// the given `thickness`. A ray with k internal reflections is displaced by air tan theta + (k + 1) thickness
// tan theta'.
double irradiance_behind_pane(double air, double thickness, double radius) {
  const auto integrand = [&](double theta) {
    const FresnelPower<double> face = fresnel_dielectric(std::cos(theta), kGlass);
    const double crossing = thickness * std::sin(theta) / kGlass / face.cos_t;
    double sum = 0;
    for (int bounces = 0; bounces < 40; bounces += 2)
      if (air * std::tan(theta) + (bounces + 1) * crossing <= radius)
        sum += transmittance_after_bounces(face, bounces);
    return sum * std::sin(2 * theta);
  };
  return kPi * midpoint_integral(integrand, 0, std::atan(radius / air), kMidpoints);
}

// A ball of glass under the sun or under a disc; variants of `ball_lens.json`.
std::vector<Case> ball_cases() {
  constexpr double kBelow = 1.5;  // of the disc, which lies in the ball's shadow
  constexpr double kRadius = 0.3;
  constexpr double kElevation_deg = 20;  // of the camera above the disc, so that it looks past the ball
  constexpr double kDistance = 100;
  constexpr double kFov_deg = 0.4;
  const std::string source = "rays through a sphere [VanDeHulst1957, sec. 12.21]";
  const double elevation = kElevation_deg * kPi / 180;
  const double width = 2 * kDistance * std::tan(kFov_deg / 2 * kPi / 180);
  // Fraction of the film that the disc covers.
  const double film_fraction = kPi * kRadius * kRadius * std::sin(elevation) / (width * width);
  const auto with_absent_paths = [](Case item, std::vector<std::string> classes) {
    std::get<FilmMean>(item.method).absent = std::move(classes);
    return item;
  };
  const std::string disc =
      fmt::format(R"({{"center": [0, 0, {}], "normal": [0, 0, 1], "radius": {}}})", -kBelow, kRadius);
  return {with_absent_paths(
              film_case(
                  "ball-disc", "sun through a ball of glass onto a white disc, at most two events before it",
                  source, "ball_lens.json",
                  {{"/camera/from", fmt::format("[{}, 0, {}]", kDistance * std::cos(elevation),
                                                kDistance * std::sin(elevation) - kBelow)}},
                  [=] { return kPi / 4 * film_fraction * irradiance_behind_ball(kBelow, kRadius, 1) / kPi; },
                  128),
              {"E L", "E S (S|D)* L", "E S (S|D)* D (S|D)* S L"}),
          film_case(
              "ball-meter", "sun through a ball of glass onto a probe", source, "ball_lens.json",
              {{"/camera", fmt::format(R"({{"irradiance_probe": {{"disc": {}}}}})", disc)},
               {"/shapes", R"([{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "glass"}])"},
               {"/sensor/resolution", "[64, 64]"},
               {"/render/max_depth", "100"}},
              [] { return irradiance_behind_ball(kBelow, kRadius, kMaxChords); }, 128),
          film_case(
              "ball-axis", "disc of light through a ball of glass to a point", source, "ball_lens.json",
              {probe_at(fmt::format("[0, 0, {}]", -kBelow), "[0, 0, 1]"),
               {"/lights/0", R"({"disc": {"center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.5},
                    "emission": {"illuminant": "E", "luminance": 1}})"},
               {"/shapes", R"([{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "glass"}])"},
               {"/render/max_depth", "100"}},
              [] { return irradiance_below_ball(kBelow, 3, 0.5); }, 256)};
}

// A light disc of radius 0.5 m, 1 m above a point, and a pane between them; variants of `pane.json`.
std::vector<Case> pane_cases() {
  return {film_case(
              "pane-thick", "disc of light behind a pane of 0.4 m",
              "rays through a plate, s and p separate [Born1999, sec. 7.6]", "pane.json", {},
              [] { return irradiance_behind_pane(0.6, 0.4, 0.5); }, 512),
          film_case(
              "pane-thin", "disc of light behind thin glass", "all internal bounces [Born1999, sec. 7.6]",
              "pane.json", {{"/shapes", R"([{"quad": {"corner": [-1000, -1000, 0.5], "edge_u": [2000, 0, 0],
                       "edge_v": [0, 2000, 0]}, "material": "thin"}])"}},
              [] { return irradiance_behind_pane(1, 0, 0.5); }, 1024)};
}

// A probe in a ball of glass below a dome. It is so near the centre that total internal reflection traps no
// ray to it.
std::vector<Case> inside_cases() {
  return {film_case(
      "ball-inside", "probe inside a ball of glass under a uniform dome",
      "radiance grows with the square of the index, and nothing is lost [Pharr2023, sec. 9.5.2]", "dome.json",
      {{"/camera", R"({"irradiance_probe": {"disc": {"center": [0, 0, 0], "normal": [0, 0, 1],
                                                                "radius": 0.5}}})"}},
      kPi * kGlass * kGlass, 256)};
}

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
    return (1 - kG * kG) / (4 * kPi * std::pow(1 + kG * kG - 2 * kG * cosine, 1.5));
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

Override probe_at(const std::string& point, const std::string& normal) {
  return {"/camera", fmt::format(R"({{"irradiance_probe": {{"at": {}, "normal": {}}}}})", point, normal)};
}

std::vector<Case> radiometry_cases() {
  std::vector<Case> all;
  for (std::vector<Case> (*group)() :
       {room_cases, form_factor_cases, dome_cases, slab_cases, prism_cases, phase_cases,
        integrating_sphere_cases, concentric_cases, plate_cases, furnace_cases, ball_cases, inside_cases,
        pane_cases, layer_cases, single_cases})
    for (Case& item : group()) all.push_back(std::move(item));
  return all;
}

}  // namespace abbe
