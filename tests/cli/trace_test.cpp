#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/query.h"
#include "cli/rays.h"
#include "tests/angles.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/scene/meshes.h"

namespace abbe::test {
namespace {

constexpr double kC = 656.2725;
constexpr double kD = 587.5618;
constexpr double kF = 486.1327;

json trace(const std::string& scene, double nm, const Imath::V3d& origin, const Imath::V3d& direction,
           int max_events = 64) {
  return json_output(
      cli::trace, cli::TraceOptions{scratch().write("scene.json", scene), nm, origin, direction, max_events});
}

// A ray to the centre of the left face of the prism, at an angle of incidence below its normal.
json through_prism(double nm, double incidence_deg) {
  const double elevation = (incidence_deg - 30) * kDegree;
  const Imath::V3d dir(std::cos(elevation), 0, std::sin(elevation));
  return trace(prism_scene(), nm, Imath::V3d(-7.5, 1.25, 4.330127018922193) - 100.0 * dir, dir);
}

TEST(TracePrism, MinimumDeviationOfTheSpectralLines) {
  const std::array<std::pair<double, double>, 5> lines{
      {{kC, 38.42914}, {kD, 38.64670}, {kF, 39.13811}, {435.8343, 39.51948}, {404.6561, 39.83534}}};
  for (const auto& [nm, deviation] : lines) {
    const json found = through_prism(nm, (60 + deviation) / 2);
    ASSERT_EQ(found["events"].size(), 3U);
    EXPECT_EQ(found["events"][0]["kind"], "refract");
    EXPECT_EQ(found["events"][1]["kind"], "refract");
    EXPECT_EQ(found["events"][2]["kind"], "escape");
    EXPECT_NEAR(found["deviation_deg"].get<double>(), deviation, 1e-5) << nm;
  }
}

TEST(TracePrism, EventsCarryTheContractsKeys) {
  const json first = through_prism(kD, 50)["events"][0];
  EXPECT_EQ(first["shape"], "prism");
  EXPECT_NEAR(first["point"][0].get<double>(), -7.5, 1e-9);
  EXPECT_NEAR(first["point"][1].get<double>(), 1.25, 1e-9);
  EXPECT_NEAR(first["point"][2].get<double>(), 4.330127018922193, 1e-9);
  EXPECT_NEAR(first["normal"][0].get<double>(), -std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(first["normal"][2].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(first["n_from"], 1);
  EXPECT_NEAR(first["n_to"].get<double>(), 1.5168, 5e-7);
  EXPECT_NEAR(first["angle_in_deg"].get<double>(), 50, 1e-9);
  EXPECT_NEAR(first["angle_out_deg"].get<double>(),
              std::asin(std::sin(50 * kDegree) / first["n_to"].get<double>()) / kDegree, 1e-9);
}

TEST(TraceMirror, ReflectsAndNamesTheMetal) {
  const json found = trace(
      scene_text(
          R"("gold": {"conductor": {"ior": "Au_Johnson"}})",
          R"({"name": "mirror", "quad": {"corner": [-5,-5,0], "edge_u": [10,0,0], "edge_v": [0,10,0]}, "material": "gold"})"),
      550, {-1, 0, 1}, {1, 0, -1});
  const json event = found["events"][0];
  EXPECT_EQ(event["kind"], "reflect");
  EXPECT_NEAR(event["angle_in_deg"].get<double>(), 45, 1e-9);
  EXPECT_NEAR(event["angle_out_deg"].get<double>(), 45, 1e-9);
  EXPECT_NEAR(found["deviation_deg"].get<double>(), 90, 1e-9);
  const json asked = json_output(cli::query_reflectance, {"Au_Johnson", {550}, {45}});
  EXPECT_NEAR(event["Rs"].get<double>(), asked["Rs"].get<double>(), 1e-12);
  EXPECT_NEAR(event["Rp"].get<double>(), asked["Rp"].get<double>(), 1e-12);
  EXPECT_NEAR(found["final_dir"][2].get<double>(), std::sqrt(0.5), 1e-12);
}

// Sheets and mirrors whose light does not depend on the surrounding glass also report its index.
TEST(TraceSheet, TellsTheIndexOfTheMatterThatItStandsIn) {
  for (const char* sheet : {R"({"polariser": {}})", R"({"mirror": {"reflectance": 0.9}})"}) {
    const std::string scene =
        scene_text(R"("g": {"dielectric": {"ior": 1.5}}, "m": )" + std::string(sheet),
                   R"({"name": "ball", "sphere": {"center": [0,0,0], "radius": 1}, "material": "g"},
           {"name": "sheet", "quad": {"corner": [0,-0.3,-0.3], "edge_u": [0,0,0.6], "edge_v": [0,0.6,0]}, "material": "m"})");
    for (const double from : {-5.0, -0.5}) {
      const json events = trace(scene, 550, {from, 0, 0}, {1, 0, 0})["events"];
      const json& met = events[from < -1 ? 1 : 0];
      ASSERT_EQ(met["shape"], "sheet") << sheet;
      EXPECT_EQ(met["n_from"], 1.5) << sheet << " from " << from;
      EXPECT_EQ(met.value("n_to", 1.5), 1.5) << sheet << " from " << from;
    }
    EXPECT_EQ(trace(scene, 550, {0, 0, 5}, {0, 0, -1})["events"][0]["n_from"], 1);
  }
}

constexpr const char* kTintedMatter = R"("water": {"dielectric": {"ior": 1.33, "absorption_per_m": 0.5}},
  "fog": {"medium": {"absorption_per_m": 0.5}}, "haze": {"medium": {"absorption_per_m": 0.2}},
  "mirror": {"mirror": {"reflectance": 1}}, "card": {"diffuse": {"reflectance": 0.8}}, "sheet": {"polariser": {}})";

// Power that remains of a ray along x from `x` metres.
double left_along_x(const std::string& shapes, double x = -10) {
  const std::string scene = scene_text(kTintedMatter, shapes, "m");
  return trace(scene, 550, {x, 0, 0}, {1, 0, 0})["stokes"][0].get<double>();
}
std::string tinted(const std::string& material, const std::string& kind, const std::string& shape) {
  return fmt::format(R"({{"material": "{}", "{}": {}}})", material, kind, shape);
}
std::string tinted_ball(const std::string& material, double radius) {
  return tinted(material, "sphere", fmt::format(R"({{"center": [0, 0, 0], "radius": {}}})", radius));
}

// The medium absorbs by Beer's law along each segment, however the segment ends.
TEST(TraceMatter, TakesItsShareBeforeWhatStandsInIt) {
  const double face = 4 * 1.33 / (2.33 * 2.33);
  const std::string water = tinted_ball("water", 3);
  const std::string fog = tinted_ball("fog", 3);
  const std::string sheet =
      tinted("sheet", "quad", R"({"corner": [0, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2]})");
  EXPECT_NEAR(left_along_x(fog + "," + tinted_ball("mirror", 1)), std::exp(-2), 1e-12);
  EXPECT_NEAR(left_along_x(fog + "," + tinted_ball("mirror", 1), -2), std::exp(-1.5), 1e-12) << "from within";
  EXPECT_NEAR(left_along_x(fog + "," + tinted_ball("haze", 1)), std::exp(-2.4), 1e-12);
  EXPECT_NEAR(left_along_x(fog + "," + tinted_ball("card", 1)), std::exp(-1), 1e-12);
  EXPECT_NEAR(left_along_x(water + "," + tinted_ball("card", 1)), face * std::exp(-1), 1e-9);
  EXPECT_NEAR(left_along_x(water + "," + sheet), face * face * std::exp(-3) / 2, 1e-9);
  EXPECT_NEAR(left_along_x(water, -3), face * std::exp(-3), 1e-9) << "from its surface";
}

// The order of the boxes in the scene does not matter.
TEST(TraceMatter, EndsWhereOtherMatterBegins) {
  const auto box = [](const std::string& material, double from, double to) {
    return tinted(material, "mesh", inline_mesh(test::box({from, -1, -1}, {to, 1.5, 1.7})));
  };
  const std::string fog = box("fog", -1, 0);
  const std::string haze = box("haze", 0, 1);
  for (const std::string& shapes : {fog + "," + haze, haze + "," + fog})
    EXPECT_NEAR(left_along_x(shapes), std::exp(-0.7), 1e-12) << shapes;
}

TEST(TraceDiffuse, EndsWithAHit) {
  const json found = trace(ball_scene(), 550, {0, -300, 0}, {0, 2, 0});
  ASSERT_EQ(found["events"].size(), 1U);
  EXPECT_EQ(found["events"][0]["kind"], "hit");
  EXPECT_NEAR(found["final_origin"][1].get<double>(), -50, 1e-9);
  EXPECT_EQ(found["deviation_deg"], 0);
}

TEST(TraceFaults, RaysNeedADirectionAndAScene) {
  const auto ball = scratch().write("scene.json", ball_scene());
  EXPECT_EQ(fault(
                [&] {
                  cli::trace({ball, 550, Imath::V3d(0, 0, 0), Imath::V3d(0, 0, 0)});
                },
                "--dir"),
            ErrorCode::usage);
  EXPECT_EQ(fault(
                [] {
                  cli::trace({"/nowhere/scene.json", 550, Imath::V3d(0, 0, 0), Imath::V3d(0, 0, 1)});
                },
                "/nowhere"),
            ErrorCode::input);
}

TEST(TraceFaults, EndlessRaysStopWithAWarning) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(trace(prism_scene(), 550, {-100, 0, 0}, {1, 0, 0}, 1)["events"].size(), 1U);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("stopped after 1 events"), std::string::npos);
}

}  // namespace
}  // namespace abbe::test
