#include <gtest/gtest.h>

#include "scene/shapes/shape.h"
#include "scenes.h"

namespace abbe {
namespace {

const Quad kPane{{-1, -1, 2}, {0, 2, 0}, {2, 0, 0}};
const Quad kBehind{{-1, -1, 3}, {0, 2, 0}, {2, 0, 0}};
const Sphere kBall{{0, 0, 3}, 1};

Material rough_gold() {
  return {"gold", RoughConductorMaterial("gold", RefractiveIndex(0.2, 3.0),
                                         Microfacets<float>{FacetShape::ggx, 0.3F, 0.3F})};
}

bool matters(const std::vector<Material>& materials, const std::vector<ShapeInstance>& shapes) {
  Scene scene{};
  scene.camera = test::pinhole();
  scene.materials = materials;
  scene.channels.push_back(energy_channel("Y", Curve(1.0)));
  scene.shapes = shapes;
  scene.commit();
  return scene.features.polarisation_relevant;
}

// A single event polarises unpolarised light, which a sensor does not detect; a second event is necessary.
TEST(PolarisationCause, TakesTwoEventsInARow) {
  const Material white{"white", DiffuseMaterial{Curve(0.5)}};
  const Material mirror{"mirror", MirrorMaterial{Curve(0.9)}};
  for (const Material& material : {test::glass(), test::mirror(), rough_gold()}) {
    EXPECT_FALSE(matters({material}, {{"pane", kPane, 0}}));
    EXPECT_TRUE(matters({material}, {{"pane", kPane, 0}, {"pane 2", kBehind, 0}}));
    EXPECT_FALSE(matters({material, white}, {{"pane", kPane, 0}, {"card", kBehind, 1}}));
    EXPECT_TRUE(matters({material, mirror}, {{"pane", kPane, 0}, {"ball", kBall, 1}})) << "back to the pane";
  }
  EXPECT_FALSE(matters({mirror}, {{"mirror", kPane, 0}, {"ball", kBall, 0}}));
}

// Its layers absorb p and s differently.
TEST(PolarisationCause, APerfectMetalPolarisesUnderACoating) {
  const RefractiveIndex perfect(0, 3);
  const Material bare{"bare", ConductorMaterial{"perfect", perfect}};
  const Material coated{
      "coated", ConductorMaterial{"perfect", perfect, {{{"grey", RefractiveIndex(1.9, 0.4)}}, {{0, 40}}}}};
  EXPECT_FALSE(matters({bare}, {{"pane", kPane, 0}, {"pane 2", kBehind, 0}}));
  EXPECT_TRUE(matters({coated}, {{"pane", kPane, 0}, {"pane 2", kBehind, 0}}));
  EXPECT_TRUE(matters({coated, bare}, {{"pane", kPane, 0}, {"ball", kBall, 1}})) << "back to the pane";
}

TEST(PolarisationCause, ABallIsMetOnceWhereItIsOpaqueAndSeenFromOutside) {
  EXPECT_TRUE(matters({test::glass()}, {{"ball", kBall, 0}})) << "in and out";
  EXPECT_FALSE(matters({test::mirror()}, {{"ball", kBall, 0}}));
  EXPECT_TRUE(matters({test::mirror()}, {{"room", Sphere{{0, 0, 0}, 10}, 0}})) << "around the camera";
  const PlacedShape placed{make_prototype(kBall), std::make_shared<Placement>(placement(Imath::M44d()))};
  EXPECT_TRUE(matters({test::mirror()}, {{"instance", placed, 0}})) << "wherever it is";
}

}  // namespace
}  // namespace abbe
