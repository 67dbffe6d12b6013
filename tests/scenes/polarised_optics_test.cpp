// Optics that turn on polarisation, rendered, against closed forms: by day to about a percent, at night to
// two thousandths.
#include <array>
#include <cmath>
#include <numbers>

#include "materials/interface/mueller.h"
#include "sampling/angle.h"
#include "tests/materials/index_of.h"
#include "tests/scenes/polarised_scene.h"
#include "tests/tier.h"
#include "transport/path/ray_trace.h"

namespace abbe::test {
namespace {

using Imath::V3d;
const double kSlack = nightly() ? 0.002 : 0.01;
const int kMore = nightly() ? 32 : 1;  // as many samples for a fifth of the noise

// What a narrow camera at `from` sees, looking along `towards`, by Stokes vectors in the frame whose first
// axis is to the right of that and of y, which is up.
StokesMean seen(const V3d& from, const V3d& towards, const std::string& materials, const std::string& lights,
                const std::string& shapes, const std::string& render_keys) {
  const std::string text = fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 0.02, "f_number": 1}}, "from": {}, "to": {}, "up": [0, 1, 0]}},
          "sensor": {{"observer": "1931", "resolution": [4, 4], "stokes": true}},
          "materials": {{{}}}, "lights": [{}], "shapes": [{}], "render": {{"integrator": "path", {}}}}})",
      text_of(from), text_of(from + towards), materials, lights, shapes, render_keys);
  return stokes_of(render(load_text(text), {}).film);
}

std::string lamp(const V3d& center, const V3d& normal, double half, const std::string& more = "") {
  return fmt::format(R"({{"quad": {}, "emission": {{"illuminant": "E", "luminance": 1{}}}}})",
                     square(center, normal, half), more);
}

// Of a luminance of 1 before the camera.
double unit() {
  static const double kUnit =
      seen({0, 0, 0}, {0, 0, 1}, "", lamp({0, 0, 1}, {0, 0, -1}, 1), "", R"("samples": 64)").i;
  return kUnit;
}

// By a number of faces one behind the other, with all that is mirrored back and forth. [Stokes1862]
double through_faces(int faces, double R) {
  return (1 - R) / (1 + (faces - 1) * R);
}

// Plates of index 1.5 at Brewster's angle and beyond. The picture's right lies in the plane of
// incidence.
TEST(PolarisedOptics, PilesOfPlatesPolarise) {
  constexpr double kBrewster = 56.30993247402022;
  for (const auto& [angle_deg, plates] : {std::pair(kBrewster, 1),
                                          {kBrewster, 2},
                                          {kBrewster, 4},
                                          {kBrewster, 7},
                                          {kBrewster, 10},
                                          {75.0, 2}}) {
    if (plates > 4 && !nightly()) continue;  // light goes back and forth between them for long
    std::string shapes;
    for (int k = 0; k < plates; ++k)
      shapes += fmt::format(R"({}{{"quad": {}, "material": "glass"}}, {{"quad": {}, "material": "glass"}})",
                            k == 0 ? "" : ", ", square({0, 0, 2.0 * k}, {0, 0, -1}, 1000),
                            square({0, 0, 2.0 * k + 1}, {0, 0, 1}, 1000));
    const double angle = angle_deg * kDegree;
    const V3d towards(std::sin(angle), 0, std::cos(angle));
    const StokesMean light =
        seen(towards * -20.0, towards, R"("glass": {"dielectric": {"ior": {"n": 1.5}}})",
             lamp({0, 0, 50}, {0, 0, -1}, 1000), shapes,
             fmt::format(R"("max_depth": 2000, "roulette_depth": 2000, "samples": {})", 8192 * kMore));
    const FresnelPower<double> face = fresnel_dielectric(std::cos(angle), 1.5);
    const double s = through_faces(2 * plates, face.Rs);
    const double p = through_faces(2 * plates, face.Rp);
    const std::string of = fmt::format("{} plates at {} degrees", plates, angle_deg);
    EXPECT_NEAR(light.i / unit() / ((s + p) / 2), 1, kSlack) << of;
    EXPECT_NEAR(light.q / light.i, (p - s) / (p + s), kSlack * (p - s) / (p + s)) << of;
    EXPECT_NEAR(light.u / light.i, 0, kSlack) << of;
    EXPECT_NEAR(light.v / light.i, 0, kSlack) << of;
  }
}

