#include <gtest/gtest.h>

#include <cmath>

#include "floor_scenes.h"
#include "meshes.h"
#include "scene/coincident_shapes.h"
#include "scene/shapes/shape.h"
#include "scene/working_range.h"
#include "spectral/sources.h"

namespace abbe::test {
namespace {

using Imath::V3d;

TEST(SceneFeatures, OfAPlainScene) {
  Scene scene = floor_scene();
  add_bulb(scene);
  scene.commit();
  const SceneFeatures& features = scene.features;
  EXPECT_TRUE(features.delta_lights);
  EXPECT_FALSE(features.dispersion || features.media || features.caustics || features.light_tracing ||
               features.environment || features.polarisation_relevant || features.depth_of_field);
  EXPECT_EQ(features.light_is_traced, std::vector<bool>{false});
  EXPECT_TRUE(unsampled_paths(scene, features, false).empty());
}

TEST(SceneFeatures, EachNamesWhatAsksForIt) {
  Scene scene = floor_scene();
  add_bulb(scene);
  add_lamp(scene, 0.01);
  add_ball(scene, kGlass);
  scene.materials[kGlass].model = DielectricMaterial{"ink", RefractiveIndex(1.5, 1e-6)};
  scene.camera.kind = ThinLens{{}, 0.05, INFINITY, 0.005};
  scene.commit();
  EXPECT_EQ(scene.features.reasons,
            (std::map<std::string, std::string>{{"media", "shape \"ball\""},
                                                {"caustics", "shape \"ball\""},
                                                {"polarisation_matters", "shape \"ball\""},
                                                {"light_tracing", "light \"bulb\""},
                                                {"delta_lights", "light \"bulb\""},
                                                {"depth_of_field", "camera"}}));
  for (const FeatureName& need : feature_names())
    EXPECT_EQ(scene.features.*need.member, scene.features.reasons.contains(need.key)) << need.key;
}

TEST(SceneFeatures, OfMatter) {
  Scene scene = floor_scene();
  add_ball(scene, kMirror);
  scene.commit();
  EXPECT_FALSE(scene.features.polarisation_relevant) << "one mirror ball reflects once";
  EXPECT_FALSE(scene.features.caustics) << "no light";

  scene.shapes.back().material = kGlass;
  scene.commit();
  EXPECT_TRUE(scene.features.polarisation_relevant) << "in and out";
  EXPECT_FALSE(scene.features.dispersion || scene.features.media);

  scene.materials[kGlass].model = DielectricMaterial{"ink", RefractiveIndex(1.5, 1e-6)};
  scene.commit();
  EXPECT_TRUE(scene.features.media);
  EXPECT_FALSE(scene.features.dispersion);

  const Curve n({{300, 1.6}, {1100, 1.5}});
  scene.materials[kGlass].model =
      DielectricMaterial{"flint", RefractiveIndex(n, Curve(0.0), IndexMedium::air, 300, 1100)};
  scene.commit();
  EXPECT_TRUE(scene.features.dispersion);
  EXPECT_FALSE(scene.features.media);

  scene.shapes.pop_back();
  scene.commit();
  EXPECT_FALSE(scene.features.dispersion) << "a material no shape is made of";
}

// Present for glass within the box of other glass or of metal, or coincident with it. Absent for separate
// glass, for separate metal, and for materials that look the same in any medium.
TEST(SceneFeatures, NestingOfWhatAnIndexTells) {
  const auto nests = [](std::uint32_t material, const Shape& shape, std::uint32_t of = kGlass) {
    Scene scene = floor_scene();
    add_ball(scene, of);
    scene.shapes.push_back({"other", shape, material});
    scene.commit();
    EXPECT_EQ(scene.features.reasons.contains("nesting"), scene.features.nesting);
    return scene.features.nesting;
  };
  const Sphere within{{0, 0, 1}, 0.1};
  EXPECT_TRUE(nests(kGlass, within));
  EXPECT_TRUE(nests(kMirror, within));
  EXPECT_TRUE(nests(kGlass, Sphere{{0, 0, 1}, 2}));
  EXPECT_TRUE(nests(kGlass, Quad{{0.5, -1, 0}, {0, 2, 0}, {0, 0, 2}})) << "touches";
  EXPECT_TRUE(nests(kGlass, within, kMirror));
  EXPECT_FALSE(nests(kDiffuse, within));
  EXPECT_FALSE(nests(kMirror, within, kMirror));
  for (const Imath::V3d& apart : {V3d(1.2, 0, 1), V3d(0, 1.2, 1), V3d(0, 0, 2.2), V3d(-1.2, 0, 1)})
    EXPECT_FALSE(nests(kGlass, Sphere{apart, 0.5})) << apart;
}

// Present for objects between two faces of a medium, whatever their placement and boxes. Absent for objects
// outside and for faces alone.
TEST(SceneFeatures, NestingWithinABodyOfFaces) {
  const Quad above{{-9, -9, 3}, {18, 0, 0}, {0, 18, 0}};
  const Quad below{{-9, -9, 1}, {0, 18, 0}, {18, 0, 0}};
  const auto nests = [&](const std::vector<std::pair<Shape, std::uint32_t>>& others, const Shape& top) {
    Scene scene = floor_scene();
    scene.shapes.push_back({"below", below, kGlass});
    for (const auto& [shape, material] : others) scene.shapes.push_back({"other", shape, material});
    scene.shapes.push_back({"above", top, kGlass});
    scene.materials.push_back(glass());
    scene.commit();
    return scene.features.nesting;
  };
  constexpr std::uint32_t kOtherGlass = 3;
  const Sphere within{{0, 0, 2}, 0.5};
  const Disc sheet{{0, 0, 2}, {0, 0, 1}, 1};
  const Sphere over{{0, 0, 4}, 0.5};
  const auto raised = std::make_shared<Placement>(placement(Imath::M44d().setTranslation(V3d(0, 0, 2))));
  const PlacedShape placed{make_prototype(Quad{{-9, -9, 1}, {18, 0, 0}, {0, 18, 0}}), raised};
  for (const Shape& top : {Shape(above), Shape(Disc{{0, 0, 3}, {0, 0, 1}, 9}), Shape(placed)}) {
    for (const std::uint32_t material : {kMirror, kGlass, kOtherGlass})
      EXPECT_TRUE(nests({{within, material}}, top)) << material;
    EXPECT_TRUE(nests({{sheet, kMirror}}, top));
    EXPECT_TRUE(nests({{sheet, kOtherGlass}}, top));
    EXPECT_FALSE(nests({}, top)) << "a bare slab";
    EXPECT_FALSE(nests({{within, kDiffuse}}, top)) << "looks the same in any matter";
    for (const std::uint32_t material : {kMirror, kGlass, kOtherGlass})
      EXPECT_FALSE(nests({{over, material}}, top)) << material;
  }
}

// Media with a face in an opaque surface, for all kinds and placements of shapes.
TEST(Contact, TellsSheetsThatAreLost) {
  const auto lost = [](const std::vector<std::pair<Shape, std::uint32_t>>& others) {
    Scene scene = floor_scene();
    const auto pane = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back({"pane", ThinGlassMaterial{"pane", RefractiveIndex(1.5)}});
    scene.shapes = {{"sheet", Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, pane}};
    for (const auto& [shape, material] : others) scene.shapes.push_back({"other", shape, material});
    scene.commit();
    return find_lost_surfaces(scene).has_value();
  };
  const Quad wall{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const Quad beside{{1, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  EXPECT_TRUE(lost({{wall, kDiffuse}}));
  EXPECT_TRUE(lost({{box({0.5, 0.5, 0}, {2, 2, 1}), kGlass}}));
  EXPECT_FALSE(lost({{box({0.5, 0.5, -1}, {2, 2, 0}), kGlass}, {box({0.5, 0.5, 0}, {2, 2, 1}), kGlass}}))
      << "in glass";
  EXPECT_TRUE(lost({{box({0.5, 0.5, -1}, {2, 2, 0}), kGlass}, {wall, kDiffuse}}));
  EXPECT_FALSE(lost({{beside, kDiffuse}})) << "in an opening of the wall";
  EXPECT_FALSE(lost({{box({1, 0, 0}, {2, 1, 1}), kGlass}})) << "edge to edge";
  EXPECT_FALSE(lost({{box({0.5, 0.5, 0.001}, {2, 2, 1}), kGlass}}));
}

TEST(SceneFeatures, NestingOfWhatStandsOnAWall) {
  const Imath::M44d turned = Imath::M44d().setAxisAngle(Imath::V3d(1, 2, 3).normalized(), 0.6);
  const auto placed = [](PlainShape shape, const Imath::M44d& at) {
    return PlacedShape{make_prototype(std::move(shape)), std::make_shared<Placement>(placement(at))};
  };
  const auto nests = [](const Shape& matter, const Shape& wall) {
    Scene scene = floor_scene();
    scene.shapes = {{"matter", matter, kGlass}, {"wall", wall, kDiffuse}};
    scene.commit();
    const bool found = scene.features.nesting;
    std::swap(scene.shapes[0], scene.shapes[1]);
    scene.commit();
    EXPECT_EQ(scene.features.nesting, found) << "in the other order";
    return found;
  };
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const Quad lower{{-3, -3, -1e-3}, {6, 0, 0}, {0, 6, 0}};
  EXPECT_TRUE(nests(block, table));
  EXPECT_TRUE(nests(block, Disc{{0.2, 0, 0}, {0, 0, 1}, 0.1}));
  EXPECT_TRUE(nests(block, box({-3, -3, -1}, {3, 3, 0})));
  EXPECT_TRUE(nests(block, box({-1, -1, 0}, {1, 1, 1})));
  EXPECT_TRUE(nests(placed(block, turned), placed(table, turned)));
  const Sphere ball{{0, 0, 1}, 1};
  EXPECT_TRUE(nests(ball, ball));
  EXPECT_TRUE(nests(ball, table));
  EXPECT_TRUE(nests(ball, block)) << "from within";
  EXPECT_TRUE(nests(placed(ball, turned), placed(table, turned)));
  EXPECT_TRUE(nests(placed(ball, Imath::M44d().setScale(Imath::V3d(3, 1, 1))), table));
  EXPECT_TRUE(nests(ball, Sphere{{0, 0, -2}, 2}));
  EXPECT_TRUE(nests(ball, Sphere{{0, 0, 2}, 2})) << "from within";
  EXPECT_FALSE(nests(ball, lower));
  EXPECT_FALSE(nests(Sphere{{3.1, 0, 1}, 1}, table)) << "over its edge";
  EXPECT_FALSE(nests(placed(ball, turned), table));
  EXPECT_FALSE(nests(ball, Sphere{{0, 0, -2.001}, 2}));
  EXPECT_FALSE(nests(ball, Sphere{{0, 0, 1}, 2})) << "within it";
  EXPECT_FALSE(nests(block, lower));
  EXPECT_FALSE(nests(block, Quad{{1.5, -3, 0}, {6, 0, 0}, {0, 6, 0}})) << "beside it";
  EXPECT_FALSE(nests(block, Quad{{-3, -3, 0.5}, {6, 0, 0}, {0, 6, 0}})) << "through it";
  EXPECT_FALSE(nests(placed(block, turned), placed(lower, turned)));
}

TEST(SceneFeatures, PolarisationMattersBetweenInterfaces) {
  const Quad pane{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}};
  Scene scene = floor_scene();
  scene.shapes.push_back({"pane", pane, kMirror});
  scene.commit();
  EXPECT_FALSE(scene.features.polarisation_relevant);
  scene.shapes.push_back({"pane 2", pane, kMirror});
  scene.commit();
  EXPECT_TRUE(scene.features.polarisation_relevant);
  scene.materials[kMirror].model = MirrorMaterial{Curve(0.9)};
  scene.commit();
  EXPECT_FALSE(scene.features.polarisation_relevant) << "ideal mirrors";
  Scene prism = floor_scene();
  prism.shapes.push_back({"prism", make_prism(60, 1, 1), kGlass});
  prism.commit();
  EXPECT_TRUE(prism.features.polarisation_relevant);
}

TEST(SceneFeatures, SmallLightsAreTraced) {
  Scene scene = floor_scene();
  add_bulb(scene);
  add_lamp(scene, 0.1);
  add_lamp(scene, 2);
  add_sky(scene);
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_TRUE(scene.features.caustics && scene.features.light_tracing && scene.features.environment);
  EXPECT_EQ(scene.features.light_is_traced, (std::vector<bool>{true, true, false, false}));

  scene.lights[0].emission = Curve();
  scene.commit();
  EXPECT_FALSE(scene.features.light_is_traced[0]) << "a lamp that is off";

  scene.camera.kind = IrradianceProbe{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  scene.commit();
  EXPECT_EQ(scene.features.light_is_traced, (std::vector<bool>{false, true, false, false}));
  scene.camera.kind = IrradianceProbe{ProbePoint{}};
  scene.commit();
  EXPECT_TRUE(scene.features.caustics);
  EXPECT_FALSE(scene.features.light_tracing) << "nothing to connect to, nor to run into";
  EXPECT_EQ(scene.features.light_is_traced, (std::vector<bool>(4, false)));
}

TEST(SceneFeatures, LargeAndInfiniteLightsStayWithPathTracing) {
  Scene scene = floor_scene();
  add_lamp(scene, 2);
  add_sky(scene);
  add_ball(scene, kGlass);
  scene.commit();
  EXPECT_TRUE(scene.features.caustics);
  EXPECT_FALSE(scene.features.light_tracing);
  EXPECT_TRUE(unsampled_paths(scene, scene.features, false).empty());

  Scene sky = floor_scene();
  add_sky(sky);
  add_ball(sky, kGlass);
  sky.commit();
  EXPECT_FALSE(sky.features.caustics);
}

TEST(SceneFeatures, CausticsFallOnSomething) {
  Scene scene = floor_scene();
  scene.shapes.clear();
  add_bulb(scene);
  add_ball(scene, kMirror);
  scene.commit();
  EXPECT_FALSE(scene.features.caustics);
  EXPECT_EQ(unreached_expressions(scene, false), Expressions{"E S+ L"});
  scene.camera.kind = IrradianceProbe{SphereSide{}};
  scene.commit();
  EXPECT_FALSE(scene.features.caustics);
  EXPECT_TRUE(scene.features.light_tracing) << "photons run into it";
}

TEST(SceneFeatures, DepthOfField) {
  Scene scene = floor_scene();
  scene.camera.kind = ThinLens{{}, 0.05, INFINITY, 0.005};
  scene.commit();
  EXPECT_TRUE(scene.features.depth_of_field);
}

TEST(SceneFeatures, SunsAndBeamsAreTracedUnlessTheyLookLarge) {
  Scene scene = floor_scene();
  add_ball(scene, kGlass);
  scene.lights.push_back({"beam", DirectionalLight{}, Curve(1.0)});
  scene.lights.push_back({"sun", SunLight{{0, 0, 1}, 1e-5F}, Curve(1.0)});
  scene.lights.push_back({"moon of a gas giant", SunLight{{0, 0, 1}, 0.02F}, Curve(1.0)});
  scene.commit();
  EXPECT_EQ(scene.features.light_is_traced, (std::vector<bool>{true, true, false}));
  EXPECT_TRUE(scene.features.delta_lights && scene.features.light_tracing && !scene.features.environment);
  EXPECT_EQ(scene.background().size(), 2U) << "no ray meets a beam";
  const std::string seen = "E S (S|D)* D (S|D)* S L";
  const std::string caustic = "E (S|D)* D (S|D)* S L";
  EXPECT_EQ(unreached_expressions(scene, true), (Expressions{"E S+ L", seen, seen}));
  EXPECT_EQ(unreached_expressions(scene, false), (Expressions{"E S+ L", caustic, caustic}));
  EXPECT_EQ(unsampled_paths(scene, scene.features, true).back(),
            seen +
                ": caustics of a tiny light, seen in mirrors or through glass, that no pilot photon found "
                "(\"sun\")");
  scene.render.integrator = Integrator::light;
  EXPECT_EQ(unreached_expressions(scene, true), (Expressions{"E L", "E S (S|D)* L"}));
}

// A light as distant as the sun, or the ground below, does not move the origin of the scene.
TEST(WorkingRange, WhatIsNearDecides) {
  const auto near_of = [](std::vector<Shape> shapes) {
    const Scene scene = scene_of(std::move(shapes));
    return std::pair(working_range_of(scene.camera, scene.shapes).near, scene.bounds);
  };
  const Sphere ball{{0, 0, 5}, 1};
  const auto [alone, bounds] = near_of({ball});
  EXPECT_EQ(near_of({ball, Sphere{{0, 1.5e11, 0}, 7e8}}), std::pair(alone, bounds)) << "far";
  const auto [over_ground, with_ground] = near_of({ball, Sphere{{0, -6.4e6, 0}, 6.4e6}});
  EXPECT_EQ(over_ground, alone) << "large";
  EXPECT_NE(with_ground, bounds) << "but not far";
  EXPECT_EQ(near_of({ball, Sphere{{0, 0, 900}, 1}}).first.max.z, 901) << "no gap";
  const Sphere distant{{0, 0, 1e5}, 1};
  EXPECT_EQ(near_of({distant}).first, abbe::bounds(Shape(distant))) << "what a lens sees first";
  Scene meter = scene_of({distant});
  meter.camera.kind = IrradianceProbe{};
  EXPECT_TRUE(working_range_of(meter.camera, meter.shapes).near.isEmpty()) << "a meter is lit where it is";
}

TEST(SceneFeatures, EveryLampIsHeldAgainstEverySpecularShape) {
  Scene scene = floor_scene();
  Random random(31);
  for (int i = 0; i < 400; ++i)
    scene.shapes.push_back({"ball", Sphere{random.in_cube(3), random.between(0.001, 0.02)}, kGlass});
  for (int i = 0; i < 400; ++i) {
    scene.lights.push_back({"lamp", AreaLight{static_cast<std::uint32_t>(scene.shapes.size())}, Curve(1.0)});
    scene.shapes.push_back({"lamp", Sphere{random.in_cube(3), std::pow(10.0, random.between(-3, 0))},
                            i % 2 == 0 ? kGlass : kDiffuse});
  }
  scene.commit();
  int small = 0;
  int lamps_in_glass = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::size_t own = std::get<AreaLight>(scene.lights[i].kind).shape;
    const Imath::Box3d box = bounds(scene.shapes[own].shape);
    bool looks_small = true;
    bool in_glass = false;  // which depends on what it illuminates
    for (std::size_t j = 0; j < scene.shapes.size(); ++j) {
      if (j == own || scene.shapes[j].material != kGlass) continue;
      // The cone around the sphere around the light's box, compared with 0.05 sr.
      const double radius = box.size().length() / 2;
      const double distance = (bounds(scene.shapes[j].shape).center() - box.center()).length();
      in_glass = in_glass || distance < std::get<Sphere>(scene.shapes[j].shape).radius;
      const double sine = std::min(1.0, radius / distance);
      looks_small = looks_small && 2 * std::numbers::pi * (1 - std::sqrt(1 - sine * sine)) < 0.05;
    }
    EXPECT_TRUE(in_glass || scene.features.light_is_traced[i] == looks_small) << i;
    lamps_in_glass += in_glass;
    small += looks_small;
  }
  EXPECT_GT(small, 50);
  EXPECT_LT(small, 350);
  EXPECT_LT(lamps_in_glass, 50);
}

}  // namespace
}  // namespace abbe::test
