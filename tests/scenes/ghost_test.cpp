#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "lens/route.h"
#include "materials/interface/fresnel.h"
#include "scene/camera/lens_optics.h"
#include "scene/scene_features.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/polarised_scene.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// Pictures by light that the surfaces of a lens reflect twice, and through lenses that polarise.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V3d;

// A biconvex lens of an index at which a quarter of the light is reflected. Two lamps, one of which the film
// does not see, and matter between.
constexpr const char* kBrightGhosts = R"({
  "abbe": 1,
  "camera": {"lens_system": {"prescription": {"surfaces": [{"stop": true, "thickness": 1, "aperture": 3}, [90, 3, 3.0, 8], [-90, 22, null, 8]], "focus": "paraxial"},
                             "ghosts": true}, "from": [0, -1, 0.3], "to": [0, 0, 0.2], "up": [0, 0, 1]},
  "sensor": {"resolution": [16, 16], "pixel_pitch_um": 700, "observer": "1931"},
  "materials": {"white": {"diffuse": {"reflectance": 0.6}}, "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.4}}},
  "lights": [
    {"sphere": {"center": [0.1, 0, 0.3], "radius": 0.1}, "emission": {"illuminant": "A", "luminance": 9000}},
    {"sphere": {"center": [0.45, -0.4, 0.6], "radius": 0.15}, "emission": {"daylight_K": 6504, "luminance": 9000}}
  ],
  "shapes": [
    {"quad": {"corner": [-1.5, -1.5, 0], "edge_u": [3, 0, 0], "edge_v": [0, 3, 0]}, "material": "white"},
    {"sphere": {"center": [-0.15, 0, 0.15], "radius": 0.15}, "material": "copper"}
  ],
  "render": {"max_depth": 5}
})";

// By day of as many photons as suit a film this small.
Film bright_ghosts(const std::string& integrator, int samples, const std::vector<Override>& more = {}) {
  std::vector<Override> settings{{"/render/integrator", integrator},
                                 {"/render/samples", std::to_string(samples)}};
  if (!test::nightly() && integrator == "sppm")
    settings.push_back({"/render/photons", R"({"per_sample": 1024})"});
  settings.insert(settings.end(), more.begin(), more.end());
  RenderResult result = render(test::load_text(kBrightGhosts, settings), {});
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  return std::move(result.film);
}

// Path tracing connects lights to the lens, the others meet them by rays from the film.
TEST(Ghosts, AreTheSameByEveryTechnique) {
  const int fewer = test::nightly() ? 1 : 4;  // samples by day
  const Film path = bright_ghosts("path", 1024 / fewer);
  const Film without = bright_ghosts("path", 256 / fewer, {{"/camera/lens_system/ghosts", "false"}});
  const test::Comparison of_ghosts = test::compare_regions(path, without, 4);
  std::printf("with over without ghosts: %.4f, largest z %.1f\n", 1 / of_ghosts.ratio, of_ghosts.largest_z);
  EXPECT_GT(of_ghosts.largest_z, 20) << "there is something to agree on";
  for (const auto& [integrator, samples] : {std::pair("bdpt", 1024), {"vcm", 512}}) {
    const Film film = bright_ghosts(integrator, samples / fewer);
    const test::Comparison c = test::compare_regions(path, film, 4);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5.5) << integrator;  // 1e-6 over 3 channels x 16 regions x 2 techniques
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path, film, 0.02, 0.1)) << integrator;
  }
  const Film gathered = bright_ghosts("sppm", 256 / fewer);
  const double ratio = test::compare_regions(path, gathered, 4).ratio;
  std::printf("sppm: ratio of the means %.5f\n", ratio);
  EXPECT_NEAR(ratio, 1, test::ratio_margin(path, gathered, 0.02, 0.1));
}

