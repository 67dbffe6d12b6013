#include <gtest/gtest.h>

#include <cmath>

#include "scene/shapes/placed.h"
#include "scenes.h"

namespace abbe {
namespace {

// Two faces of a pane before a lamp, seen along z by a pinhole of some degrees, turned by others.
TEST(PolarisationNeed, IsNoneAlongTheNormal) {
  const auto matters = [](double pitch, double turn_deg, bool card, bool as_instances = false) {
    Scene scene{};
    scene.camera = testing::pinhole();
    scene.camera.pixel_pitch = pitch;
    scene.materials = {
        {"black", DiffuseMaterial{Curve(card ? 0.5 : 0.0)}}, testing::mirror(), testing::glass()};
    scene.channels.push_back(energy_channel("Y", Curve(1.0)));
    const double turn = turn_deg * 3.14159265358979 / 180;
    const Imath::V3d across(std::cos(turn), 0, std::sin(turn));
    scene.shapes.push_back({"front", Quad{{-1, -1, 2}, {0, 2, 0}, across * 2}, 2});
    scene.shapes.push_back({"back", Quad{{-1, -1, 3}, across * 2, {0, 2, 0}}, 2});
    if (as_instances) {
      const auto at =
          std::make_shared<Placement>(placement(Imath::M44d().setAxisAngle(Imath::V3d(0, 1, 0), -turn)));
      for (const double z : {2.0, 3.0})
        scene.shapes[z > 2 ? 1 : 0].shape =
            PlacedShape{make_prototype(Quad{{-1, -1, z}, {2, 0, 0}, {0, 2, 0}}), at};
    }
    scene.lights.push_back(
        {"lamp", AreaLight{static_cast<std::uint32_t>(scene.shapes.size()), false}, Curve(1.0)});
    scene.shapes.push_back({"lamp", Quad{{0, 0, 3}, {0, 1, 0}, {1, 0, 0}}, 0});
    scene.commit();
    return scene.needs.polarisation_matters;
  };
  EXPECT_FALSE(matters(0.0005, 0, false));
  EXPECT_FALSE(matters(0.0005, 5, false, true));
  EXPECT_TRUE(matters(0.0005, 12, false, true)) << "instances as they stand";
  EXPECT_FALSE(matters(0.0005, 5, false));
  EXPECT_TRUE(matters(0.0005, 12, false)) << "tilted";
  EXPECT_TRUE(matters(0.01, 0, false)) << "a wide view";
  EXPECT_TRUE(matters(0.0005, 0, true)) << "a card sends light at any angle";
}

}  // namespace
}  // namespace abbe
