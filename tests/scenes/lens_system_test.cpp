#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "lens/spot.h"
#include "scene/camera/lens_optics.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// Pictures through real lenses: every technique makes the same, whatever part of it is asked for.

namespace abbe {
namespace {

using test::Region;

// A single meniscus, which parts the colours, in front of matte and glossy matter under lamps of several
// colours.
constexpr const char* kStill = R"({
  "abbe": 1,
  "camera": {"lens_system": {"prescription": "landscape", "focus_distance": 0.4}, "from": [0, -1.2, 0.5], "to": [0, 0, 0.2], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "pixel_pitch_um": 200, "observer": "1931"},
  "materials": {"red": {"diffuse": {"reflectance": "cornell_box_walls:red"}}, "white": {"diffuse": {"reflectance": 0.7}},
                "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.4}}},
  "lights": [
    {"disc": {"center": [-0.6, 0, 1], "normal": [1, 0, -0.8], "radius": 0.2}, "emission": {"illuminant": "FL11", "luminance": 300}},
    {"quad": {"corner": [0.4, 0.4, 1], "edge_u": [0, 0.3, 0], "edge_v": [0.3, 0.05, 0]}, "emission": {"illuminant": "A", "luminance": 400}},
    {"sphere": {"center": [0.5, -0.3, 0.9], "radius": 0.1}, "emission": {"daylight_K": 6504, "luminance": 300}}
  ],
  "shapes": [
    {"quad": {"corner": [-1.5, -1.5, 0], "edge_u": [3, 0, 0], "edge_v": [0, 3, 0]}, "material": "white"},
    {"sphere": {"center": [-0.15, 0, 0.2], "radius": 0.2}, "material": "red"},
    {"sphere": {"center": [0.2, 0.1, 0.12], "radius": 0.12}, "material": "copper"}
  ],
  "render": {"max_depth": 6}
})";

Film still_by(const char* integrator, int samples) {
  Scene scene = test::load_text(
      kStill, {{"/render/integrator", integrator}, {"/render/samples", std::to_string(samples)}});
  scene.features.light_tracing = true;
  scene.features.light_is_traced.assign(scene.lights.size(), true);
  RenderResult result = render(scene, {});
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  return std::move(result.film);
}

// A lamp in a black shell that is taken off when the upper half of the rows has closed: no lane that falls
// there has any light, whichever row the others fall on.
TEST(LensSystemScene, LanesComeThroughTheShutterOfTheirOwnRows) {
  constexpr const char* kUncovered = R"({
    "abbe": 1,
    "camera": {"lens_system": {"prescription": "landscape", "focus_distance": 0.4}, "from": [0, -1, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [16, 16], "pixel_pitch_um": 100, "observer": "1931", "exposure_s": 0.05, "shutter": {"row_delay_s": 0.05}},
    "materials": {"white": {"diffuse": {"reflectance": 0.7}}, "black": {"diffuse": {"reflectance": 0}}},
    "lights": [{"sphere": {"center": [0.5, -1.2, 0.4], "radius": 0.1}, "emission": {"illuminant": "E", "luminance": 300}}],
    "shapes": [
      {"quad": {"corner": [-1.5, 0, -1.5], "edge_u": [0, 0, 3], "edge_v": [3, 0, 0]}, "material": "white"},
      {"sphere": {"center": [0.5, -1.2, 0.4], "radius": 0.2}, "material": "black",
       "motion": {"keyframes": [{"time_s": 0.401}, {"time_s": 0.4011, "translate": [0, 0, 50]}]}}
    ],
    "render": {"max_depth": 4}
  })";
  // Of photons few come to what the film sees.
  const struct {
    const char* integrator;
    const char* by_day;
    const char* at_night;
  } techniques[] = {
      {"path", "64", "256"}, {"light", "1024", "8192"}, {"bdpt", "64", "256"}, {"vcm", "64", "256"}};
  for (const auto& [integrator, by_day, at_night] : techniques) {
    Scene scene = test::load_text(kUncovered, {{"/render/integrator", integrator},
                                               {"/render/samples", test::nightly() ? at_night : by_day}});
    const Film film = render(scene, {}).film;
    EXPECT_EQ(test::region(film, 1, 0, 0, 16, 8).mean, 0) << integrator;
    EXPECT_GT(test::region(film, 1, 0, 10, 16, 14).mean, 0) << integrator;
  }
}

