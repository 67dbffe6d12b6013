#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// The picture that `merge` writes of a film must equal that of a render with all samples, and that of
// `develop` without noise. So must its attributes.

namespace abbe::test {
namespace {

constexpr const char* kCounting =
    R"("response": "quantum", "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]},
       "B": {"band": [400, 500]}}, "readout": {"gain_e_per_dn": 3, "bits": 12, "read_noise_e": 6})";

struct Shown {
  const char* name;
  std::string sensor;
  std::string options;
};

class MergeDisplay : public testing::TestWithParam<Shown> {};

TEST_P(MergeDisplay, IsThatOfTheRender) {
  const std::string render = fmt::format(
      R"(render {} --quiet --spp 4 --set '/sensor={{"resolution": [24, 16], "pixel_pitch_um": 600, {}}}' {} )",
      ball(), GetParam().sensor, GetParam().options);
  ASSERT_EQ(abbe(render + "-o " + file("whole.exr") + " --display " + file("whole.png")).code, 0);
  const std::string a = file("a.abbepart");
  const std::string b = file("b.abbepart");
  ASSERT_EQ(abbe(render + "--crop 0,0,24,7 -o " + a).code, 0);
  ASSERT_EQ(abbe(render + "--crop 0,7,24,16 -o " + b).code, 0);
  const Outcome run =
      abbe(fmt::format("merge {} {} -o {} --display {}", a, b, file("sum.exr"), file("sum.png")));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(read_file(file("sum.png")) == read_file(file("whole.png")));
  if (GetParam().sensor.find("readout") != std::string::npos) return;
  const Outcome developed = abbe("develop " + file("whole.exr") + " --display " + file("developed.png"));
  ASSERT_EQ(developed.code, 0) << developed.err;
  EXPECT_TRUE(read_file(file("developed.png")) == read_file(file("whole.png")));
  const auto told = read_picture(file("developed.png")).metadata;
  EXPECT_EQ(told.at("frame_mean_error"), read_exr(file("whole.exr")).metadata.at("frame_mean_error"));
  for (const char* key : {"aov", "shapes", "layers"}) EXPECT_FALSE(told.contains(key)) << key;
}

INSTANTIATE_TEST_SUITE_P(
    Sensors, MergeDisplay,
    testing::Values(Shown{"observer", R"("observer": "1931")", ""},
                    Shown{"exposed", R"("observer": "1931")", "--set /output/exposure=2"},
                    Shown{"features", R"("observer": "1931")", "--aov id,depth --layers lights"},
                    Shown{"counting", kCounting, ""},
                    Shown{"mosaic", kCounting + std::string(R"(, "mosaic": [["R", "G"], ["G", "B"]])"), ""},
                    Shown{"spectral", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 20})", ""},
                    Shown{"spectral_exposed", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 20})",
                          "--set /output/exposure=2"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(MergeDisplay, IsRefusedBeforeAnySumIsRead) {
  const std::string part = file("two.abbepart");
  ASSERT_EQ(
      abbe(
          "render " + ball() +
          R"( --quiet --set '/sensor={"resolution": [24, 16], "pixel_pitch_um": 600, "channels": {"a": 1, "b": 1}}' -o )" +
          part)
          .code,
      0);
  const Outcome two = abbe("merge " + part + " -o " + file("two.exr") + " --display " + file("two.png"));
  EXPECT_EQ(two.code, 2);
  EXPECT_NE(two.err.find("a picture needs a sensor of one or three channels"), std::string::npos) << two.err;
  EXPECT_FALSE(std::filesystem::exists(file("two.exr")));
  EXPECT_EQ(abbe("merge " + part + " -o " + file("two.exr") + " --display " + file("two.exr")).code, 2);
  EXPECT_EQ(abbe("merge " + part + " -o " + file("two.exr") + " --display /nowhere/two.png").code, 5);
}

// The reason is recorded in the film and its parts, so that all commands that write a picture report it.
TEST(MergeDisplay, ChannelsThatShowNoColoursAreToldAlike) {
  const std::string render =
      "render " + ball() +
      R"( --quiet --set '/sensor={"resolution": [24, 16], "pixel_pitch_um": 600, "channels": {"a": {"band": [800, 850]}, "b": {"band": [850, 900]}, "c": {"band": [900, 950]}}}' -o )";
  const std::string film = file("infrared.exr");
  const std::string part = file("infrared.abbepart");
  const std::string shown = " --display " + file("infrared.png");
  const Outcome rendered = abbe(render + film + shown);
  EXPECT_FALSE(std::filesystem::exists(film)) << "told before anything is rendered";
  ASSERT_EQ(abbe(render + film).code, 0);
  ASSERT_EQ(abbe(render + part).code, 0);
  for (const Outcome& run : {rendered, abbe("develop " + film + shown),
                             abbe("merge " + part + " -o " + file("merged.exr") + shown)}) {
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("abbe: display: in its light, channels a, b, c do not distinguish colours between "
                           "360 and 830 nm, so no colour picture can be made of them: "),
              std::string::npos)
        << run.err;
  }
}

}  // namespace
}  // namespace abbe::test
