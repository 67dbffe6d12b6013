#include "scene/small_light.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "floor_scenes.h"
#include "meshes.h"
#include "scene/shapes/shape.h"

namespace abbe::test {
namespace {

using Imath::V3d;

const Expressions kCausticsSeen{"E S (S|D)* D (S|D)* S L"};

// An emitting ball 3 m above the center of the floor.
Scene scene_with_ball_lamp(double radius, std::uint32_t material) {
  Scene scene = floor_scene();
  scene.lights.push_back({"lamp", AreaLight{static_cast<std::uint32_t>(scene.shapes.size())}, Curve(1.0)});
  scene.shapes.push_back({"lamp", Sphere{{0, 0, 3}, radius}, material});
  return scene;
}

bool traced(Scene& scene) {
  scene.commit();
  return scene.features.light_is_traced.front();
}

// Glass around a light at (0, 0, 3), in each kind of shape that can enclose it, at most 0.1 m away.
std::vector<std::pair<std::string, Shape>> globes() {
  const Imath::M44d turned =
      Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.6) * Imath::M44d().setTranslation(V3d(0, 0, 3));
  auto moving = std::make_shared<Placement>(placement(turned));
  moving->motion = std::make_shared<Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 0, 0}, 0, {0, 0, 0}}, {1, {}, 0, {0, 0, 0.03}}});
  const auto cube = make_prototype(box(V3d(-0.05), V3d(0.05)));
  const Sphere ball{{0, 0, 3}, 0.06};
  return {{"ball", ball},
          {"ball off its middle", Sphere{{0.01, 0, 3}, 0.06}},
          {"mesh", box({-0.05, -0.05, 2.95}, {0.05, 0.05, 3.05})},
          {"instance", PlacedShape{cube, std::make_shared<Placement>(placement(turned))}},
          {"moving", PlacedShape{cube, moving}}};
}

TEST(SmallLight, GlassAroundALampIsAsFarAsItsSurface) {
  for (const auto& [name, globe] : globes()) {
    Scene scene = scene_with_ball_lamp(0.001, kDiffuse);
    scene.shapes.push_back({name, globe, kGlass});
    EXPECT_TRUE(traced(scene)) << name;
    EXPECT_EQ(unreached_expressions(scene, true), kCausticsSeen) << name << ": tiny from the floor";
    scene.shapes.push_back({"dust", Sphere{{0, 0, 3.03}, 0.001}, kDiffuse});
    EXPECT_TRUE(traced(scene)) << name << ": small from the globe, whatever else is near";
  }
}

TEST(SmallLight, LampsInGlassAreLookedAtFromWhatTheyLight) {
  for (const auto& [name, globe] : globes()) {
    Scene scene = scene_with_ball_lamp(0.04, kDiffuse);
    scene.shapes.push_back({name, globe, kGlass});
    EXPECT_TRUE(traced(scene)) << name;
    EXPECT_TRUE(unreached_expressions(scene, true).empty()) << name;
    scene.shapes.push_back({"table", Quad{{-1, -1, 2.9}, {2, 0, 0}, {0, 2, 0}}, kDiffuse});
    EXPECT_FALSE(traced(scene)) << name;
  }
  Scene scene = scene_with_ball_lamp(0.04, kDiffuse);
  scene.shapes.push_back({"globe", globes().front().second, kGlass});
  scene.shapes.front().shape = inside_out(box(V3d(-3, -3, 0), V3d(3, 3, 6)));
  EXPECT_TRUE(traced(scene)) << "in the middle of a room";
}

TEST(SmallLight, LanternsAreLookedAtWhereTheyAreAtFirst) {
  auto carried = std::make_shared<Placement>(placement(Imath::M44d().setTranslation(V3d(0, 0, 3))));
  carried->motion =
      std::make_shared<Motion>(std::vector<Motion::Keyframe>{{0, {}, 0, {0, 0, 0}}, {1, {}, 0, {0.5, 0, 0}}});
  Scene scene = scene_with_ball_lamp(0.04, kDiffuse);
  scene.shapes.back().shape = PlacedShape{make_prototype(Sphere{{0, 0, 0}, 0.04}), carried};
  scene.shapes.push_back({"globe", PlacedShape{make_prototype(Sphere{{0, 0, 0}, 0.06}), carried}, kGlass});
  EXPECT_TRUE(traced(scene));
}

// Lights are viewed from the center of a sheet next to them. Boxes around tilted sheets contain lights next
// to them.
TEST(SmallLight, SheetsStandBesideLamps) {
  for (const Shape& sheet : {Shape(Quad{{-1, -1, 1.9}, {2, 0, 2}, {0, 2, 0}}),
                             Shape(Disc{{0, 0, 2.9}, V3d(1, 2, 3).normalized(), 2})}) {
    Scene scene = scene_with_ball_lamp(0.04, kDiffuse);
    scene.shapes.push_back({"sheet", sheet, kMirror});
    EXPECT_TRUE(bounds(sheet).intersects(V3d(0, 0, 3)));
    EXPECT_FALSE(traced(scene));
    EXPECT_TRUE(unreached_expressions(scene, true).empty());
  }
}

TEST(SmallLight, TheOnlySpecularShapeIsLookedAtFromWhatItLights) {
  for (const std::uint32_t material : {kGlass, kMirror}) {
    Scene scene = scene_with_ball_lamp(0.5, material);
    EXPECT_FALSE(traced(scene));
    EXPECT_TRUE(unreached_expressions(scene, false).empty());
    scene = scene_with_ball_lamp(0.1, material);
    EXPECT_TRUE(traced(scene)) << "what shines through its own glass";
    EXPECT_TRUE(unreached_expressions(scene, false).empty());
    scene = scene_with_ball_lamp(0.001, material);
    EXPECT_TRUE(traced(scene));
    EXPECT_EQ(unreached_expressions(scene, true), kCausticsSeen);
  }
  Scene scene = scene_with_ball_lamp(0.5, kDiffuse);
  EXPECT_FALSE(traced(scene)) << "nothing is specular";
  add_bulb(scene);
  scene.shapes.back().material = kGlass;
  scene.commit();
  EXPECT_EQ(scene.features.light_is_traced, (std::vector<bool>{false, true}))
      << "points are small from anywhere";
}

}  // namespace
}  // namespace abbe::test
