// Light that a ball or a pane of glass refracts onto a receiver.
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
Case inside_case() {
  return film_case("ball-inside", "probe inside a ball of glass under a uniform dome",
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