// A prism of 60 degrees at least deviation, its faces seen once each: (Ts^2 + Tp^2)/2 of the light comes
// through, of which (Tp^2 - Ts^2)/2 are polarised in the plane of the deviation.
TEST(PolarisedOptics, PrismsAtLeastDeviation) {
  constexpr double kNm = 587.5618;
  for (const char* glass : {"N-BK7", "N-SF11"}) {
    const double n = index_of(glass).n(kNm);
    const double entering = std::asin(n / 2);
    const double rises = entering - 30 * kDegree;
    const double height = 4.330127;  // of the middles of its faces
    const V3d in(std::cos(rises), 0, std::sin(rises));
    const V3d out(std::cos(rises), 0, -std::sin(rises));
    const V3d lamp_at = V3d(7.5, 0, height) + out * 100.0;
    const StokesMean light =
        seen(V3d(-7.5, 0, height) - in * 50.0, in,
             fmt::format(R"("glass": {{"dielectric": {{"ior": {{"n": {}}}}}}})", n), lamp(lamp_at, -out, 2),
             R"({"prism": {"apex_deg": 60, "side": 30, "length": 40}, "material": "glass"})",
             fmt::format(R"("max_depth": 2, "samples": {})", 256 * kMore));
    const FresnelPower<double> face = fresnel_dielectric(std::cos(entering), n);
    const double s = (1 - face.Rs) * (1 - face.Rs);
    const double p = (1 - face.Rp) * (1 - face.Rp);
    if (std::string(glass) == "N-BK7") {
      EXPECT_NEAR((s + p) / 2, 0.888681, 1e-6);
    }
    EXPECT_NEAR(light.i / unit() / ((s + p) / 2), 1, kSlack) << glass;
    EXPECT_NEAR(light.q / light.i, (p - s) / (p + s), kSlack) << glass;
  }
}

// Glass cut so that light along z is reflected twice within at 54 degrees 37 minutes, a quarter of a wave
// apart [Born1999, sec. 1.5.4], after which what was polarised at 45 degrees is circular, of the hand that
// two such reflections in double precision have.
TEST(PolarisedOptics, FresnelsRhombMakesLinearLightCircular) {
  const double angle = (54 + 37 / 60.0) * kDegree;
  const double length =
      2 * std::pow(std::sin(angle), 2) / std::cos(angle);  // so that it comes out in the middle
  const double x = length * std::cos(angle);
  const double z = length * std::sin(angle);
  const std::string rhomb = fmt::format(
      R"({{"mesh": {{"vertices": [[0, -1, 0], [1, -1, 0], [{0}, -1, {2}], [{1}, -1, {2}], [0, 1, 0], [1, 1, 0], [{0}, 1, {2}], [{1}, 1, {2}]],
          "triangles": [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]}}, "material": "glass"}})",
      x, x + 1, z);
  const auto turned = [&](const char* slanted) {
    return seen(
        {0.5, 0, -10}, {0, 0, 1}, R"("glass": {"dielectric": {"ior": {"n": 1.51}}})",
        lamp({x + 0.5, 0, z + 1}, {0, 0, -1}, 0.4, fmt::format(R"(, "polarised": {{"axis": {}}})", slanted)),
        rhomb, fmt::format(R"("max_depth": 4, "samples": {})", 64 * kMore));
  };
  const double face = 1 - fresnel_dielectric(1.0, 1.51).R();
  const FullMueller within = FullMueller::of(reflection_mueller(std::cos(angle), 1 / 1.51, 0.0), 1);
  const double hand =
      (within * (within * StokesVector{1, 0, 1, 0}))[3];  // light along -z from the axis y to x
  ASSERT_NEAR(std::abs(hand), 1, 1e-6);
  const StokesMean light = turned("[1, 1, 0]");
  EXPECT_NEAR(light.i / unit(), face * face, kSlack);
  EXPECT_NEAR(light.v / light.i, hand, 0.005);
  EXPECT_NEAR(std::hypot(light.q, light.u) / light.i, 0, 0.005);
  const StokesMean other = turned("[1, -1, 0]");
  EXPECT_NEAR(other.v / light.v, -1, 0.005);
  const StokesMean straight = turned("[1, 0, 0]");
  EXPECT_NEAR(straight.q / straight.i, 1, 0.005) << "along the plane of incidence nothing happens to it";
}

