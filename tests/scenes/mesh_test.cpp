// Bodies of triangles: matter stays where its surface says, and vertex normals make balls round.
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "tests/scene/meshes.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using test::box;
using test::expect_same_from_either_end;
using test::icosphere;
using test::inside_out;
using test::load_text;

class MeshScene : public ::testing::Test {
 protected:
  MeshScene()
      : path_(std::filesystem::temp_directory_path() / fmt::format("abbe_mesh_scene_{}.obj", ::getpid())) {}
  ~MeshScene() override { std::filesystem::remove(path_); }
  // The mesh as what a shape is.
  std::string file(const Mesh& mesh) const {
    std::ofstream(path_) << test::obj_text(mesh);
    return fmt::format(R"("mesh": "{}")", path_.string());
  }
  std::filesystem::path path_;
};

// A block of glass amid an even sky, in front of a lamp that tells what it refracts.
Film glass_block(const Mesh& mesh, const char* lights, int samples) {
  return render(
             load_text(fmt::format(
                 R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0.4, -4, 1], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [12, 12], "channels": {{"all": {{"band": [500, 600]}}}}}},
      "materials": {{"glass": {{"dielectric": {{"ior": 1.5}}}}, "black": {{"diffuse": {{"reflectance": 0}}}}}},
      "shapes": [{{"mesh": {}, "material": "glass"}}], "lights": [{}],
      "render": {{"samples": {}, "integrator": "path", "max_depth": 400, "roulette_depth": -1}}}})",
                 test::inline_mesh(mesh), lights, samples)),
             {})
      .film;
}
constexpr const char* kSky = R"({"environment": {}, "emission": {"spectrum": 1}})";
constexpr const char* kPanel =
    R"({"quad": {"corner": [-0.5, 3, -2], "edge_u": [0, 0, 4], "edge_v": [1, 0, 0]}, "two_sided": true, "material": "black", "emission": {"spectrum": 1}})";
const Mesh kBlock = box({-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6});

TEST_F(MeshScene, ABlockInsideOutIsNoAirInGlass) {
  const Film right = glass_block(kBlock, kPanel, 64);
  const Film turned = glass_block(inside_out(kBlock), kPanel, 64);
  ASSERT_GT(right.average(0).mean, 0);
  for (std::size_t pixel = 0; pixel < 144; ++pixel) EXPECT_EQ(turned.mean(pixel, 0), right.mean(pixel, 0));
}

TEST_F(MeshScene, ABlockOfMixedWindingsLosesNoLight) {
  Mesh mixed = kBlock;
  for (const std::size_t i : {0U, 5U, 8U}) std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  const double sky = glass_block(box({9, 9, 9}, {10, 10, 10}), kSky, 16).average(0).mean;
  const auto share = [sky](const Mesh& mesh) { return glass_block(mesh, kSky, 256).average(0).mean / sky; };
  const double whole = share(mixed);
  Mesh open = kBlock;
  open.triangles.resize(10);
  std::printf("in a furnace: mixed windings %.5f, open %.5f\n", whole, share(open));
  EXPECT_NEAR(whole, 1, 1e-4);
}

// A ball lit from the side, as a camera sees it.
Film lit_ball(const std::string& shape, const std::string& material) {
  return render(
             load_text(fmt::format(
                 R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, -5, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [48, 48], "channels": {{"all": {{"band": [500, 600]}}}}}},
      "materials": {{"m": {{{}}}}}, "shapes": [{{{}, "material": "m"}}],
      "lights": [{{"sphere": {{"center": [4, -5, 3], "radius": 1}}, "material": "m", "emission": {{"spectrum": 1}}}}],
      "render": {{"samples": {}, "integrator": "path", "max_depth": 2}}}})",
                 material, shape, test::nightly() ? 256 : 128)),
             {})
      .film;
}

// Within the outline, which stays that of the triangles.
TEST_F(MeshScene, VertexNormalsMakeABallRound) {
  constexpr double kWithin = 16.5;  // pixels, nine tenths of the ball's radius
  for (const char* matter :
       {R"("diffuse": {"reflectance": 0.8})", R"("conductor": {"ior": "Al_Rakic", "roughness": 0.4})"}) {
    const Film ball = lit_ball(R"("sphere": {"center": [0, 0, 0], "radius": 1})", matter);
    const double mean = ball.average(0).mean;
    const auto error = [&](const Mesh& mesh) {
      const Film film = lit_ball(file(mesh), matter);
      double sum = 0;
      int pixels = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
          if (std::hypot(x - 23.5, y - 23.5) > kWithin) continue;
          const auto pixel = static_cast<std::size_t>(48 * y + x);
          sum += std::pow(film.mean(pixel, 0) - ball.mean(pixel, 0), 2);
          ++pixels;
        }
      return std::sqrt(sum / pixels) / mean;
    };
    const double smooth = error(icosphere(3, true));
    const double faceted = error(icosphere(3, false));
    std::printf("%s: relative error %.4f with vertex normals, %.4f without\n", matter, smooth, faceted);
    EXPECT_LT(smooth, faceted / 5);
  }
}

// Light on rounded balls, of paper and of gold, is the same traced from either end.
TEST_F(MeshScene, BothTechniquesAgreeOnVertexNormals) {
  const std::string mesh = file(icosphere(0, true));
  expect_same_from_either_end(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, -4, 1.2], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [{1}, {1}], "channels": {{"B": {{"band": [400, 500]}}, "R": {{"band": [600, 700]}}}}}},
      "materials": {{"paper": {{"diffuse": {{"reflectance": 0.7}}}}, "gold": {{"conductor": {{"ior": "Au_Johnson"}}}}}},
      "lights": [{{"disc": {{"center": [1, -1, 2.5], "normal": [-0.3, 0.3, -1], "radius": 0.6}}, "emission": {{"spectrum": 1}}, "material": "paper"}}],
      "shapes": [{{"quad": {{"corner": [-3, -3, -0.7], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}}, "material": "paper"}},
                 {{{0}, "material": "paper", "transform": [{{"scale": 0.7}}, {{"translate": [-0.8, 0, 0]}}]}},
                 {{{0}, "material": "gold", "transform": [{{"scale": 0.7}}, {{"translate": [0.8, 0, 0]}}]}}],
      "render": {{"max_depth": 6}}}})",
      mesh, test::nightly() ? 32 : 16));
}

}  // namespace
}  // namespace abbe
