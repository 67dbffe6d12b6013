#include <cmath>

#include <fmt/format.h>

#include "io/exr.h"
#include "scene_fixture.h"
#include "tests/angles.h"

namespace abbe::test {
namespace {

class TextureScene : public ::testing::Test {
 protected:
  TextureScene()
      : path_(std::filesystem::temp_directory_path() / fmt::format("abbe_texture_{}.exr", ::getpid())) {}
  ~TextureScene() override { std::filesystem::remove(path_); }

  std::filesystem::path path_;
};

// A card of two by two texels, seen at right angles under an even sky, four pixels to a texel. Its radiance
// is its reflectance times that of a white card, whatever the noise, for both are lit by the same random
// numbers.
TEST_F(TextureScene, EachTexelShowsTheReflectanceItsChannelsWeigh) {
  write_exr(path_, {2, 2, {{"low", {0.1F, 0.2F, 0.3F, 0.4F}}, {"high", {0.9F, 0.5F, 0.7F, 0.0F}}}, {}});
  const auto photographed = [](const std::string& reflectance) {
    const Scene scene = load_text(fmt::format(
        R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, 0, 3], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [4, 4], "channels": {{"low": {{"band": [410, 490]}}, "high": {{"band": [510, 590]}}}}}},
      "materials": {{"card": {{"diffuse": {{"reflectance": {}}}}}}},
      "shapes": [{{"quad": {{"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}}, "material": "card"}}],
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "render": {{"samples": 16}}}})",
        reflectance));
    return render(scene, {.threads = 1}).film;
  };
  const Film white = photographed("1");
  const Film card = photographed(fmt::format(
      R"({{"image": "{}", "filter": "nearest", "weights": {{"low": {{"band": [400, 500]}}, "high": {{"band": [500, 600]}}}}}})",
      path_.string()));
  const double expected[2][2][2] = {{{0.1, 0.9}, {0.2, 0.5}}, {{0.3, 0.7}, {0.4, 0.0}}};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      for (int channel = 0; channel < 2; ++channel) {
        const auto pixel = static_cast<std::size_t>(4 * y + x);
        ASSERT_GT(white.mean(pixel, channel), 0);
        EXPECT_NEAR(card.mean(pixel, channel) / white.mean(pixel, channel), expected[y / 2][x / 2][channel],
                    1e-5)
            << x << " " << y << " " << channel;
      }
}

// A map of one texel, tilted so far towards +u.
Image tilt(double degrees) {
  const double angle = degrees * kPi / 180;
  return {1,
          1,
          {{"R", {static_cast<float>(0.5 + std::sin(angle) / 2)}},
           {"G", {0.5F}},
           {"B", {static_cast<float>(0.5 + std::cos(angle) / 2)}}},
          {}};
}

// A card under one far bulb, 40 degrees from its normal towards +u, seen from above.
double lit_card(const std::string& relief) {
  const double angle = 40 * kPi / 180;
  const Scene scene = load_text(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 5}}, "from": [0, 0, 3], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [2, 2], "channels": {{"all": {{"band": [500, 600]}}}}}},
    "materials": {{"card": {{"diffuse": {{"reflectance": 0.5}}{}}}}},
    "shapes": [{{"quad": {{"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}}, "material": "card"}}],
    "lights": [{{"point": {{"at": [{}, 0, {}]}}, "emission": {{"illuminant": "E", "luminous_intensity": 1e12}}}}],
    "render": {{"integrator": "path", "samples": 16, "max_depth": 2}}}})",
      relief, 1e6 * std::sin(angle), 1e6 * std::cos(angle)));
  return region(render(scene, {.threads = 1}).film, 0, 0, 0, 2, 2).mean;
}

TEST_F(TextureScene, ATiltedNormalIsLitByItsOwnCosine) {
  const double plain = lit_card("");
  ASSERT_GT(plain, 0);
  for (const double degrees : {25.0, -25.0}) {
    write_exr(path_, tilt(degrees));
    const double tilted = lit_card(fmt::format(R"(, "normal_map": {{"image": "{}"}})", path_.string()));
    EXPECT_NEAR(tilted / plain, std::cos((40 - degrees) * kPi / 180) / std::cos(40 * kPi / 180), 1e-4)
        << degrees;
  }
}

