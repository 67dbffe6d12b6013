#include "io/exr.h"
#include "scene_fixture.h"

namespace abbe::test {
namespace {

class EnvironmentScene : public ::testing::Test {
 protected:
  EnvironmentScene()
      : path_(std::filesystem::temp_directory_path() / ("abbe_sky_" + std::to_string(::getpid()) + ".exr")) {}
  ~EnvironmentScene() override { std::filesystem::remove(path_); }

  void write_sky(int width, int height, std::vector<float> values) {
    Image image{width, height, {{"R", values}, {"G", values}, {"B", std::move(values)}}, {}};
    write_exr(path_, image);
  }
  [[nodiscard]] Scene scene(const std::string& rest, const std::string& samples) const {
    return load_text(
        R"({"abbe": 1, "sensor": {"resolution": [2, 2], "channels": {"all": {"band": [500, 600]}}},
      "lights": [{"environment": {"image": ")" +
        path_.string() + R"("}, "emission": {"spectrum": 1}}],
      "render": {"samples": )" +
        samples + "}, " + rest + "}");
  }

  std::filesystem::path path_;
};

constexpr const char* kProbe =
    R"("camera": {"irradiance_probe": {"quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}}})";

// Within a closed white sky nothing of any reflectance 1 can be told from it.
TEST_F(EnvironmentScene, WhiteFurnaceHolds) {
  write_sky(32, 16, std::vector<float>(512, 1.0F));
  const Scene furnace =
      scene(R"("camera": {"pinhole": {"fov_deg": 60}, "from": [0, -4, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "materials": {"white": {"diffuse": {"reflectance": 1}}, "glass": {"dielectric": {"ior": 1.5}}},
    "shapes": [{"sphere": {"center": [-1, 0, 0], "radius": 0.9}, "material": "white"},
               {"sphere": {"center": [1, 0, 0], "radius": 0.9}, "material": "glass"}])",
            "4096");
  const Scene empty =
      scene(R"("camera": {"pinhole": {"fov_deg": 60}, "from": [0, -4, 0], "to": [0, 0, 0], "up": [0, 0, 1]})",
            "64");
  const Film lit = render(furnace, {}).film;
  const Film sky = render(empty, {}).film;
  for (std::size_t pixel = 0; pixel < 4; ++pixel)
    EXPECT_NEAR(lit.mean(pixel, 0) / sky.mean(pixel, 0), 1, 0.01);
}

// A small texel of 1e8 in a dark sky: few samples measure it.
TEST_F(EnvironmentScene, HotTexelGivesItsIrradiance) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 32;
  constexpr int kRow = 8;
  std::vector<float> values(kWidth * kHeight, 0.01F);
  values[kRow * kWidth + 13] = 1e8F;
  write_sky(kWidth, kHeight, values);
  const Film film = render(scene(kProbe, "16"), {}).film;
  const double pi = std::acos(-1.0);
  const auto edge = [&](int row) { return std::pow(std::sin(pi * row / kHeight), 2) / 2; };
  const double irradiance = 1e8 * 100 * 2 * pi / kWidth * (edge(kRow + 1) - edge(kRow));
  for (std::size_t pixel = 0; pixel < 4; ++pixel) EXPECT_NEAR(film.mean(pixel, 0) / irradiance, 1, 0.01);
}

}  // namespace
}  // namespace abbe::test
