#include <ostream>
#include <string>
#include <string_view>

#include "tests/angles.h"
#include "tests/scenes/meter_fixture.h"
#include "tests/source_tree.h"
#include "tests/tier.h"

// The light of a luminaire with a cosine distribution, against its closed form.

namespace abbe {
namespace {

using test::expect_equal;
using test::read;

struct LuminaireRun {
  const char* integrator;
  int samples;
};
void PrintTo(const LuminaireRun& run, std::ostream* out) {
  *out << run.integrator;
}

std::string luminaire_scene(const std::string& meter, const std::string& file, const LuminaireRun& run) {
  const std::string path = (test::source_tree() / "data" / "lights" / file).string();
  return R"({"abbe": 1, "meters": {"m": )" + meter +
         R"(}, "lights": [{"photometric": {"at": [0, 0, 1], "file": ")" + path +
         R"("}, "emission": {"illuminant": "E"}}], "render": {"integrator": ")" + run.integrator +
         R"(", "samples": )" + std::to_string(run.samples) + "}}";
}

class CosineLuminaire : public ::testing::TestWithParam<LuminaireRun> {};

// The files have steps of h = 2 degrees. Linear interpolation falls short of a cosine by h^2/12 on average.
constexpr double kInterpolated = 1 - (kPi / 90) * (kPi / 90) / 12;

// 1000 lm downwards: pi I sin^2 of the half angle at which a disc below is seen, 45 degrees.
TEST_P(CosineLuminaire, IlluminatesADisc) {
  const std::string_view by = GetParam().integrator;
  if (!test::nightly() && by != "path" && by != "light") GTEST_SKIP() << "takes long";
  const std::string disc =
      R"({"measures": "flux", "disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}})";
  for (const char* file : {"cosine.ies", "cosine.ldt"})
    expect_equal(read(luminaire_scene(disc, file, GetParam())).whole.luminous, 500 * kInterpolated, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Integrators, CosineLuminaire,
                         ::testing::Values(LuminaireRun{"path", 256}, LuminaireRun{"light", 64},
                                           LuminaireRun{"bdpt", 256}, LuminaireRun{"vcm", 256},
                                           LuminaireRun{"photon-map", 128},
                                           LuminaireRun{"photon-brute", 64}));

TEST(Luminaire, EmitsTheFluxOfItsFile) {
  const std::string sphere =
      R"({"measures": "flux", "sphere": {"center": [0, 0, 1], "radius": 0.5, "facing": "inwards"}})";
  expect_equal(read(luminaire_scene(sphere, "cosine.ies", {"path", 256})).whole.luminous,
               1000 * kInterpolated);
}

// I cos^4/h^2 at 60 degrees from the axis.
TEST(Luminaire, FollowsTheCosineAsideOfItsAxis) {
  const std::string disc =
      R"({"measures": "flux", "disc": {"center": [1.7320508, 0, 0], "normal": [0, 0, 1], "radius": 0.01}})";
  expect_equal(read(luminaire_scene(disc, "cosine.ies", {"path", 256})).whole.luminous,
               1000 / kPi / 16 * kPi * 1e-4);
}

}  // namespace
}  // namespace abbe
