// A lens part of which stands in matter.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "tests/scenes/scene_fixture.h"

namespace abbe {
namespace {

// A lens of 5 cm radius R across the face of a ball of ink, along which it looks: of its points (x, z), those
// within see the sky through the chord sqrt(r^2 - (r - x)^2 - z^2), and the others clear of it.
TEST(LensInMatter, MayStandInSeveralKindsAtOnce) {
  const auto seen = [](const char* integrator, const std::string& shapes) {
    const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
      "camera": {{"thin_lens": {{"focal_length": 0.1, "f_number": 1, "focus_distance": 100}}, "from": [0, 0, 0], "to": [0, 1, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [2, 2], "pixel_pitch_um": 5, "channels": {{"all": {{"band": [450, 650]}}}}}},
      "materials": {{"ink": {{"medium": {{"absorption_per_m": 2}}}}}}, "shapes": [{}],
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "render": {{"integrator": "{}", "samples": 4096}}}})",
                                                    shapes, integrator));
    return test::region(render(scene, {}).film, 0, 0, 0, 2, 2).mean;
  };
  constexpr double kLens = 0.05;
  constexpr double kBall = 5;
  constexpr int kSide = 400;
  double transmitted = 0;
  int points = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double x = kLens * ((2 * i + 1.0) / kSide - 1);
      const double z = kLens * ((2 * j + 1.0) / kSide - 1);
      if (std::hypot(x, z) > kLens) continue;
      ++points;
      transmitted +=
          std::exp(-2 * std::sqrt(std::max(0.0, kBall * kBall - (kBall - x) * (kBall - x) - z * z)));
    }
  const char* ball = R"({"material": "ink", "sphere": {"center": [5, 0, 0], "radius": 5}})";
  for (const char* integrator : {"path", "bdpt"})
    EXPECT_NEAR(seen(integrator, ball) / seen(integrator, ""), transmitted / points, 0.003) << integrator;
}

}  // namespace
}  // namespace abbe
