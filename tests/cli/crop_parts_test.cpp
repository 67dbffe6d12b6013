#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "io/data_directory.h"
#include "io/exr.h"
#include "io/part_file.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"
#include "tests/source_tree.h"
#include "tests/tier.h"

// Films rendered in crops, each of them in ranges of samples.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

bool names(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

// Crops of unequal size that ignore tiles, in arbitrary order. Some are divided into ranges of samples.
std::string crops_of(const std::string& scene) {
  return part_of(scene, "right", "--crop 7,0,24,5") + " " +
         part_of(scene, "low", "--crop 0,5,24,16 --sample-range 5:8") + " " +
         part_of(scene, "left", "--crop 0,0,7,5 --sample-range 0:3 --threads 1") + " " +
         part_of(scene, "lower", "--crop 0,5,24,16 --sample-range 0:5") + " " +
         part_of(scene, "later", "--crop 0,0,7,5 --sample-range 3:8");
}

TEST(CropParts, AddUpToTheFileOfTheWholeRender) {
  const std::string crops = crops_of(ball());
  ASSERT_EQ(merged(crops, file("sum.abbepart") + " -o " + file("sum.exr")).code, 0);
  EXPECT_EQ(read_file(file("sum.abbepart")), read_file(part_of(ball(), "whole", "")));
  ASSERT_EQ(abbe("render " + ball() + " --quiet -o " + file("whole.exr")).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
  EXPECT_EQ(read_file(part_of(ball(), "all", "--crop 0,0,24,16")), read_file(file("whole.abbepart")));
}

// Every crop traces all photons and records those that reach it.
TEST(CropParts, AddUpWherePhotonsAreTraced) {
  // The pilot rays of `auto` are omitted by day.
  const std::string integrator = nightly() ? "auto" : "light";
  const std::string scene = (data_directory() / "scenes/prism_spot.json").string() +
                            " --set '/sensor/resolution=[24, 16]' --spp 8 --integrator " + integrator;
  ASSERT_EQ(merged(crops_of(scene), file("sum.exr")).code, 0);
  const Outcome whole = abbe("render " + scene + " --quiet -o " + file("whole.exr") + " --display " +
                             file("whole.png") + " --stats -");
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_GT(whole.json()["photons_per_sample"], 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
}

TEST(CropParts, HoldNoOtherPixels) {
  const auto bytes = [](const std::string& path) { return read_part_file(path).bytes.size(); };
  EXPECT_EQ(bytes(part_of(ball(), "a", "--crop 3,2,9,6")) * 24 * 16, bytes(part_of(ball(), "b", "")) * 6 * 4);
}

TEST(CropParts, SayWhichSamplesOfWhichPixelsAreMissing) {
  const std::string parts = part_of(ball(), "a", "--crop 0,0,10,16 --sample-range 0:6") + " " +
                            part_of(ball(), "b", "--crop 10,4,24,16");
  fs::remove(file("gaps.exr"));
  const Outcome refused = merged(parts, file("gaps.exr"));
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(names(refused.err,
                    "gaps.exr: samples 6:8 of pixels 0,0,10,4, samples 0:8 of pixels 10,0,24,4, "
                    "samples 6:8 of pixels 0,4,10,16 are missing"))
      << refused.err;
  EXPECT_FALSE(fs::exists(file("gaps.exr")));
  const Outcome one = merged(part_of(ball(), "b", "--crop 10,4,24,16"), file("gaps.exr"));
  EXPECT_EQ(one.code, 4) << "the pixels of one crop are not all";
}

TEST(CropParts, NoPixelTakesASampleTwice) {
  const std::string a = part_of(ball(), "a", "--crop 0,0,10,16 --sample-range 0:6");
  const Outcome both =
      merged(a + " " + part_of(ball(), "b", "--crop 9,8,24,16 --sample-range 5:8"), file("no.exr"));
  EXPECT_EQ(both.code, 4);
  EXPECT_TRUE(
      names(both.err, "b.abbepart: has samples that are already included (got 5:8 of pixels 9,8,10,16)"))
      << both.err;
  EXPECT_EQ(merged(a + " " + part_of(ball(), "c", "--crop 9,8,24,16 --sample-range 6:8"),
                   file("sum.abbepart") + " --partial")
                .code,
            0);
}

// A partial film is correct at each of its pixels and can be extended.
TEST(CropParts, APartialFilmIsRightWherePixelsHaveDifferentSamples) {
  const std::string left = part_of(ball(), "left", "--crop 0,0,10,16 --sample-range 0:6");
  const std::string right = part_of(ball(), "right", "--crop 10,4,24,16");
  const std::string sum = file("sum.abbepart");
  const Outcome partial = merged(left + " " + right, file("some.exr") + " -o " + sum + " --partial");
  ASSERT_EQ(partial.code, 0) << partial.err;
  ASSERT_EQ(abbe("merge --partial --crop 0,0,10,16 " + left + " -o " + file("left.exr")).code, 0);
  ASSERT_EQ(abbe("merge --crop 10,4,24,16 " + right + " -o " + file("right.exr")).code, 0);
  const Image some = read_exr(file("some.exr"));
  const Image l = read_exr(file("left.exr"));
  const Image r = read_exr(file("right.exr"));
  for (std::size_t k = 0; k < some.channels.size(); ++k)
    for (std::size_t i = 0; i < some.pixels(); ++i)
      ASSERT_EQ(some.channels[k].values[i], l.channels[k].values[i] + r.channels[k].values[i]) << i;
  EXPECT_FALSE(some.metadata.contains("samples_per_pixel"));
  const Outcome resumed =
      abbe("render " + ball() + " --quiet --resume --checkpoint " + sum + " -o " + file("no.exr"));
  EXPECT_EQ(resumed.code, 4);
  EXPECT_TRUE(names(resumed.err, "sum.abbepart: has pixels with different samples")) << resumed.err;
  const std::string rest = part_of(ball(), "rest", "--crop 0,0,10,16 --sample-range 6:8") + " " +
                           part_of(ball(), "top", "--crop 10,0,24,4");
  ASSERT_EQ(merged(rest + " " + sum, file("sum.exr")).code, 0);
  ASSERT_EQ(abbe("render " + ball() + " --quiet -o " + file("whole.exr")).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
}

TEST(CropParts, AFilmOfUnevenSamplesTellsWhichPixelsHaveWhich) {
  const std::string left = part_of(ball(), "left", "--crop 0,0,10,16");
  const std::string right = part_of(ball(), "right", "--crop 10,0,24,16 --sample-range 0:6");
  ASSERT_EQ(merged(left + " " + right, file("uneven.exr") + " --partial").code, 0);
  const auto told = read_exr(file("uneven.exr")).metadata;
  EXPECT_EQ(told.at("areas"), "0,0,10,16=0:8 10,0,24,16=0:6");
  for (const char* of_the_whole : {"samples_per_pixel", "samples_stated"})
    EXPECT_FALSE(told.contains(of_the_whole)) << of_the_whole;
  const std::string compare = "compare " + file("uneven.exr") + " " + film_of(ball(), "whole");
  EXPECT_EQ(abbe(compare + " --maps " + file("maps")).code, 0) << "all pixels are in common";
}

// Pixels are black because they were not rendered, which is not a measured darkness.
TEST(CropParts, AFilmWithGapsTellsWhichPixelsItHas) {
  const std::string a = part_of(ball(), "a", "--crop 0,0,10,8");
  const std::string b = part_of(ball(), "b", "--crop 10,8,24,16");
  const std::string gaps = file("gaps.exr");
  ASSERT_EQ(merged(a + " " + b, gaps + " --partial").code, 0);
  const auto told = read_exr(gaps).metadata;
  EXPECT_EQ(told.at("areas"), "0,0,10,8=0:8 10,8,24,16=0:8");
  for (const char* of_the_whole : {"crop", "samples_per_pixel", "samples_stated"})
    EXPECT_FALSE(told.contains(of_the_whole)) << of_the_whole;
  const std::string compare = "compare " + gaps + " " + film_of(ball(), "whole");
  const Outcome compared = abbe(compare + " --json");
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_EQ(compared.json()["mean_ratio"], 1);
  EXPECT_EQ(compared.json()["rmse"], 0);
  EXPECT_EQ(compared.json()["areas"], nlohmann::json::parse("[[0, 0, 10, 8], [10, 8, 24, 16]]"));
  const Outcome maps = abbe(compare + " --maps " + file("maps"));
  EXPECT_EQ(maps.code, 2);
  EXPECT_TRUE(
      names(maps.err, "films whose common pixels form one rectangle (got the areas 0,0,10,8 10,8,24,16)"))
      << maps.err;
  const nlohmann::json of_a = developed(film_of(ball(), "a", "--crop 0,0,10,8"));
  const nlohmann::json of_b = developed(film_of(ball(), "b", "--crop 10,8,24,16"));
  const nlohmann::json of_both = developed(gaps);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(of_both["mean"][k].get<double>(),
                (80 * of_a["mean"][k].get<double>() + 112 * of_b["mean"][k].get<double>()) / 192, 1e-9);
}

TEST(CropParts, OfOneCropMakeItsFilm) {
  const std::string parts = part_of(ball(), "a", "--crop 3,2,20,5") + " " +
                            part_of(ball(), "b", "--crop 3,5,20,9 --sample-range 0:3") + " " +
                            part_of(ball(), "c", "--crop 3,5,20,9 --sample-range 3:8");
  ASSERT_EQ(abbe("merge --crop 3,2,20,9 " + parts + " -o " + file("sum.exr")).code, 0);
  ASSERT_EQ(abbe("render " + ball() + " --quiet --crop 3,2,20,9 -o " + file("whole.exr")).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
  const Outcome more = abbe("merge --crop 3,3,20,9 " + parts + " -o " + file("sum.exr"));
  EXPECT_EQ(more.code, 4);
  EXPECT_TRUE(names(more.err, "a.abbepart: has pixels outside --crop (got 3,2,20,5, allowed 3,3,20,9)"))
      << more.err;
}

}  // namespace
}  // namespace abbe::test
