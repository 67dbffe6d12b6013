#include <cmath>
#include <numbers>
#include <ostream>

#include <fmt/format.h>

#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// What moves while the film is exposed, against what can be told of it by hand, and by every technique.

namespace abbe {
namespace {

// A bright bar 20 pixels wide that crosses 60 pixels while the shutter is open: a pixel sees 20 mm of its
// plane.
constexpr const char* kBar = R"({
  "abbe": 1,
  "camera": {"pinhole": {"focal_length": 0.5}, "from": [0, 0, 100], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [128, 16], "pixel_pitch_um": 100, "channels": {"E": {"band": [400, 700]}}, "exposure_s": 0.02},
  "lights": [{"quad": {"corner": [-0.2, -9, 0], "edge_u": [0.4, 0, 0], "edge_v": [0, 18, 0]}, "emission": {"spectrum": 1},
              "motion": {"keyframes": [{"time_s": 0, "translate": [-0.6, 0, 0]}, {"time_s": 0.02, "translate": [0.6, 0, 0]}]}}],
  "render": {"integrator": "path", "samples": 1024}
})";

// Sum, mean place and variance of the light along a row, in pixels.
struct Profile {
  double sum = 0;
  double mean = 0;
  double variance = 0;
};
Profile profile(const Film& film, int y0, int y1) {
  Profile of;
  double second = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < film.width(); ++x) {
      const double value = film.mean(static_cast<std::size_t>(y * film.width() + x), 0);
      of.sum += value;
      of.mean += value * (x + 0.5);
      second += value * (x + 0.5) * (x + 0.5);
    }
  of.mean /= of.sum;
  of.variance = second / of.sum - of.mean * of.mean - 1.0 / 12;  // without that of a pixel
  return of;
}

// The image of a bar of width w whose middle is spread over the length d has the variance (w^2 + d^2) / 12.
TEST(MovingScene, BlursByTheWayThatIsGone) {
  const Profile moving = profile(render(test::load_text(kBar), {}).film, 0, 16);
  EXPECT_NEAR(moving.mean, 64, 0.05);
  EXPECT_NEAR(std::sqrt(12 * moving.variance - 20 * 20), 60, 0.1);
  // A camera that goes the other way sees the same, but for where the bar is.
  const Profile seen = profile(
      render(
          test::load_text(kBar, {{"/lights/0/motion", R"({"keyframes": [{"time_s": 5}]})"},
                                 {"/camera/motion", R"({"keyframes": [{"time_s": 0, "translate": [0.6, 0, 0]},
                                                                         {"time_s": 0.02, "translate": [-0.6, 0, 0]}]})"}}),
          {})
          .film,
      0, 16);
  EXPECT_NEAR(std::sqrt(12 * seen.variance - 20 * 20), 60, 0.1);
  EXPECT_NEAR(seen.sum / moving.sum, 1, 1e-3);
}

// The bar's place at the share s of the exposure is 34 + 60 s, which S weighs: here it rises for a quarter of
// the exposure, stays for one and falls for the half, with the integral 5/8.
TEST(MovingScene, ExposesByTheIntegralOfItsShutter) {
  constexpr const char* kTrapezoid = R"({"rise_s": 0.005, "fall_s": 0.01})";
  const Film open = render(test::load_text(kBar), {}).film;
  const Film half = render(test::load_text(kBar, {{"/sensor/shutter", kTrapezoid}}), {}).film;
  const double mean_place = (1.0 / 48 + 3.0 / 32 + 1.0 / 6) / 0.625;
  EXPECT_NEAR(profile(half, 0, 16).sum / profile(open, 0, 16).sum, 0.625, 1e-3);
  EXPECT_NEAR(profile(half, 0, 16).mean, 34 + 60 * mean_place, 0.05);
  // By pairs, and where nothing moves: to the last bit of a float.
  const Film same = render(test::load_text(kBar, {{"/sensor/shutter", R"({"transmission": [[0, 0], [0.25, 1],
                                                                         [0.5, 1], [1, 0]]})"}}),
                           {})
                        .film;
  EXPECT_EQ(half.bytes(), same.bytes());
  const Override still{"/lights/0/motion", R"({"keyframes": [{"time_s": 1}]})"};
  const Profile all = profile(render(test::load_text(kBar, {still}), {}).film, 0, 16);
  const Scene dimmed = test::load_text(kBar, {still, {"/sensor/shutter", kTrapezoid}});
  EXPECT_FALSE(dimmed.features.motion);
  EXPECT_NEAR(profile(render(dimmed, {}).film, 0, 16).sum / all.sum, 0.625, 1e-6);
}