TEST(LensSystemScene, EveryTechniqueMakesTheSamePicture) {
  const struct {
    const char* integrator;
    int by_day, at_night;
  } others[] = {{"light", 256, 1024}, {"bdpt", 64, 128}, {"vcm", 48, 48}};
  const Film path = still_by("path", test::nightly() ? 384 : 128);
  for (const auto& [integrator, by_day, at_night] : others) {
    const Film film = still_by(integrator, test::nightly() ? at_night : by_day);
    const test::Comparison c = test::compare_regions(path, film, 4);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5.5) << integrator;  // 1e-6 over 3 channels x 16 regions x 3 techniques
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path, film, 0.02, 0.1)) << integrator;
  }
}

// The entrance pupil of this lens lies 50 mm and more behind its first vertex, and a card between them.
TEST(LensSystemScene, NothingOfTheSceneIsWithinTheLens) {
  const auto seen = [](const char* integrator, int samples, const std::string& card) {
    return render(test::load_text(fmt::format(R"({{
      "abbe": 1, "units": "mm",
      "camera": {{"lens_system": {{"prescription": "double_gauss", "focus_distance": 400}}, "from": [0, -400, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [8, 8], "pixel_pitch_um": 2000, "channels": {{"g": {{"band": [500, 600]}}}}}},
      "materials": {{"white": {{"diffuse": {{"reflectance": 0.8}}}}, "black": {{"diffuse": {{"reflectance": 0}}}}}},
      "lights": [{{"disc": {{"center": [150, -200, 100], "normal": [-150, 200, -100], "radius": 20}}, "emission": {{"spectrum": 1}}}}],
      "shapes": [{{"quad": {{"corner": [-200, 0, -200], "edge_u": [400, 0, 0], "edge_v": [0, 0, 400]}}, "material": "white"}}{}],
      "render": {{"integrator": "{}", "samples": {}, "photons": {{"per_sample": {}}}}}}})",
                                              card, integrator, samples, test::nightly() ? 16384 : 4096)),
                  {})
        .film;
  };
  const Film open = seen("path", 64, "");
  EXPECT_GT(test::region(open, 0, 0, 0, 8, 8).mean, 0);
  const struct {
    const char* integrator;
    int samples;
    double off;
  } all[] = {{"path", 64, 0.02}, {"light", 512, 0.1}, {"bdpt", 64, 0.05}, {"photon-brute", 512, 0.3}};
  for (const auto& [integrator, samples, off] : all) {
    const Film film = seen(
        integrator, samples,
        R"(, {"quad": {"corner": [-60, -410, -60], "edge_u": [120, 0, 0], "edge_v": [0, 0, 120]}, "material": "black"})");
    const test::Comparison c = test::compare_regions(open, film, 2);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5) << integrator;
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(open, film, off, 3 * off)) << integrator;
  }
}

// Light that a mirror throws on matt walls, which paths from the light alone come to, and that by connections
// to the lens: from 0.3 m, where places on its first surface lie a fifth nearer than those of the entrance
// pupil.
TEST(LensSystemScene, ConnectionsToTheLensCountFromWhereTheyEnd) {
  const auto seen = [](const char* prescription, const char* integrator, int samples) {
    return render(test::load_text(fmt::format(R"({{
      "abbe": 1,
      "camera": {{"lens_system": {{"prescription": "{}", "focus_distance": 0.6, "f_number": 8}}, "from": [0, 0.7, 0], "to": [0, 1, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [12, 10], "pixel_pitch_um": 2500, "channels": {{"g": {{"band": [500, 650]}}}}}},
      "materials": {{"white": {{"diffuse": {{"reflectance": 0.5}}}}, "mirror": {{"mirror": {{"reflectance": 1}}}}}},
      "lights": [{{"spot": {{"at": [0.1, 0.8, 0], "direction": [-0.2, 0.1333, 0], "half_angle_deg": 8}}, "emission": {{"spectrum": 1, "intensity": 1}}}}],
      "shapes": [{{"quad": {{"corner": [-1, 1, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}}, "material": "white"}},
                 {{"quad": {{"corner": [-0.1, 0.8, -0.1], "edge_u": [0, 0.195, 0], "edge_v": [0, 0, 0.2]}}, "material": "mirror"}}],
      "render": {{"integrator": "{}", "samples": {}}}}})",
                                              prescription, integrator, samples)),
                  {})
        .film;
  };
  const int samples = test::nightly() ? 4096 : 512;
  for (const char* lens : {"double_gauss", "tessar"}) {
    const Film light = seen(lens, "light", samples);
    const Film film = seen(lens, "bdpt", samples);
    const test::Comparison c = test::compare_regions(light, film, 1);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", lens, c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5) << lens;
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(light, film, 0.01, 0.1)) << lens;
  }
}

