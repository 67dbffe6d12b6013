// Faces so close above another that floats hardly tell the two apart.
#include <cmath>

#include <fmt/format.h>

#include "tests/angles.h"
#include "tests/scene/meshes.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using Imath::V3d;

constexpr const char* kSky = R"({"environment": {}, "emission": {"spectrum": 1}})";

// A grey floor, seen near its rim from within what lies on it or somewhat above.
class CloseFaces {
 public:
  CloseFaces(double scale, double turned_deg) : scale_(scale) {
    turned_.setAxisAngle(V3d(1, 2, 3).normalized(), turned_deg * kDegree);
  }

  [[nodiscard]] std::string lamp() const {
    return fmt::format(R"({{"point": {{"at": [{}]}}, "emission": {{"spectrum": {}}}}})", at({0.5, 0.5, 0.3}),
                       scale_ * scale_);
  }
  [[nodiscard]] std::string box(const std::string& material, double gap) const {
    Mesh mesh = test::box({-1, -1, -0.5 + gap}, {1, 1, 0.5});
    for (V3d& vertex : mesh.vertices) vertex = vertex * turned_ * scale_;
    return fmt::format(R"({{"material": "{}", "mesh": {}}})", material, test::inline_mesh(mesh));
  }
  [[nodiscard]] std::string quad(const std::string& material, double gap) const {
    return fmt::format(R"({{"material": "{}", "quad": {{"corner": [{}], "edge_u": [{}], "edge_v": [{}]}}}})",
                       material, at({-1, -1, -0.5 + gap}), at({2, 0, 0}), at({0, 2, 0}));
  }
  [[nodiscard]] double seen(const std::string& above, const std::string& light,
                            const char* integrator) const {
    const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
          "camera": {{"pinhole": {{"fov_deg": 3}}, "from": [{}], "to": [{}], "up": [{}]}},
          "sensor": {{"resolution": [4, 4], "response": "energy", "channels": {{"all": {{"band": [450, 650]}}}}}},
          "materials": {{
            "half": {{"diffuse": {{"reflectance": 0.5}}}}, "one": {{"dielectric": {{"ior": 1}}}},
            "glass": {{"dielectric": {{"ior": 1.5}}}}, "pane": {{"thin_glass": {{"ior": 1.5}}}},
            "fog": {{"medium": {{"absorption_per_m": {}}}}}}},
          "lights": [{}], "shapes": [{}, {}], "render": {{"samples": 64, "integrator": "{}"}}}})",
                                                    at({0.8, 0.8, 1.5}), at({0.9, 0.9, -0.5}), at({0, 1, 0}),
                                                    0.7 / scale_, light, quad("half", 0), above, integrator));
    return test::whole(render(scene, {}).film).mean;
  }

 private:
  [[nodiscard]] std::string at(const V3d& point) const {
    const V3d there = point * turned_ * scale_;
    return fmt::format("{}, {}, {}", there.x, there.y, there.z);
  }

  double scale_;
  Imath::M44d turned_;
};

// From touching to well apart, the floor is as bright as under what is a ten-thousandth above it. What glass
// touches is darker, as light that leaves it at large angles is mirrored back.
TEST(CloseFaces, AFloorIsSeenThroughWhatIsAnyFewFloatsAboveIt) {
  constexpr double kApart = 1e-4;
  const int stride = test::nightly() ? 1 : 4;
  for (const double scale : {1.0, 1000.0})
    for (const double turned_deg : {0.0, 37.0}) {
      if (!test::nightly() && (scale > 1) != (turned_deg > 0)) continue;
      const CloseFaces faces(scale, turned_deg);
      const auto agrees = [](double found, double expected) { return std::abs(found / expected - 1) < 0.02; };
      const double one = faces.seen(faces.box("one", kApart), kSky, "path");
      const double pane = faces.seen(faces.quad("pane", kApart), kSky, "path");
      const double glass = faces.seen(faces.box("glass", kApart), kSky, "path");
      const double glass_on_it = faces.seen(faces.box("glass", 0), kSky, "path");
      const double fog = faces.seen(faces.box("fog", kApart), faces.lamp(), "path");
      EXPECT_LT(glass_on_it, 0.95 * glass);
      for (int step = 0; step <= 24; step += stride) {
        const double gap = step * 1e-7;
        const std::string what = fmt::format("scale {}, turned {}, gap {}", scale, turned_deg, gap);
        EXPECT_PRED2(agrees, faces.seen(faces.box("one", gap), kSky, "path"), one) << what;
        EXPECT_PRED2(agrees, faces.seen(faces.quad("pane", gap), kSky, "path"), pane) << what;
        const double through_glass = faces.seen(faces.box("glass", gap), kSky, "path");
        EXPECT_TRUE(agrees(through_glass, glass) || agrees(through_glass, glass_on_it))
            << through_glass << ", " << what;
        for (const char* integrator : {"path", "bdpt"})
          EXPECT_PRED2(agrees, faces.seen(faces.box("fog", gap), faces.lamp(), integrator), fog)
              << integrator << ", " << what;
      }
    }
}

// Where faces are nearly as far apart as those that count as touching, each place is all one or the other.
TEST(CloseFaces, FogAboveAFloorTakesItsShareAtAnyGap) {
  for (const double turned_deg : {37.0, 99.0}) {
    const CloseFaces faces(1, turned_deg);
    const double expected = faces.seen(faces.box("fog", 1e-4), faces.lamp(), "path");
    for (int step = 0; step < 100; step += test::nightly() ? 1 : 5) {
      const double gap = 0.8e-6 + step * 1e-8;
      EXPECT_NEAR(faces.seen(faces.box("fog", gap), faces.lamp(), "path") / expected, 1, 0.003)
          << turned_deg << ", " << gap;
    }
  }
}

}  // namespace
}  // namespace abbe