// Each row sees the bar when its shutter is open: 3 pixels further than the one above.
TEST(MovingScene, SlantsWhatCrossesARollingShutter) {
  const Scene scene = test::load_text(
      kBar, {{"/sensor/exposure_s", "0.0001"}, {"/sensor/shutter", R"({"row_delay_s": 0.001})"}});
  const Film film = render(scene, {}).film;
  for (int row = 0; row < 16; ++row) {
    const double middle_s = row * 0.001 + 0.00005;
    EXPECT_NEAR(profile(film, row, row + 1).mean, 34 + 60 * middle_s / 0.02, 0.1) << "row " << row;
  }
}

// A spoke through the hub in the middle of the film, which turns while rows are read from top to bottom: at h
// above the hub it is met h tan(w t) to the right of it, t being when that row is open.
TEST(MovingScene, BendsTheSpokesOfAWheel) {
  constexpr const char* kSpoke = R"({
    "abbe": 1,
    "camera": {"pinhole": {"focal_length": 0.5}, "from": [0, 0, 100], "to": [0, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [160, 64], "pixel_pitch_um": 100, "channels": {"E": {"band": [400, 700]}}, "exposure_s": 0.0001,
               "shutter": {"row_delay_s": 0.001}},
    "lights": [{"quad": {"corner": [-0.02, -3, 0], "edge_u": [0.04, 0, 0], "edge_v": [0, 6, 0]}, "emission": {"spectrum": 1},
                "motion": {"keyframes": [{"time_s": 0, "rotate": {"axis": [0, 0, 1], "deg": 30}},
                                         {"time_s": 0.064, "rotate": {"axis": [0, 0, 1], "deg": -60}}]}}],
    "render": {"integrator": "path", "samples": 256}
  })";
  const Film film = render(test::load_text(kSpoke), {}).film;
  for (int row = 0; row < 64; ++row) {
    const double time_s = row * 0.001 + 0.00005;
    const double clockwise = (-30 + 90 * time_s / 0.064) * std::numbers::pi / 180;
    const double above = 32 - (row + 0.5);
    EXPECT_NEAR(profile(film, row, row + 1).mean, 80 + above * std::tan(clockwise), 0.1) << "row " << row;
  }
}

// A lamp that flies and one that swings above cards, one of which tumbles; a ball of glass that rolls.
constexpr const char* kBusy = R"({
  "abbe": 1,
  "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 1, "focus_distance": 3}, "from": [0, -3, 1.2], "to": [0, 0, 0.3], "up": [0, 0, 1],
             "motion": {"keyframes": [{"time_s": 0}, {"time_s": 1, "translate": [0.1, 0, 0.1], "rotate": {"axis": [0, 0, 1], "deg": 3}}]}},
  "sensor": {"resolution": [24, 24], "pixel_pitch_um": 900, "channels": {"B": {"band": [400, 550]}, "R": {"band": [550, 700]}}},
  "materials": {"red": {"diffuse": {"reflectance": "cornell_box_walls:red"}}, "white": {"diffuse": {"reflectance": 0.7}},
                "glass": {"dielectric": {"ior": 1.5}}},
  "lights": [
    {"sphere": {"center": [-1.5, 0, 1.5], "radius": 0.5}, "emission": {"spectrum": 1},
     "motion": {"keyframes": [{"time_s": 0}, {"time_s": 0.4, "translate": [2, 0, 0]}, {"time_s": 1, "translate": [2, 0, 0.5]}]}},
    {"quad": {"corner": [0.5, 0.2, 2], "edge_u": [0, 0.6, 0], "edge_v": [0.6, 0, 0]}, "emission": {"spectrum": 1},
     "motion": {"keyframes": [{"time_s": 0, "rotate": {"axis": [0, 1, 0], "deg": -10}}, {"time_s": 1, "rotate": {"axis": [1, 1, 0], "deg": 30}}]}},
    {"spot": {"at": [0, -1, 2], "direction": [0, 0.3, -1], "half_angle_deg": 25}, "emission": {"spectrum": 1, "radiant_flux_W": 0.5},
     "motion": {"keyframes": [{"time_s": 0}, {"time_s": 1, "translate": [0.8, 0, 0], "rotate": {"axis": [0, 1, 0], "deg": -15}}]}}
  ],
  "shapes": [
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "white"},
    {"quad": {"corner": [-0.4, -0.4, 0], "edge_u": [0.8, 0, 0], "edge_v": [0, 0.8, 0]}, "material": "red",
     "motion": {"keyframes": [{"time_s": 0, "translate": [0.3, 0.4, 0.6]}, {"time_s": 1, "rotate": {"axis": [1, 0, 0.2], "deg": 170}, "translate": [0.5, 0.4, 0.8]}]}},
    {"sphere": {"center": [-0.9, -0.4, 0.31], "radius": 0.3}, "material": "glass",
     "motion": {"keyframes": [{"time_s": 0}, {"time_s": 1, "translate": [1, 0, 0]}]}}
  ],
  "render": {"max_depth": 6}
})";

