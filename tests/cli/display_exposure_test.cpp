#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "tests/cli/lit_dome.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Display exposure and colours of pictures, as commands choose and report them.

namespace abbe::test {
namespace {

double exposure_of_picture(const std::string& picture) {
  return std::stod(read_picture(picture).metadata.at("display_exposure"));
}

// Two films of one scene, the second with twice the light.
struct TwoFrames {
  std::string dim = film_of(lit_dome("dim.json", kNikon), "dim", "--display " + file("dim.png"));
  std::string bright_scene = lit_dome("bright.json", kNikon);
  std::string bright = film_of(bright_scene, "bright", "--set /lights/1/emission/luminance=200");
};

// Relative rounding error of the attribute, which has seven digits.
constexpr double kSevenDigits = 1e-6;

TEST(DisplayExposure, IsReportedByTheCommandsAndThePicture) {
  const TwoFrames films;
  const double rendered = exposure_of_picture(file("dim.png"));
  const double found = developed(films.dim + " --display " + file("d.png"))["display_exposure"].get<double>();
  EXPECT_NEAR(found, rendered, kSevenDigits * rendered);
  EXPECT_EQ(exposure_of_picture(file("d.png")), rendered);
  const Outcome run = run_render(lit_dome("s.json", kNikon), file("s.exr"),
                                 "--stats " + file("s.stats.json") + " --display " + file("s.png"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NEAR(nlohmann::json::parse(read_file(file("s.stats.json")))["display_exposure"].get<double>(),
              rendered, kSevenDigits * rendered);
  EXPECT_FALSE(read_exr(films.dim).metadata.contains("display_exposure")) << "it is the picture's";
  EXPECT_EQ(developed(films.dim + " --exposure 7 --display " + file("d.png"))["display_exposure"], 7);
}

TEST(DisplayExposure, IsHeldOverFrames) {
  const TwoFrames films;
  const double dim = exposure_of_picture(file("dim.png"));
  const auto shown = [&](const std::string& options) {
    return developed(films.bright + " --display " + file("b.png") + options)["display_exposure"]
        .get<double>();
  };
  EXPECT_NEAR(shown("") / dim, 2, 0.02);
  EXPECT_NEAR(shown(" --exposure-of " + films.dim), dim, kSevenDigits * dim);
  EXPECT_NEAR(shown(" --exposure-of " + films.dim + " --exposure-s 0.5") / dim, 0.5, 1e-6)
      << "both films are exposed for half of their 1 s";
  const Outcome run = run_render(films.bright_scene, file("r.exr"),
                                 "--display " + file("r.png") + " --exposure-of " + films.dim);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_DOUBLE_EQ(exposure_of_picture(file("r.png")), dim);
}

TEST(DisplayExposure, OptionsWithoutEffectAreErrors) {
  const TwoFrames films;
  const std::string to = " --display " + file("e.png");
  for (const std::string& options : {" --exposure-of " + films.dim, std::string(" --field"),
                                     to + " --exposure 1 --exposure-of " + films.dim})
    EXPECT_EQ(abbe("develop " + films.bright + options).code, 2) << options;
  const Outcome render = run_render(films.bright_scene, file("e.exr"), "--exposure-of " + films.dim);
  EXPECT_EQ(render.code, 2);
  EXPECT_NE(render.err.find("--exposure-of: applies to pictures only"), std::string::npos) << render.err;
  const Outcome other = run_render(lit_dome("o.json", kObserver), file("o.exr"),
                                   "--display " + file("o.png") + " --exposure-of " + films.dim);
  EXPECT_EQ(other.code, 4);
  EXPECT_NE(other.err.find("has no channel \"X\""), std::string::npos) << other.err;
  EXPECT_EQ(abbe("develop " + films.bright + to + " --exposure-of " + file("none.exr")).code, 4);
}

// The dome emits illuminant A. A calibration for A shows it as white, one for D65 alone shows it as warm.
TEST(CameraSpace, OfACalibrationGivesTheColours) {
  const std::string film = film_of(lit_dome("c.json", kNikon), "c");
  const auto own = developed(film + " --display " + file("own.png"));
  EXPECT_FALSE(own.contains("camera_space"));
  const auto calibrated = [&](const std::string& lights, const std::string& folder) {
    const Outcome run =
        abbe("calibrate --camera Nikon_D5100 --bits 0 --illuminant " + lights + " -o " + file(folder));
    EXPECT_EQ(run.code, 0) << run.err;
    return developed(film + " --display " + file(folder + ".png") + " --ocio " + file(folder) +
                     "/config.ocio");
  };
  const auto in_a = calibrated("A,D65", "both");
  EXPECT_EQ(in_a["camera_space"], "Camera A");
  EXPECT_NEAR(warmth(file("both.png")), warmth(file("own.png")), 0.01);
  EXPECT_NEAR(in_a["display_exposure"].get<double>() / own["display_exposure"].get<double>(), 1, 0.01)
      << "the same view";
  EXPECT_EQ(calibrated("D65", "daylight")["camera_space"], "Camera D65");
  EXPECT_GT(warmth(file("daylight.png")), 0.3);
}

}  // namespace
}  // namespace abbe::test