// A small white disc 60 mm above the axis and 300 mm before the lens, in the beam of a spotlight.
constexpr const char* kSpeck = R"({
  "abbe": 1, "units": "mm",
  "camera": {"lens_system": {"prescription": "landscape", "focus_distance": 300}, "from": [0, 0, 0], "to": [0, 300, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [64, 1720], "pixel_pitch_um": 3, "channels": {"B": {"band": [445, 455]}, "G": {"band": [545, 555]}, "R": {"band": [645, 655]}}},
  "materials": {"white": {"diffuse": {"reflectance": 0.8}}},
  "lights": [{"spot": {"at": [0, 200, 60], "direction": [0, 1, 0], "half_angle_deg": 0.2}, "emission": {"illuminant": "E", "luminous_intensity": 1000}}],
  "shapes": [{"disc": {"center": [0, 300, 60], "normal": [0, -1, 0], "radius": 0.2618}, "material": "white"}],
  "render": {"integrator": "light", "samples": 6}
})";

struct Blur {
  double x, y, rms;  // of the picture's right and up [mm]
};
Blur blur_of(const Film& film, int channel, double pitch_mm) {
  double sum = 0, x = 0, y = 0, square = 0;
  for (int j = 0; j < film.height(); ++j)
    for (int i = 0; i < film.width(); ++i) {
      const double value = film.mean(static_cast<std::size_t>(j * film.width() + i), channel);
      const double at_x = (i + 0.5 - film.width() / 2.0) * pitch_mm;
      const double at_y = (film.height() / 2.0 - j - 0.5) * pitch_mm;
      sum += value;
      x += value * at_x;
      y += value * at_y;
      square += value * (at_x * at_x + at_y * at_y);
    }
  x /= sum;
  y /= sum;
  return {x, y, std::sqrt(square / sum - x * x - y * y)};
}

TEST(LensSystemScene, ASpeckIsTheTracedSpotInEveryColour) {
  const Scene scene = test::load_text(kSpeck);
  const LensOptics& optics = *std::get<LensSystem>(scene.camera.kind).optics;
  const double pitch_mm = scene.camera.pixel_pitch * 1e3;
  const Film film = render(scene, {}).film;
  std::array<double, 3> seen{};
  std::array<double, 3> traced{};
  for (const int channel : {0, 1, 2}) {
    const lens::SystemAt at(optics.system.system(), 450 + 100 * channel);
    const auto spot_at = [&](double height) {
      const lens::Spot spot =
          lens::spot(*lens::Beam::of(at, height, optics.system.stop_radius_mm()), height, 96);
      return lens::size_of({&spot, 1});
    };
    const auto size = spot_at(60);
    const Blur blur = blur_of(film, channel, pitch_mm);
    // The disc, evenly lit and distorted, and the pixels blur the spot further.
    const double round = size->centroid.y / 60;
    const double radial = (spot_at(61)->centroid.y - spot_at(59)->centroid.y) / 2;
    const double disc2 = 0.2618 * 0.2618 * (round * round + radial * radial) / 4;
    const double rms = std::sqrt(size->rms_mm * size->rms_mm + disc2 + pitch_mm * pitch_mm / 6);
    seen[static_cast<std::size_t>(channel)] = blur.y;
    traced[static_cast<std::size_t>(channel)] = -size->centroid.y;
    std::printf("channel %d: at %.5f, traced %.5f mm; rms %.2f, traced %.2f um\n", channel, blur.y,
                -size->centroid.y, 1e3 * blur.rms, 1e3 * rms);
    EXPECT_NEAR(blur.x, 0, 0.3 * pitch_mm);
    EXPECT_NEAR(blur.y, -size->centroid.y, 0.3 * pitch_mm) << "channel " << channel;
    EXPECT_NEAR(blur.rms / rms, 1, 0.01) << "channel " << channel;
  }
  EXPECT_GT(std::abs(traced[2] - traced[0]), pitch_mm);
  EXPECT_NEAR((seen[2] - seen[0]) / (traced[2] - traced[0]), 1, 0.02) << "lateral colour";
}