struct Ends {
  const char* name;
  const char* integrator;
  const char* shutter;
  int path_samples;
  int samples;
  double margin;
};
void PrintTo(const Ends& ends, std::ostream* out) {
  *out << ends.name;
}

class MovingEnds : public testing::TestWithParam<Ends> {};

TEST_P(MovingEnds, AgreeWithPathTracing) {
  const Ends& ends = GetParam();
  const auto rendered = [&](const char* integrator, int samples) {
    Scene scene = test::load_text(kBusy, {{"/sensor/shutter", ends.shutter},
                                          {"/render/integrator", integrator},
                                          {"/render/samples", std::to_string(samples)}});
    if (std::string(integrator) == "auto") {
      scene.features.light_tracing = true;
      scene.features.light_is_traced.assign(scene.lights.size(), true);
    }
    return render(scene, {}).film;
  };
  const int fewer = test::nightly() ? 1 : 4;  // samples by day
  const Film path = rendered("path", ends.path_samples / fewer);
  const Film other = rendered(ends.integrator, ends.samples / fewer);
  const test::Comparison c = test::compare_regions(path, other, 4);
  std::printf("%s: largest z %.2f, ratio of the means %.5f\n", ends.name, c.largest_z, c.ratio);
  EXPECT_LT(c.largest_z, 5.5);  // 1e-6 over 2 channels x 16 regions
  EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path, other, ends.margin, 0.1));
}

constexpr const char* kGlobal = R"({"rise_s": 0.3})";
constexpr const char* kRolling = R"({"open_s": 0.2, "row_delay_s": 0.05, "fall_s": 0.5})";

INSTANTIATE_TEST_SUITE_P(Techniques, MovingEnds,
                         testing::Values(Ends{"auto", "auto", kGlobal, 512, 512, 0.01},
                                         Ends{"auto_rolling", "auto", kRolling, 512, 512, 0.01},
                                         Ends{"bdpt", "bdpt", kGlobal, 512, 256, 0.015},
                                         Ends{"bdpt_rolling", "bdpt", kRolling, 512, 256, 0.02}),
                         [](const auto& info) { return std::string(info.param.name); });
INSTANTIATE_TEST_SUITE_P(Nightly, MovingEnds,
                         testing::Values(Ends{"auto", "auto", kGlobal, 4096, 4096, 0.005},
                                         Ends{"auto_rolling", "auto", kRolling, 4096, 4096, 0.005},
                                         Ends{"bdpt", "bdpt", kGlobal, 4096, 4096, 0.005},
                                         Ends{"bdpt_rolling", "bdpt", kRolling, 4096, 4096, 0.01},
                                         Ends{"vcm", "vcm", kGlobal, 4096, 4096, 0.01},
                                         Ends{"vcm_rolling", "vcm", kRolling, 4096, 4096, 0.02},
                                         Ends{"sppm", "sppm", kGlobal, 4096, 8192, 0.02},
                                         Ends{"sppm_rolling", "sppm", kRolling, 4096, 8192, 0.02}),
                         [](const auto& info) { return std::string(info.param.name); });

// A camera that sets out in a ball of absorbing glass which leaves it behind: as long as it is within, light
// has lost e^(-2) on its way out to the white sky.
TEST(MovingScene, StartsInTheMatterThatIsThereThen) {
  constexpr const char* kLeft = R"({
    "abbe": 1,
    "camera": {"pinhole": {"fov_deg": 1}, "from": [0, 0, 0], "to": [0, 0, -1], "up": [0, 1, 0]},
    "sensor": {"resolution": [4, 4], "channels": {"E": {"band": [400, 700]}}},
    "materials": {"grey": {"dielectric": {"ior": 1, "absorption_per_m": 2}}},
    "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "grey",
                "motion": {"keyframes": [{"time_s": 0.25}, {"time_s": 0.2501, "translate": [100, 0, 0]}]}}],
    "render": {"integrator": "path", "samples": 1024}
  })";
  const test::Region some = test::region(render(test::load_text(kLeft), {}).film, 0, 0, 0, 4, 4);
  const test::Region all =
      test::region(render(test::load_text(kLeft, {{"/shapes", "[]"}}), {}).film, 0, 0, 0, 4, 4);
  EXPECT_NEAR(some.mean / all.mean, 0.25 * std::exp(-2.0) + 0.75, 2e-3);
}

