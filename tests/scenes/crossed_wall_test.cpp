// Walls that matter crosses, seen where floats hardly tell the two apart.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/angles.h"
#include "tests/scene/meshes.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/plan/plan.h"

namespace abbe {
namespace {

using Imath::V3d;

constexpr const char* kMatter = R"("materials": {
  "flint": {"dielectric": {"ior": 1.7}}, "frosted": {"dielectric": {"ior": 1.5, "roughness": 0.3}},
  "pane": {"thin_glass": {"ior": 1.5}}, "fog": {"medium": {"scattering_per_m": 1}},
  "clear": {"medium": {"absorption_per_m": 0}},
  "white": {"diffuse": {"reflectance": 0.7}}, "black": {"diffuse": {"reflectance": 0}}})";

// A wall before a lamp, of that half size, crossed by the face of some matter, and a view of the line where
// they cross, so narrow that floats tell hardly any of its paths from that line.
class CrossedWall {
 public:
  CrossedWall(double half, double aside, double turned_deg, double slope)
      : half_(half), slope_(slope), aside_(aside, aside, 0) {
    turned_.setAxisAngle(V3d(1, 2, 3).normalized(), turned_deg * kDegree);
  }

  [[nodiscard]] std::string matter(const std::string& material) const {
    Mesh mesh = test::box({-0.7, 0.1, -0.2}, {0.6, 0.6, 0.2});
    for (V3d& vertex : mesh.vertices)
      vertex = (V3d(vertex.x, vertex.y + slope_ * vertex.z, vertex.z) + aside_) * turned_;
    return fmt::format(R"({{"material": "{}", "mesh": {}}})", material, test::inline_mesh(mesh));
  }
  [[nodiscard]] std::string sheet() const {
    return fmt::format(
        R"({{"material": "pane", "quad": {}}})",
        quad(V3d(-0.7, 0.1 - 0.2 * slope_, -0.2) + aside_, {1.3, 0, 0}, V3d(0, slope_, 1) * 0.4));
  }
  [[nodiscard]] std::string wall() const {
    return fmt::format(R"({{"material": "black", "quad": {}}})",
                       quad({-half_, -half_, 0}, {2 * half_, 0, 0}, {0, 2 * half_, 0}));
  }
  [[nodiscard]] double seen(const std::string& shapes, const char* integrator) const {
    const std::string lamp = quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0});
    const Scene scene = test::load_text(fmt::format(
        R"({{"abbe": 1,
          "camera": {{"pinhole": {{"fov_deg": {}}}, "from": [{}], "to": [{}], "up": [{}]}},
          "sensor": {{"resolution": [1, 1], "response": "energy", "channels": {{"all": {{"band": [450, 650]}}}}}},
          {}, "lights": [{{"quad": {}, "two_sided": true, "emission": {{"spectrum": 1}}}}],
          "shapes": [{}], "render": {{"samples": 2048, "integrator": "{}"}}}})",
        3e-5 * std::max(1.0, slope_ / 10), at(V3d(0.13, -0.6, 1.3) + aside_), at(V3d(0.07, 0.1, 0) + aside_),
        at({0, 1, 0}), kMatter, lamp, shapes, integrator));
    // By day of a plan that pilots have taught nothing: they would take longer than the paths.
    RenderOptions options;
    if (!test::nightly()) options.guides = std::make_shared<const GuidingData>(make_plan(scene).guides);
    return render(scene, options).film.mean(0, 0);
  }

 private:
  [[nodiscard]] std::string at(const V3d& point) const {
    const V3d there = point * turned_;
    return fmt::format("{}, {}, {}", there.x, there.y, there.z);
  }
  [[nodiscard]] std::string quad(const V3d& corner, const V3d& u, const V3d& v) const {
    return fmt::format(R"({{"corner": [{}], "edge_u": [{}], "edge_v": [{}]}})", at(corner), at(u), at(v));
  }

  Imath::M44d turned_;
  double half_;
  double slope_;
  V3d aside_;
};

struct Crossing {
  double half;
  double aside;
  double turned_deg;
  double slope;
};
std::vector<Crossing> crossings() {
  if (!test::nightly())
    return {{90, 0, 0, -0.537}, {90, 0, 37, 0}, {90, 0, 37, 300}, {4, 1.1, 37, -0.5}, {4, 1.1, 0, 0.5}};
  std::vector<Crossing> all;
  for (const auto& [half, aside] : {std::pair(90.0, 0.0), std::pair(4.0, 1.1)})
    for (const double turned_deg : {0.0, 37.0})
      for (const double slope : {-0.537, -0.5, 0.0, 0.5, 300.0})
        if (0.2 * slope <= half)  // the matter does not reach around the wall
          all.push_back({half, aside, turned_deg, slope});
  return all;
}

// Of paths that meet a surface within floats of where a wall crosses it, none goes on behind the wall,
// however much larger that is.
TEST(Nesting, NothingComesThroughAWallWhereMatterCrossesIt) {
  for (const auto& [half, aside, turned_deg, slope] : crossings()) {
    const CrossedWall scene(half, aside, turned_deg, slope);
    for (const char* integrator : {"path", "bdpt"}) {
      const std::string what =
          fmt::format("{}, half {}, turned {}, slope {}", integrator, half, turned_deg, slope);
      for (const std::string& matter : {scene.sheet(), scene.matter("flint"), scene.matter("frosted"),
                                        scene.matter("clear"), scene.matter("fog")}) {
        EXPECT_EQ(scene.seen(matter + "," + scene.wall(), integrator), 0) << matter << what;
        EXPECT_GT(scene.seen(matter, integrator), 0) << matter << what;
      }
      EXPECT_EQ(scene.seen(scene.matter("white") + "," + scene.wall(), integrator), 0) << what;
    }
  }
}

}  // namespace
}  // namespace abbe