// No path from the camera meets a lamp without size.
TEST(Ghosts, OfPointsAreTheSameByEveryTechnique) {
  const std::vector<Override> lamp{
      {"/lights",
       R"([{"point": {"at": [0.3, -0.4, 0.5]}, "emission": {"illuminant": "A", "luminous_intensity": 300}}])"}};
  const int samples = test::nightly() ? 256 : 64;
  const Film path = bright_ghosts("path", samples, lamp);
  for (const char* integrator : {"bdpt", "vcm", "sppm"}) {
    const Film film = bright_ghosts(integrator, samples, lamp);
    const test::Comparison c = test::compare_regions(path, film, 4);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path, film, 0.02, 0.1)) << integrator;
  }
  std::vector<Override> without = lamp;
  without.push_back({"/camera/lens_system/ghosts", "false"});
  EXPECT_GT(test::compare_regions(bright_ghosts("path", 64, without), path, 4).ratio, 1.02);
}

// On a film so wide that a lens stops some wavelengths of a path and lets others through, by an edge or by
// total reflection: those it stops bring nothing, polarised or not.
TEST(Ghosts, StopWavelengthsWithoutHarmToOthers) {
  Scene room = test::load_text(R"({"abbe": 1,
    "camera": {"lens_system": {"prescription": "double_gauss", "focus_distance": 1.0, "ghosts": true},
               "from": [0.05, -0.8, 0.1], "to": [0, 1, -0.3], "up": [0, 0, 1]},
    "sensor": {"resolution": [16, 16], "channels": {"b": {"band": [430, 470]}, "r": {"band": [600, 700]}},
               "exposure_s": 0.1, "pixel_pitch_um": 1500, "stokes": true},
    "materials": {"w": {"diffuse": {"reflectance": 0.5}}},
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1.3}, "material": "w"}],
    "lights": [{"sphere": {"center": [0.2, 0, 0.7], "radius": 0.15}, "emission": {"spectrum": 1}}],
    "render": {"integrator": "path", "samples": 1024, "seed": 1}})");
  if (!test::nightly()) room.render.samples = 256;
  EXPECT_EQ(render(room, {}).stats.nonfinite_samples, 0U);
}

// Of what a mirror lights by a lamp without size, photons are connected to the lens by its ghosts.
TEST(Ghosts, OfWhatPhotonsLightAreTheSameByEveryTechnique) {
  const V3d at(1, -0.2, 0.5);
  const V3d normal = ((-at).normalized() - V3d(1, 0, 0)).normalized();
  const std::vector<Override> mirrored{
      {"/lights",
       R"([{"spot": {"at": [0.6, -0.2, 0.5], "direction": [1, 0, 0], "half_angle_deg": 12}, "emission": {"illuminant": "A", "luminous_intensity": 300}}])"},
      {"/materials/mirror", R"({"mirror": {"reflectance": 1}})"},
      {"/shapes/1", fmt::format(R"({{"quad": {}, "material": "mirror"}})", test::square(at, normal, 0.3))}};
  const int fewer = test::nightly() ? 1 : 2;  // samples by day
  const Film light = bright_ghosts("light", 512 / fewer, mirrored);
  ASSERT_GT(frame_mean_error(light), 0);
  for (const auto& [integrator, samples] : {std::pair("bdpt", 512), {"vcm", 256}}) {
    const Film film = bright_ghosts(integrator, samples / fewer, mirrored);
    const test::Comparison c = test::compare_regions(light, film, 4);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(light, film, 0.02, 0.1)) << integrator;
  }
  std::vector<Override> without = mirrored;
  without.push_back({"/camera/lens_system/ghosts", "false"});
  EXPECT_GT(test::compare_regions(bright_ghosts("light", 256 / fewer, without), light, 4).ratio, 1.04);
}

