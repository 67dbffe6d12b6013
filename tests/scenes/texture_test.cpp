#include <fmt/format.h>

#include "io/exr.h"
#include "scene_fixture.h"

namespace abbe {
namespace {

using namespace test;

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

}  // namespace
}  // namespace abbe
