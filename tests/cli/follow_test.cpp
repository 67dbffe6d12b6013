#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cli/rays.h"
#include "materials/interface/fresnel.h"
#include "tests/angles.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "transport/path/ray_trace.h"

namespace abbe::test {
namespace {

using Imath::V3d;
constexpr double kNm = 550;

// A ray that hits a slab of 10 mm across x at 45 degrees, and all its branches.
RayTree through_slab(double k) {
  constexpr double kThickness = 0.01;
  Scene scene{};
  scene.materials.push_back({"glass", DielectricMaterial{"constant", RefractiveIndex(1.5, k)}});
  scene.shapes.push_back({"front", Quad{{0, -1, -1}, {0, 0, 2}, {0, 2, 0}}, 0});
  scene.shapes.push_back({"back", Quad{{kThickness, -1, -1}, {0, 2, 0}, {0, 0, 2}}, 0});
  scene.commit();
  const V3d direction = V3d(1, 0, 1).normalized();
  return follow_ray(scene, {-0.01 * direction, direction}, kNm, Follow::both, {.min_power_fraction = 1e-14});
}

double escaped(const RayTree& tree, double side) {
  double sum = 0;
  for (const RayBranch& branch : tree.branches)
    if (branch.trace.last.direction.x * side > 0) sum += branch.trace.events.back().power_fraction;
  return sum;
}

FresnelPower<double> face() {
  return fresnel_dielectric(std::sqrt(0.5), 1.5);
}

TEST(Follow, TheBranchesOfASlabAddUp) {
  const RayTree tree = through_slab(0);
  // The s and p components are followed separately.
  const auto passed = [](double R) { return (1 - R) / (1 + R); };
  const double expected = (passed(face().Rs) + passed(face().Rp)) / 2;
  EXPECT_NEAR(escaped(tree, 1), expected, 1e-9);
  EXPECT_NEAR(escaped(tree, -1), 1 - expected, 1e-9);
  EXPECT_NEAR(escaped(tree, 1) + escaped(tree, -1) + tree.truncated_power, 1, 1e-12);
  for (const RayBranch& branch : tree.branches)
    for (const TraceEvent& event : branch.trace.events)
      if (event.passage) {
        EXPECT_NEAR(event.R + event.T, 1, 1e-12);
      }
}

TEST(Follow, TintedMatterTakesItsShareByBeersLaw) {
  constexpr double kExtinction = 1e-6;
  const double a = std::exp(-4 * std::numbers::pi * kExtinction / (kNm * 1e-9) * 0.01 / face().cos_t);
  const auto passed = [a](double R) { return (1 - R) * (1 - R) * a / (1 - R * R * a * a); };
  EXPECT_NEAR(escaped(through_slab(kExtinction), 1), (passed(face().Rs) + passed(face().Rp)) / 2, 1e-9);
}

json followed(const std::string& scene, Follow follow, const V3d& origin, const V3d& direction) {
  cli::TraceOptions options{scratch().write("follow.json", scene), kNm, origin, direction};
  options.follow = follow;
  return json_output(cli::trace, options);
}

TEST(Follow, APrismReflectsByTheLawAndWithin) {
  const double elevation = 20 * kDegree;
  const V3d direction(std::cos(elevation), 0, std::sin(elevation));
  const V3d origin = V3d(-7.5, 1.25, 4.330127018922193) - 100.0 * direction;
  const json plain = followed(prism_scene(), Follow::refraction, origin, direction);
  EXPECT_FALSE(plain.contains("branches"));
  const json tree = followed(prism_scene(), Follow::both, origin, direction);
  EXPECT_EQ(tree["events"].size(), plain["events"].size());
  EXPECT_EQ(tree["final_dir"], plain["final_dir"]);
  bool within = false;
  for (const json& branch : tree["branches"]) {
    if (branch["from_branch"] != 0) continue;
    if (branch["from_event"] == 0) {
      EXPECT_NEAR(branch["deviation_deg"].get<double>(), 180 - 2 * 50, 1e-9);
    }
    if (branch["from_event"] != 1) continue;
    within = true;  // the base is hit at the angle after refraction at the first face
    EXPECT_NEAR(branch["events"][0]["angle_in_deg"].get<double>(),
                tree["events"][0]["angle_out_deg"].get<double>(), 1e-9);
  }
  EXPECT_TRUE(within);
  const json first = followed(prism_scene(), Follow::reflection, origin, direction);
  EXPECT_EQ(first["events"][0]["kind"], "reflect");
  EXPECT_NEAR(first["deviation_deg"].get<double>(), 80, 1e-9);
}

TEST(Follow, ACornerOfMirrorsSendsLightBack) {
  const json found = followed(
      scene_text(
          R"("mirror": {"mirror": {"reflectance": 0.9}})",
          R"({"name": "x", "quad": {"corner": [0,0,0], "edge_u": [0,9,0], "edge_v": [0,0,9]}, "material": "mirror"},
             {"name": "y", "quad": {"corner": [0,0,0], "edge_u": [9,0,0], "edge_v": [0,0,9]}, "material": "mirror"},
             {"name": "z", "quad": {"corner": [0,0,0], "edge_u": [9,0,0], "edge_v": [0,9,0]}, "material": "mirror"})"),
      Follow::both, {4, 5, 6}, {-3, -4, -5});
  ASSERT_EQ(found["events"].size(), 4U);
  EXPECT_NEAR(found["deviation_deg"].get<double>(), 180, 1e-9);
  EXPECT_NEAR(found["events"][3]["share"].get<double>(), 0.9 * 0.9 * 0.9, 1e-12);
}

TEST(Follow, PanesPassAndPaintEndsButForItsCoat) {
  const auto at_45 = [](const std::string& material) {
    return followed(
        scene_text(
            "\"m\": " + material,
            R"({"name": "m", "quad": {"corner": [-5,-5,0], "edge_u": [10,0,0], "edge_v": [0,10,0]}, "material": "m"})"),
        Follow::both, {-1, 0, 1}, {1, 0, -1});
  };
  const json pane = at_45(R"({"thin_glass": {"ior": 1.5, "thickness": 1}})");
  const auto [Rs, Rp, Ts, Tp, cos_t] = face();
  EXPECT_EQ(pane["events"][0]["kind"], "refract");
  EXPECT_NEAR(pane["events"][0]["T"].get<double>(), ((1 - Rs) / (1 + Rs) + (1 - Rp) / (1 + Rp)) / 2, 1e-12);
  EXPECT_NEAR(pane["deviation_deg"].get<double>(), 0, 1e-9);
  const json paint = at_45(R"({"coated_diffuse": {"ior": 1.5, "reflectance": 0.5}})");
  ASSERT_EQ(paint["events"].size(), 1U);
  EXPECT_EQ(paint["events"][0]["kind"], "hit");
  ASSERT_EQ(paint["branches"].size(), 1U);
  EXPECT_NEAR(paint["branches"][0]["share"].get<double>(), face().R(), 1e-12);
}

}  // namespace
}  // namespace abbe::test