// A small lamp's light that is reflected within the lens: of the flux through the stop the share that a trace
// of even rays finds, spread over the film as these rays are.
TEST(NightlyGhosts, OfALampHaveTheTracedPowerAndPlace) {
  constexpr const char* kLamp = R"({
    "abbe": 1, "units": "mm",
    "camera": {"lens_system": {"prescription": {"surfaces": [{"stop": true, "thickness": 0.5, "aperture": 0.8}, [60, 1, 2.0, 4], [-60, 30, null, 4]], "focus": "paraxial"},
                               "focus_distance": 900, "ghosts": true}, "from": [0, 0, 0], "to": [0, 1, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [90, 90], "pixel_pitch_um": 100, "channels": {"all": {"band": [545, 555]}}},
    "materials": {},
    "lights": [{"sphere": {"center": [0, 900, 30], "radius": 1}, "emission": {"illuminant": "E", "luminance": 9000}}],
    "shapes": [],
    "render": {"integrator": "path", "samples": 64}
  })";
  const Scene scene = test::load_text(kLamp);
  const LensOptics& optics = *std::get<LensSystem>(scene.camera.kind).optics;
  ASSERT_EQ(optics.routes.size(), 2U);
  struct Moments {
    double power = 0, y = 0, square = 0;
    void add(double weight, const V2d& at) {
      power += weight;
      y += weight * at.y;
      square += weight * at.length2();
    }
    [[nodiscard]] double height() const { return y / power; }
    [[nodiscard]] double rms() const { return std::sqrt(square / power - height() * height()); }
  };
  Moments image, traced;
  constexpr int kSide = 200;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const V2d stop((i + 0.5) / kSide * 1.6 - 0.8, (j + 0.5) / kSide * 1.6 - 0.8);
      const V3d from(0, 30, -900);
      const lens::Ray ray{from, (V3d(stop.x, stop.y, 0) - from).normalized()};
      for (const std::size_t route : {0, 1}) {
        const auto there = optics.system.to_image(ray, 550, optics.routes[route]);
        if (there) (route == 0 ? image : traced).add(there->transmittance, there->point);
      }
    }
  const auto film_moments = [&](const Film& film) {
    Moments of;
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        const V2d at((x + 0.5 - film.width() / 2.0) * 0.1, (y + 0.5 - film.height() / 2.0) * 0.1);
        of.add(film.mean(film.pixel_at(x, y), 0), at);
      }
    return of;
  };
  const Moments direct = film_moments(render(test::load_text(kLamp, {{"/camera/lens_system/ghosts", "false"},
                                                                     {"/render/samples", "1024"},
                                                                     {"/sensor/resolution", "[90, 90]"}}),
                                             {})
                                          .film);
  // What is in the image of the lamp, a disc of .07 mm, is taken out of the picture with ghosts.
  const Film film = render(scene, {}).film;
  Moments ghost;
  const double image_y = -image.height();
  double left_out = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 90; ++x) {
      const V2d at((x + 0.5) * 0.1 - 4.5, 4.5 - (y + 0.5) * 0.1);
      const bool beside = std::max(std::abs(at.x), std::abs(at.y - image_y)) > 0.25;
      if (beside)
        ghost.add(film.mean(static_cast<std::size_t>(y * 90 + x), 0), at);
      else
        left_out += 1;
    }
  const double radius = traced.rms() * std::sqrt(2.0);
  const double area_share = 1 - left_out * 0.01 / (std::numbers::pi * radius * radius);
  std::printf("ghost's share: %.5f, traced %.5f; rms %.4f, traced %.4f mm, at %.4f, traced %.4f mm\n",
              ghost.power / direct.power, area_share * traced.power / image.power, ghost.rms(), traced.rms(),
              ghost.height(), -traced.height());
  EXPECT_NEAR(ghost.power / direct.power / (area_share * traced.power / image.power), 1, 0.02);
  EXPECT_NEAR(ghost.rms() / traced.rms(), 1, 0.02);
  EXPECT_NEAR(ghost.height(), -traced.height(), 0.02 * traced.rms());
  EXPECT_NEAR(traced.power / image.power, std::pow(1.0 / 9, 2), 1e-3) << "R^2 along the normal";
}

TEST(Ghosts, HaveTheSameBitsInPartsAndThreads) {
  const Scene scene =
      test::load_text(kBrightGhosts, {{"/render/integrator", "path"}, {"/render/samples", "8"}});
  const Film whole = render(scene, {.threads = 2, .samples = SampleRange{0, 8}}).film;
  Film sum = render(scene, {.threads = 1, .samples = SampleRange{0, 3}}).film;
  sum.add(render(scene, {.samples = SampleRange{3, 8}}).film);
  EXPECT_EQ(sum.bytes(), whole.bytes());
}

// A pixel's albedo, depth and the like are those of what its image shows.
TEST(Ghosts, AreNotInFeatures) {
  const auto features = [](const char* ghosts) {
    const Scene scene = test::load_text(
        kBrightGhosts,
        {{"/render/integrator", "path"}, {"/render/samples", "2"}, {"/camera/lens_system/ghosts", ghosts}});
    const RenderResult result = render(scene, {.features = {Feature::depth, Feature::normal}});
    return std::string(result.features->sums().bytes());
  };
  EXPECT_EQ(features("true"), features("false"));
}

