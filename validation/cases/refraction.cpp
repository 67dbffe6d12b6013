// Light that comes through a ball or a pane of glass to where it is measured.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "validation/cases/film_case.h"
#include "validation/cases/plate.h"
#include "validation/cases/quadrature.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGlass = 1.5;  // the index in all of these scenes
constexpr int kMidpoints = 100000;
constexpr int kMostChords = 24;  // of grazing rays some 1e-4 still comes after eight ways through

// The part of a ray that leaves a sphere of radius 1 after `chords` ways through it, 0 being what is
// reflected from without, where the ray met the sphere under that incidence: by which angle along the
// section, in which it stays, it leaves further on than it came in, and its share of the power, s and p kept
// apart [VanDeHulst1957, sec. 12.21].
struct LeavingRay {
  double turned;
  double power;
};
LeavingRay leaving_ray(double incidence, int chords) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(incidence), kGlass);
  const double inside = std::asin(std::sin(incidence) / kGlass);
  return {chords * (kPi - 2 * inside), chords == 0 ? face.R() : through_after(face, chords - 1)};
}

// Where the ray that leaves the sphere at `position` in `direction`, both angles from the axis +z, crosses
// the plane z = `height`: its distance from the axis, infinite where it never does.
double distance_in_plane(double position, double direction, double height) {
  const double way = (height - std::cos(position)) / std::cos(direction);
  return way > 0 ? std::abs(std::sin(position) + way * std::sin(direction)) : INFINITY;
}

// Irradiance over a disc of `radius` on the axis, `below` the centre of a ball of radius 1 in parallel light
// of irradiance 1 from above: each ring of incidence brings sin 2i di of the ball's section, and all up to
// `chords` ways through the ball are added up.
double behind_ball(double below, double radius, int chords) {
  const auto brought = [&](double incidence) {
    double sum = 0;
    for (int way = 0; way <= chords; ++way) {
      const LeavingRay ray = leaving_ray(incidence, way);
      const double position = incidence + ray.turned;
      if (distance_in_plane(position, position + incidence, -below) <= radius) sum += ray.power;
    }
    return sum * std::sin(2 * incidence);
  };
  return midpoint_integral(brought, 0, kPi / 2, kMidpoints) / (radius * radius);
}

// Irradiance of a point on the axis, `below` the centre of a ball of radius 1, by a disc of radiance 1 and
// `radius` that lies `above` it, looked for against the way of the light; that it is not seen past the ball
// is the scene's.
double below_ball(double below, double above, double radius) {
  const auto seen = [&](double theta) {
    const double incidence = std::asin(below * std::sin(theta));
    double sum = 0;
    for (int chords = 1; chords <= kMostChords; ++chords) {
      const LeavingRay ray = leaving_ray(incidence, chords);
      const double position = theta + kPi - incidence - ray.turned;
      if (distance_in_plane(position, position - incidence, above) <= radius) sum += ray.power;
    }
    return sum * std::sin(2 * theta);
  };
  return kPi * midpoint_integral(seen, 0, std::asin(1 / below), kMidpoints);
}

// Irradiance of a point by a disc of radiance 1 and `radius` parallel to it, `air` of the way to which is air
// and `thickness` a pane: after k reflections within a ray is (air tan + (2k + 1) thickness tan inside) off.
double behind_pane(double air, double thickness, double radius) {
  const auto seen = [&](double theta) {
    const FresnelPower<double> face = fresnel_dielectric(std::cos(theta), kGlass);
    const double crossing = thickness * std::sin(theta) / kGlass / face.cos_t;
    double sum = 0;
    for (int bounces = 0; bounces < 40; bounces += 2)
      if (air * std::tan(theta) + (bounces + 1) * crossing <= radius) sum += through_after(face, bounces);
    return sum * std::sin(2 * theta);
  };
  return kPi * midpoint_integral(seen, 0, std::atan(radius / air), kMidpoints);
}