std::string refused(const std::string& text, const std::vector<Override>& settings) {
  try {
    (void)test::load_text(text, settings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// What has been turned before the shutter opens, and stands still since, keeps its axes as what still turns.
TEST(MovingScene, TurnsTheAxesOfWhatStandsStillThen) {
  const auto through = [](const char* shape, double last_deg) {
    const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 5}}, "from": [0, 0, 6], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [4, 4], "channels": {{"along": {{"polariser": {{"angle_deg": 0}}}}, "across": {{"polariser": {{"angle_deg": 90}}}}}}}},
      "materials": {{"sheet": {{"polariser": {{}}}}}},
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "shapes": [{{{}, "material": "sheet", "motion": {{"keyframes": [
        {{"time_s": 0, "rotate": {{"axis": [0, 0, 1], "deg": 90}}}},
        {{"time_s": 1, "rotate": {{"axis": [0, 0, 1], "deg": {}}}}}]}}}}],
      "render": {{"integrator": "path", "samples": 4}}}})",
                                                    shape, last_deg));
    const Film film = render(scene, {}).film;
    return test::whole(film, 0).mean / test::whole(film, 1).mean;
  };
  for (const char* shape : {R"("disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 2})",
                            R"("quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]})"})
    for (const double last_deg : {90.0, 90.1}) EXPECT_LT(through(shape, last_deg), 1e-4) << shape << last_deg;
}

// A lamp that has been turned before the shutter opens, and stands still since, shines as one that still
// turns.
TEST(MovingScene, WhatStandsStillThenEmits) {
  const auto seen = [](double last_deg) {
    const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 5}}, "from": [0, 0, 6], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [4, 4], "channels": {{"Y": {{"band": [500, 600]}}}}}},
      "materials": {{"black": {{"diffuse": {{"reflectance": 0}}}}}},
      "shapes": [{{"material": "black", "sphere": {{"center": [0, 0, 0], "radius": 2}}, "emission": {{"spectrum": 1}}, "motion": {{"keyframes": [
        {{"time_s": 0, "rotate": {{"axis": [0, 0, 1], "deg": 90}}}},
        {{"time_s": 1, "rotate": {{"axis": [0, 0, 1], "deg": {}}}}}]}}}}],
      "render": {{"integrator": "path", "samples": 16}}}})",
                                                    last_deg));
    return test::whole(render(scene, {}).film, 0).mean;
  };
  EXPECT_GT(seen(90), 0);
  EXPECT_NEAR(seen(90) / seen(91), 1, 1e-3);
}

TEST(MovingScene, RefusesWhatHasNoMeaning) {
  const auto says = [](const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  says(refused(kBar, {{"/lights/0/motion/keyframes/1/time_s", "0"}}),
       "times of keyframes must increase (got 0 after 0)");
  says(refused(kBar, {{"/sensor/shutter", R"({"rise_s": 0.015, "fall_s": 0.01})"}}),
       "a shutter must open and close within the exposure time (got 0.025 s, allowed up to 0.02 s)");
  says(refused(kBar, {{"/sensor/shutter", R"({"transmission": [[0, 1], [0.9, 1]]})"}}),
       "a transmission must run from 0 to 1");
  says(refused(kBar, {{"/sensor/shutter", R"({"transmission": [[0, 1], [1, 1]], "rise_s": 0.001})"}}),
       "a shutter has either rise_s and fall_s, or transmission");
  says(refused(kBar, {{"/lights/0", R"({"sun": {"towards": [0, 0, 1]}, "emission": {"spectrum": 1},
                                        "motion": {"keyframes": [{"time_s": 0}]}})"}}),
       "a light at infinity cannot move");
  says(refused(kBar, {{"/sensor/channels", R"({"E": {"filters": [], "exposure_s": 0.01}})"}}),
       "in a scene with motion all channels must have the same exposure time (got 0.01 s of channel \"E\", "
       "allowed 0.02 "
       "s)");
}

}  // namespace
}  // namespace abbe