// A tilted plate of high index before a weak lens passes s and p by T_s^2 and T_p^2.
constexpr const char* kTiltedPlate = R"({
  "abbe": 1,
  "camera": {"lens_system": {"prescription": {"surfaces": [
    {"radius": 0, "thickness": 0.2, "glass": 3.0, "tilt_deg": [50, 0]}, {"radius": 0, "thickness": 12, "tilt_deg": [50, 0]},
    {"stop": true, "thickness": 0.5, "aperture": 0.5}, [40, 1, 1.5, 5], [-40, 39, null, 5]]}}, "from": [0, 0, 0], "to": [0, 1, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [4, 4], "pixel_pitch_um": 50, "observer": "1931"},
  "materials": {},
  "lights": [{"quad": {"corner": [-1, 1, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}, "emission": {"illuminant": "E", "luminance": 100}}],
  "shapes": [],
  "render": {"integrator": "path", "samples": 64}
})";

TEST(LensPolarisation, OfAPlateIsWhatFresnelSays) {
  const auto of = fresnel_dielectric<double>(std::cos(50 * std::numbers::pi / 180), 3.0);
  const double s = of.Ts * of.Ts;
  const double p = of.Tp * of.Tp;
  // s is along the tilt's axis, the picture's right.
  const test::StokesMean seen =
      test::stokes_of(render(test::load_text(kTiltedPlate, {{"/sensor/stokes", "true"}}), {}).film);
  std::printf("Q/I %.5f, by Fresnel %.5f\n", seen.q / seen.i, (s - p) / (s + p));
  EXPECT_NEAR(seen.q / seen.i, (s - p) / (s + p), 1e-3);
  EXPECT_NEAR(seen.u / seen.i, 0, 2e-3);
  EXPECT_NEAR(seen.v / seen.i, 0, 2e-3);
}

// Fields along both axes keep their phases: light that is polarised half-way between them, or circularly, has
// 2 T_s T_p/(T_s^2 + T_p^2) left of that.
TEST(LensPolarisation, KeepsPhases) {
  const auto of = fresnel_dielectric<double>(std::cos(50 * std::numbers::pi / 180), 3.0);
  const double kept = 2 * of.Ts * of.Tp / (of.Ts * of.Ts + of.Tp * of.Tp);
  const auto seen = [](const char* how) {
    return test::stokes_of(render(test::load_text(kTiltedPlate, {{"/sensor/stokes", "true"},
                                                                 {"/lights/0/emission/polarised", how}}),
                                  {})
                               .film);
  };
  const test::StokesMean slanted = seen(R"({"axis": [1, 0, 1]})");
  EXPECT_NEAR(slanted.u / slanted.i, kept, 2e-3);
  EXPECT_NEAR(slanted.v / slanted.i, 0, 2e-3);
  const test::StokesMean circular = seen(R"({"circular": "right"})");
  EXPECT_NEAR(circular.v / circular.i, kept, 2e-3);
  EXPECT_NEAR(circular.u / circular.i, 0, 2e-3);
}

// So it does where the sensor measures power alone, of light that is polarised when it comes.
TEST(LensPolarisation, IsWhatAPolarisedLampShows) {
  const auto of = fresnel_dielectric<double>(std::cos(50 * std::numbers::pi / 180), 3.0);
  const auto brightness = [](const char* axis) {
    const Scene scene = test::load_text(kTiltedPlate, {{"/lights/0/emission/polarised/axis", axis}});
    EXPECT_TRUE(carries_polarisation(scene));
    return test::mean_of(render(scene, {}).film, 1);
  };
  const double level = brightness("[1, 0, 0]");
  const double upright = brightness("[0, 0, 1]");
  std::printf("s over p %.5f, by Fresnel %.5f\n", level / upright, std::pow(of.Ts / of.Tp, 2));
  EXPECT_NEAR(level / upright / std::pow(of.Ts / of.Tp, 2), 1, 2e-3);
}

}  // namespace
}  // namespace abbe