// Normals in all directions up to 60 degrees from the surface's, over a ball.
Image wild_normals() {
  constexpr int kSide = 32;
  Image image{kSide, kSide, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (int i = 0; i < kSide * kSide; ++i) {
    const double angle = kPi / 3 * std::sqrt(static_cast<double>(i * 37 % 101) / 100);
    const double turn = 2.4 * i;
    image.channels[0].values.push_back(static_cast<float>(0.5 + std::sin(angle) * std::cos(turn) / 2));
    image.channels[1].values.push_back(static_cast<float>(0.5 + std::sin(angle) * std::sin(turn) / 2));
    image.channels[2].values.push_back(static_cast<float>(0.5 + std::cos(angle) / 2));
  }
  return image;
}

// Within an even sky no relief shines: what the model and the shape see on different sides is lost.
TEST_F(TextureScene, ReliefsShineNoMoreThanTheirSurroundings) {
  write_exr(path_, wild_normals());
  for (const char* matter : {R"("diffuse": {"reflectance": 1})", R"("conductor": {"ior": 0})"}) {
    const auto seen = [&](const std::string& ball) {
      const Scene scene = load_text(fmt::format(
          R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [0, -4, 0.5], "to": [0, 0, 0], "up": [0, 0, 1]}},
        "sensor": {{"resolution": [4, 4], "channels": {{"all": {{"band": [500, 600]}}}}}},
        "materials": {{"ball": {{{}, "normal_map": {{"image": "{}", "scale": [4, 2]}}}}}},
        "shapes": [{}], "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
        "render": {{"samples": 1024, "max_depth": 64, "roulette_depth": -1}}}})",
          matter, path_.string(), ball));
      return render(scene, {}).film;
    };
    const Film ball = seen(R"({"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "ball"})");
    const Film sky = seen("");
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
      const double share = ball.mean(pixel, 0) / sky.mean(pixel, 0);
      EXPECT_LE(share, 1 + 5 * std::sqrt(ball.variance(pixel, 0)) / sky.mean(pixel, 0) + 1e-4) << matter;
      EXPECT_GT(share, 0.6) << matter;
    }
  }
}

// Light below a floor that is seen from above stays there, however its normals lean.
TEST_F(TextureScene, NoLightLeaksThroughARelief) {
  write_exr(path_, wild_normals());
  const Scene scene = load_text(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, -3, 1], "to": [0, 0, 0], "up": [0, 0, 1]}},
    "sensor": {{"resolution": [8, 8], "channels": {{"all": {{"band": [500, 600]}}}}}},
    "materials": {{"floor": {{"diffuse": {{"reflectance": 1}}, "normal_map": {{"image": "{}", "scale": [9, 9]}}}}}},
    "shapes": [{{"quad": {{"corner": [-50, -50, 0], "edge_u": [100, 0, 0], "edge_v": [0, 100, 0]}}, "material": "floor"}}],
    "lights": [{{"point": {{"at": [2, 0, -0.5]}}, "emission": {{"illuminant": "E", "luminous_intensity": 1}}}},
               {{"sphere": {{"center": [-2, 0, -0.5], "radius": 0.3}}, "emission": {{"spectrum": 1}}}}],
    "render": {{"samples": 64}}}})",
      path_.string()));
  for (const Integrator integrator : {Integrator::path, Integrator::light}) {
    Scene one = scene;
    one.render.integrator = integrator;
    EXPECT_EQ(region(render(one, {}).film, 0, 0, 0, 8, 8).mean, 0);
  }
}

// Light that meets leaning normals, on paper and on mirrors, is the same traced from either end.
TEST_F(TextureScene, BothTechniquesAgreeOnReliefs) {
  write_exr(path_, wild_normals());
  expect_same_from_either_end(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, -4, 1.2], "to": [0, 0, 0.4], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [32, 32], "channels": {{"B": {{"band": [400, 500]}}, "R": {{"band": [600, 700]}}}}}},
      "materials": {{"paper": {{"diffuse": {{"reflectance": 0.7}}, "normal_map": {{"image": "{0}", "scale": [6, 6]}}}},
                     "mirror": {{"conductor": {{"ior": "Au_Johnson"}}, "normal_map": {{"image": "{0}", "scale": [0.5, 0.5], "offset": [0.3, 0.1]}}}}}},
      "lights": [{{"disc": {{"center": [1, -1, 2.5], "normal": [-0.3, 0.3, -1], "radius": 0.6}}, "emission": {{"spectrum": 1}}}}],
      "shapes": [{{"quad": {{"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}}, "material": "paper"}},
                 {{"quad": {{"corner": [-1.5, 0.5, 0.05], "edge_u": [2, 0.5, 0], "edge_v": [0, 0.6, 1.5]}}, "material": "mirror"}}],
      "render": {{"max_depth": 6}}}})",
      path_.string()));
}

}  // namespace
}  // namespace abbe::test