// The sun, or a lamp, and a ball of glass; all of `ball_lens.json`.
std::vector<Case> ball_cases() {
  constexpr double kBelow = 1.5;  // of the disc, which is in the ball's shadow
  constexpr double kRadius = 0.3;
  constexpr double kElevation_deg = 20;  // of the camera over the disc, so that it looks past the ball
  constexpr double kDistance = 100;
  constexpr double kFov_deg = 0.4;
  const std::string source = "rays through a sphere [VanDeHulst1957, sec. 12.21]";
  const double elevation = kElevation_deg * kPi / 180;
  const double width = 2 * kDistance * std::tan(kFov_deg / 2 * kPi / 180);
  const double share = kPi * kRadius * kRadius * std::sin(elevation) / (width * width);  // of the film
  const auto out_of_sight = [](Case item, std::vector<std::string> classes) {
    std::get<FilmMean>(item.method).absent = std::move(classes);
    return item;
  };
  const std::string disc =
      fmt::format(R"({{"center": [0, 0, {}], "normal": [0, 0, 1], "radius": {}}})", -kBelow, kRadius);
  return {out_of_sight(film_case(
                           "ball-disc",
                           "sun through a ball of glass onto a white disc, no more than two events before it",
                           source, "ball_lens.json",
                           {{"/camera/from", fmt::format("[{}, 0, {}]", kDistance * std::cos(elevation),
                                                         kDistance * std::sin(elevation) - kBelow)}},
                           [=] { return kPi / 4 * share * behind_ball(kBelow, kRadius, 1) / kPi; }, 128),
                       {"E L", "E S (S|D)* L", "E S (S|D)* D (S|D)* S L"}),
          film_case(
              "ball-meter", "sun through a ball of glass onto a meter", source, "ball_lens.json",
              {{"/camera", fmt::format(R"({{"irradiance_probe": {{"disc": {}}}}})", disc)},
               {"/shapes", R"([{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "glass"}])"},
               {"/sensor/resolution", "[64, 64]"},
               {"/render/max_depth", "100"}},
              [] { return behind_ball(kBelow, kRadius, kMostChords); }, 128),
          film_case(
              "ball-axis", "disc of light through a ball of glass to a point", source, "ball_lens.json",
              {probe_at(fmt::format("[0, 0, {}]", -kBelow), "[0, 0, 1]"),
               {"/lights/0", R"({"disc": {"center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.5},
                    "emission": {"illuminant": "E", "luminance": 1}})"},
               {"/shapes", R"([{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "glass"}])"},
               {"/render/max_depth", "100"}},
              [] { return below_ball(kBelow, 3, 0.5); }, 256)};
}

// A disc of light of 0.5 m, 1 m above a point, and a pane between them; all of `pane.json`.
std::vector<Case> pane_cases() {
  return {film_case(
              "pane-thick", "disc of light behind a pane of 0.4 m",
              "rays through a plate, s and p kept apart [Born1999, sec. 7.6]", "pane.json", {},
              [] { return behind_pane(0.6, 0.4, 0.5); }, 512),
          film_case(
              "pane-thin", "disc of light behind thin glass", "all internal bounces [Born1999, sec. 7.6]",
              "pane.json", {{"/shapes", R"([{"quad": {"corner": [-1000, -1000, 0.5], "edge_u": [2000, 0, 0],
                       "edge_v": [0, 2000, 0]}, "material": "thin"}])"}},
              [] { return behind_pane(1, 0, 0.5); }, 1024)};
}

// A meter in a ball of glass below a dome, near enough to its centre that no ray to it is trapped.
Case inside_case() {
  return film_case("ball-inside", "meter inside a ball of glass under a uniform dome",
                   "radiance grows with the square of the index, and nothing is lost [Pharr2023, sec. 9.5.2]",
                   "dome.json",
                   {{"/camera", R"({"irradiance_probe": {"disc": {"center": [0, 0, 0], "normal": [0, 0, 1],
                                                                "radius": 0.5}}})"}},
                   kPi * kGlass * kGlass, 256);
}

}  // namespace

std::vector<Case> refraction_cases() {
  std::vector<Case> all = ball_cases();
  all.push_back(inside_case());
  for (Case& item : pane_cases()) all.push_back(std::move(item));
  return all;
}

}  // namespace abbe
