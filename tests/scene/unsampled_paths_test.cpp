#include <gtest/gtest.h>

#include <fmt/format.h>

#include "floor_scenes.h"

namespace abbe::test {
namespace {

TEST(Unreached, PhotonsAloneDoNotRunIntoAPoint) {
  Scene scene{};
  scene.camera = {IrradianceProbe{ProbePoint{}}, 1, 1, 0.01};
  scene.lights.push_back({"lamp", PointLight{{0, 0, 2}}, Curve(1.0)});
  for (const Integrator by : {Integrator::light, Integrator::photon_brute}) {
    scene.render.integrator = by;
    scene.camera.kind = IrradianceProbe{ProbePoint{}};
    scene.commit();
    EXPECT_EQ(unreached_expressions(scene, true), Expressions{"E (S|D)* L"});
    for (const IrradianceProbe& meter : {IrradianceProbe{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                         IrradianceProbe{SphereSide{{{0, 0, 0}, 1}}}}) {
      scene.camera.kind = meter;
      scene.commit();
      EXPECT_TRUE(unsampled_paths(scene, scene.features, true).empty());
    }
  }
}

TEST(Unreached, PhotonsOfTracedLightsReachMeters) {
  Scene scene = floor_scene();
  add_bulb(scene);
  scene.lights.push_back({"sun", SunLight{{0, 0, 1}, 1e-5F}, Curve(1.0)});
  add_ball(scene, kGlass);
  scene.camera.kind = IrradianceProbe{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  scene.commit();
  const std::string caustic = "E (S|D)* D (S|D)* S L";
  EXPECT_EQ(unreached_expressions(scene, true), Expressions{caustic}) << "of the sun, by pilots alone";
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E S+ L", "E S+ L", caustic, caustic}));
  scene.render.integrator = Integrator::bdpt;
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E S+ (D S+)* L", "E S+ L"}));
}

TEST(Unreached, ClassesOfADeltaLight) {
  Scene scene = floor_scene();
  add_bulb(scene);
  add_lamp(scene, 0.1);
  add_sky(scene);
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_EQ(unreached_expressions(scene, true), (Expressions{"E S+ L", "E S (S|D)* D (S|D)* S L"}));
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E S+ L", "E (S|D)* D (S|D)* S L"}));
  const auto classes = unsampled_paths(scene, scene.features, false);
  EXPECT_EQ(classes[0],
            "E S+ L: a point, spot or directional light seen in mirrors or through glass (\"bulb\")");
}

// Paths without light sampling never hit delta lights, with or without specular materials.
TEST(Unreached, ADeltaLightWithoutConnections) {
  Scene scene = floor_scene();
  add_bulb(scene);
  add_lamp(scene, 0.1);
  scene.commit();
  scene.render.integrator = Integrator::path;
  EXPECT_TRUE(unsampled_paths(scene, scene.features, false).empty());
  scene.render.sampling.lights = LightStrategy::bsdf;
  EXPECT_EQ(unsampled_paths(scene, scene.features, false),
            (std::vector<PathClass>{
                "E (S|D)+ L: a point, spot or directional light, which no path can hit (\"bulb\")"}));
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E (S|D)+ L"}));
  scene.render.sampling.lights = LightStrategy::light;
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E S+ L", "E (S|D)* D (S|D)* S L"}));
}

TEST(Unreached, ClassesOfTheLightTracerAlone) {
  Scene scene = floor_scene();
  scene.render.integrator = Integrator::light;
  add_bulb(scene);
  scene.commit();
  EXPECT_TRUE(unsampled_paths(scene, scene.features, true).empty());
  add_lamp(scene, 0.1);
  add_sky(scene);
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_EQ(unreached_expressions(scene, true), (Expressions{"E (S|D)* L", "E L", "E S (S|D)* L"}));
}

TEST(Unreached, ClassesOfBidirectionalPathTracing) {
  Scene scene = floor_scene();
  scene.render.integrator = Integrator::bdpt;
  add_bulb(scene);
  scene.commit();
  EXPECT_TRUE(unsampled_paths(scene, scene.features, false).empty()) << "nothing is specular";
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_EQ(unreached_expressions(scene, false), Expressions{"E S+ (D S+)* L"});
  scene.lights.clear();
  add_lamp(scene, 0.1);
  add_sky(scene);
  scene.commit();
  EXPECT_TRUE(unsampled_paths(scene, scene.features, false).empty()) << "both have area";
}

TEST(Unreached, NamesTheFirstOfManyLights) {
  Scene scene = floor_scene();
  scene.shapes.push_back({"pane", Quad{{-5, -5, 1}, {10, 0, 0}, {0, 10, 0}}, kGlass});
  for (int i = 0; i < 20; ++i) scene.lights.push_back({fmt::format("l{}", i), PointLight{}, Curve(1.0)});
  scene.commit();
  const std::vector<PathClass> classes = unsampled_paths(scene, scene.features, true);
  ASSERT_FALSE(classes.empty());
  EXPECT_NE(classes[0].find("\"l7\" and 12 more"), std::string::npos) << classes[0];
}

}  // namespace
}  // namespace abbe::test
