// Scenes of other renderers, converted, look as the same scenes written for Abbe.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fmt/format.h>

#include "importers/importers.h"
#include "spectral/colorimetry.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/source_tree.h"
#include "tests/tier.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

struct Pair {
  const char* theirs;  // beside this file
  const char* ours;    // in the folder of data
};

void PrintTo(const Pair& pair, std::ostream* to) {
  *to << pair.theirs;
}

class Doors : public ::testing::TestWithParam<Pair> {};

Scene converted(const fs::path& file) {
  Diagnostics diagnostics;
  const auto text = convert_scene(file, {file.parent_path(), {}}, diagnostics);
  if (!text) throw Error(ErrorCode::internal, file.string(), diagnostics.text());
  const auto source = std::make_shared<const SourceText>(SourceText{"converted", *text});
  auto scene = load_scene(source, file.parent_path(), {}, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, file.string(), diagnostics.text());
  return std::move(*scene);
}

TEST_P(Doors, SameWithinOnePercentOfEachTile) {
  if (!test::nightly() && std::string(GetParam().theirs).find("cornell") != std::string::npos)
    GTEST_SKIP() << "takes long";
  constexpr int kTiles = 4;
  const auto rendered = [](Scene scene) {
    if (!test::nightly()) scene.render.samples = 8;
    return render(scene, {}).film;
  };
  const Film theirs = rendered(converted(test::source_tree() / "tests/scenes/importers" / GetParam().theirs));
  const Film ours = rendered(test::load_file(data_directory() / GetParam().ours, {}));
  ASSERT_TRUE(theirs.shape() == ours.shape());
  double worst = 0;
  for (int channel = 0; channel < ours.channels(); ++channel)
    for (int j = 0; j < kTiles; ++j)
      for (int i = 0; i < kTiles; ++i) {
        const auto mean = [&](const Film& film) {
          return test::region(film, channel, i * film.width() / kTiles, j * film.height() / kTiles,
                              (i + 1) * film.width() / kTiles, (j + 1) * film.height() / kTiles)
              .mean;
        };
        worst = std::max(worst, std::abs(mean(theirs) / mean(ours) - 1));
      }
  std::printf("largest difference of a tile: %.3f %%\n", 100 * worst);
  EXPECT_LE(worst, 0.01);
}

INSTANTIATE_TEST_SUITE_P(All, Doors,
                         ::testing::Values(Pair{"pbrt/cornell.pbrt", "scenes/cornell.json"},
                                           Pair{"pbrt/metals.pbrt", "bench/metals.json"},
                                           Pair{"mitsuba/cornell.xml", "scenes/cornell.json"},
                                           Pair{"mitsuba/metals.xml", "bench/metals.json"}));

// Y in the middle of the picture of a ball of radius 5 by pbrt's default pinhole, f/4, under an even sky of
// radiance 1. `before` holds directives before the material.
test::Region ball_under_even_sky(const std::string& eta, const std::string& before) {
  const fs::path file = fs::temp_directory_path() / fmt::format("abbe_ball_{}.pbrt", ::getpid());
  std::ofstream(file)
      << "Scale -1 1 1\nLookAt 0 0 -20  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 1\n"
         "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
         "Sampler \"independent\" \"integer pixelsamples\" 64\n"
         "Integrator \"volpath\" \"integer maxdepth\" 50\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
      << before << "Material \"dielectric\" " << eta << "\nShape \"sphere\" \"float radius\" 5\n";
  Scene scene = converted(file);
  fs::remove(file);
  return test::whole(render(scene, {}).film, 1);
}

// What is reflected and what is let through add up to the sky, whatever the index: Y = 683.002 pi/(4 4^2).
TEST(PbrtGlass, ClearBallsShowAnEvenSkyAsItIs) {
  const double sky = kLuminousEfficacy * std::numbers::pi / 64;
  for (const char* eta : {"\"float eta\" 1.5", "\"spectrum eta\" \"glass-BK7\"",
                          "\"spectrum eta\" \"glass-BAF10\"", "\"spectrum eta\" \"glass-F11\""}) {
    SCOPED_TRACE(eta);
    const test::Region seen = ball_under_even_sky(eta, "");
    std::printf("%s: Y %.3f +- %.3f of %.3f\n", eta, seen.mean, std::sqrt(seen.variance), sky);
    EXPECT_NEAR(seen.mean, sky, 1e-3 * sky + 5 * std::sqrt(seen.variance));
    EXPECT_LT(std::sqrt(seen.variance), 0.01 * sky);
  }
}

// In the middle a ball is a slab as thick as it is wide: of the sky behind (1 - R)^2 t/(1 - R^2 t^2) is let
// through and R + (1 - R)^2 R t^2/(1 - R^2 t^2) of that before it is reflected, t = exp(-alpha d), here
// exp(-0.1 * 10), and R = 0.04.
TEST(PbrtGlass, MatterWithinDispersiveGlassAbsorbs) {
  const double r = 0.04;
  const double t = std::exp(-1);
  const double share = r + (1 - r) * (1 - r) * t * (1 + r * t) / (1 - r * r * t * t);
  const double expected = kLuminousEfficacy * std::numbers::pi / 64 * share;
  const test::Region seen = ball_under_even_sky("\"spectrum eta\" [400 1.5 700 1.5]",
                                                "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb "
                                                "sigma_a\" [0.1 0.1 0.1] \"rgb sigma_s\" [0 "
                                                "0 0]\nMediumInterface \"m\" \"\"\n");
  std::printf("Y %.3f +- %.3f of %.3f\n", seen.mean, std::sqrt(seen.variance), expected);
  EXPECT_NEAR(seen.mean, expected, 1e-3 * expected + 5 * std::sqrt(seen.variance));
  EXPECT_LT(std::sqrt(seen.variance), 0.01 * expected);
}

}  // namespace
}  // namespace abbe