bool same_bits(const Film& a, const Film& b, const Crop& within) {
  for (int y = within.y0; y < within.y1; ++y)
    for (int x = within.x0; x < within.x1; ++x)
      for (int channel = 0; channel < a.channels(); ++channel) {
        const auto pixel = static_cast<std::size_t>(y * a.width() + x);
        if (a.mean(pixel, channel) != b.mean(pixel, channel) ||
            a.variance(pixel, channel) != b.variance(pixel, channel))
          return false;
      }
  return true;
}

// What falls on a pixel may have been drawn for another one.
TEST(LensSystemScene, ACropHasTheBitsOfTheWhole) {
  for (const char* integrator : {"path", "bdpt", "sppm"}) {
    const Scene scene =
        test::load_text(kStill, {{"/render/integrator", integrator}, {"/render/samples", "8"}});
    const Film whole = render(scene, {.threads = 2}).film;
    ASSERT_GT(frame_mean_error(whole), 0);
    EXPECT_TRUE(same_bits(whole, render(scene, {.threads = 1}).film, {0, 0, 32, 32})) << integrator;
    const Crop crop{9, 13, 20, 22};
    EXPECT_TRUE(same_bits(whole, render(scene, {.crop = crop}).film, crop)) << integrator;
  }
}

TEST(LensSystemScene, APrescriptionMayStandInTheScene) {
  std::ifstream file(data_directory() / "lens" / "landscape.json");
  const std::string prescription{std::istreambuf_iterator<char>(file), {}};
  const std::vector<Override> named{{"/render/integrator", "path"}, {"/render/samples", "8"}};
  std::vector<Override> within = named;
  within.push_back({"/camera/lens_system/prescription", prescription});
  const Film film = render(test::load_text(kStill, named), {}).film;
  ASSERT_GT(frame_mean_error(film), 0);
  EXPECT_EQ(render(test::load_text(kStill, within), {}).film.bytes(), film.bytes());
}

TEST(LensSystemScene, PartsAddUpToTheWhole) {
  const Scene scene = test::load_text(kStill, {{"/render/integrator", "path"}, {"/render/samples", "8"}});
  const Film whole = render(scene, {.samples = SampleRange{0, 8}}).film;
  Film sum = render(scene, {.samples = SampleRange{0, 3}}).film;
  sum.add(render(scene, {.samples = SampleRange{3, 8}}).film);
  EXPECT_EQ(sum.bytes(), whole.bytes());
}

// A mosaic's pixels, as small as the lens spreads colours, look at some that were drawn for their neighbours.
TEST(LensSystemScene, AMosaicSeesWhatItsChannelsSee) {
  const std::vector<Override> rgb{
      {"/sensor",
       R"({"resolution": [32, 32], "pixel_pitch_um": 20, "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]}, "B": {"band": [400, 500]}}})"},
      {"/render/integrator", "path"},
      {"/render/samples", "256"}};
  std::vector<Override> mosaic = rgb;
  mosaic[0].value.insert(1, R"("mosaic": [["R", "G"], ["G", "B"]], )");
  const Film all = render(test::load_text(kStill, rgb), {}).film;
  const Scene scene = test::load_text(kStill, mosaic);
  const Film one = render(scene, {}).film;
  std::array<double, 3> seen{};
  std::array<double, 3> expected{};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const auto pixel = static_cast<std::size_t>(y * 32 + x);
      const int channel = scene.mosaic->at(x, y);
      seen[static_cast<std::size_t>(channel)] += one.mean(pixel, 0);
      expected[static_cast<std::size_t>(channel)] += all.mean(pixel, channel);
    }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k] / expected[k], 1, 0.02) << "channel " << k;
}

}  // namespace
}  // namespace abbe