constexpr const char* kDeepAir = R"("air": {"medium": {"scattering_per_m": 1, "phase": "rayleigh"}})";

// Of air between z = 0 and that height.
std::string layer(double height) {
  return fmt::format(R"({{"quad": {}, "material": "air"}}, {{"quad": {}, "material": "air"}})",
                     square({0, 0, 0}, {0, 0, -1}, 1e4), square({0, 0, height}, {0, 0, 1}, 1e4));
}

// A clear sky's first order: sunlight that a flat layer of air turns once, seen from below and from above.
// [Chandrasekhar1960, sec. 16 and 17]
TEST(PolarisedOptics, ALayerOfAirInSunlight) {
  constexpr double kDepth = 0.7;
  const double mu0 = 0.6;
  const V3d sun(std::sqrt(1 - mu0 * mu0), 0, -mu0);
  for (const double azimuth_deg : {0.0, 50.0, 130.0})
    for (const double mu : {0.85, 0.3, -0.3, -0.9}) {  // of the light's way, up where it is positive
      const double across = std::sqrt(1 - mu * mu);
      const V3d way(across * std::cos(azimuth_deg * kDegree), across * std::sin(azimuth_deg * kDegree), mu);
      const double away = std::abs(mu);
      const double shared = mu > 0
                                ? mu0 / (mu0 + away) * (1 - std::exp(-kDepth * (1 / away + 1 / mu0)))
                                : mu0 / (away - mu0) * (std::exp(-kDepth / away) - std::exp(-kDepth / mu0));
      const double cosine = way.dot(sun);
      const double phase = 0.75 * (1 + cosine * cosine);
      const double degree = (1 - cosine * cosine) / (1 + cosine * cosine);
      // It is polarised across the plane of both ways; the picture's right and up are across the light's.
      const V3d axis = sun.cross(way).normalized();
      const V3d right = V3d(0, 1, 0).cross(way).normalized();
      const double along = axis.dot(right);
      const double up = axis.dot(way.cross(right));
      const V3d from = (mu > 0 ? V3d(0, 0, kDepth) : V3d(0, 0, 0)) + way * 10.0;
      const StokesMean light = seen(
          from, way * -1.0, kDeepAir,
          fmt::format(
              R"({{"directional": {{"towards": {}}}, "emission": {{"illuminant": "E", "illuminance": 1}}}})",
              text_of(sun * -1.0)),
          layer(kDepth), fmt::format(R"("max_depth": 1, "samples": {})", 1024 * kMore));
      const std::string of = fmt::format("azimuth {}, mu {}", azimuth_deg, mu);
      EXPECT_NEAR(light.i / unit() / (shared * phase / (4 * std::numbers::pi)), 1, kSlack) << of;
      EXPECT_NEAR(light.q / light.i, degree * (along * along - up * up), kSlack) << of;
      EXPECT_NEAR(light.u / light.i, degree * 2 * along * up, kSlack) << of;
      EXPECT_NEAR(light.v / light.i, 0, kSlack) << of;
    }
}

// Light from deep within air that only scatters is polarised along the horizon where it comes out, most of
// all near to it: what has scattered any number of times. [Chandrasekhar1960, table XXIV]
TEST(NightlyPolarisedOptics, LightFromDeepAirIsPolarisedAlongTheHorizon) {
  constexpr double kDepth = 4;
  for (const auto& [mu, degree] : {std::pair(0.1, 0.07448), {0.3, 0.04041}}) {
    const V3d way(std::sqrt(1 - mu * mu), 0, mu);
    const StokesMean light =
        seen(V3d(0, 0, kDepth) + way * 10.0, way * -1.0, kDeepAir, lamp({0, 0, -0.01}, {0, 0, 1}, 1e4),
             layer(kDepth), R"("max_depth": 2000, "roulette_depth": 2000, "samples": 262144)");
    EXPECT_NEAR(-light.q / light.i, degree, 0.005) << mu;
    std::printf("mu %g: %.5f for %.5f, u %.5f v %.5f\n", mu, -light.q / light.i, degree, light.u / light.i,
                light.v / light.i);
  }
}

}  // namespace
}  // namespace abbe::test
