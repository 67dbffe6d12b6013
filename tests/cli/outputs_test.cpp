#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/part_file.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// Outputs of render and merge with unusual names and in unusual folders.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

Outcome here(const std::string& command) {
  return shell("cd " + file("") + "; " + command);
}

TEST(Outputs, NoTwoAreOneFile) {
  const std::string scene = ball();
  fs::remove(scratch() / "link.abbepart");
  fs::create_symlink("sums.abbepart", scratch() / "link.abbepart");
  for (const char* outputs :
       {"-o a.exr --stats ./a.exr", "-o a.exr --stats ball.json", "-o a.exr --display a.png --stats ./a.png",
        "-o sums.abbepart --checkpoint link.abbepart",
        "-o $PWD/sums.abbepart --checkpoint sums.abbepart --resume"}) {
    const Outcome run = here(ABBE_BINARY " render ball.json --quiet " + std::string(outputs));
    EXPECT_EQ(run.code, 2) << outputs << '\n' << run.err;
    EXPECT_NE(run.err.find("is the same file as"), std::string::npos) << run.err;
  }
  EXPECT_EQ(read_file(scene), ball_scene());
}

TEST(Outputs, ACheckpointSaysByItsNameWhatItIs) {
  const Outcome run = here(ABBE_BINARY " render " + ball() + " --quiet -o a.exr --checkpoint state.exr");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("allowed .abbepart"), std::string::npos) << run.err;
}

TEST(Outputs, LinksLeadToWhatIsWritten) {
  fs::create_directories(scratch() / "far");
  for (const char* name : {"film.exr", "sums.abbepart", "picture.png"}) {
    fs::remove(scratch() / name);
    fs::remove(scratch() / "far" / name);
    fs::create_symlink(fs::path("far") / name, scratch() / name);
  }
  const Outcome run = here(ABBE_BINARY " render " + ball() +
                           " --quiet -o film.exr --checkpoint sums.abbepart --display picture.png");
  EXPECT_EQ(run.code, 0) << run.err;
  for (const char* name : {"film.exr", "sums.abbepart", "picture.png"}) {
    EXPECT_TRUE(fs::is_symlink(scratch() / name)) << name;
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(scratch() / "far" / name))) << name;
  }
  EXPECT_EQ(
      here(ABBE_BINARY " render ball.json --quiet -o film.exr --checkpoint sums.abbepart --resume").code, 0);
}

TEST(Outputs, NamesMayHoldBlanksAndLineBreaks) {
  const std::string text = ball_scene();
  (void)scratch().write("a b\nc: d.json", text);
  const std::string quoted = "'a b\nc: d";
  const Outcome run =
      here(ABBE_BINARY " render " + quoted + ".json' --quiet -o " + quoted +
           ".abbepart' && " ABBE_BINARY " merge " + quoted + ".abbepart' -o " + quoted + ".exr'");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_exr(scratch() / "a b\nc: d.exr").metadata.at("scene"), "a b?c: d.json");
}

TEST(Outputs, ScenesComeFromStandardInputAndStatsGoToStandardOutput) {
  (void)ball();
  for (const char* name : {"stdin.exr", "named.exr"}) fs::remove(scratch() / name);
  const Outcome run = here(ABBE_BINARY " render - --quiet --stats - < ball.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["samples_per_pixel"], 8);
  EXPECT_EQ(read_exr(scratch() / "stdin.exr").metadata.at("scene"), "stdin");
  ASSERT_EQ(here("cat ball.json | " ABBE_BINARY " render - --quiet -o named.exr").code, 0);
  ASSERT_EQ(here(ABBE_BINARY " render ball.json --quiet -o file.exr").code, 0);
  EXPECT_EQ(read_exr(scratch() / "named.exr").find("Y")->values,
            read_exr(scratch() / "file.exr").find("Y")->values);
  EXPECT_EQ(here(ABBE_BINARY " info - --json < ball.json").json(),
            here(ABBE_BINARY " info ball.json --json").json());
  const Outcome wrong = here("echo '{\"abbe\": 2}' | " ABBE_BINARY " render -");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_NE(wrong.err.find("<stdin>:1:10: /abbe: "), std::string::npos) << wrong.err;
  EXPECT_EQ(here(ABBE_BINARY " render - --quiet < /dev/null").code, 3);
}

TEST(Outputs, UnwritablePlacesAreFoundBeforeRendering) {
  // A render with this number of samples would not end during the test.
  const std::string render = ABBE_BINARY " render " + ball() + " --spp 10000000 --quiet -o a.exr ";
  for (const char* place : {"/nowhere", "/proc", "$PWD/ball.json"}) {
    for (const char* output : {"--display {}/a.png", "--stats {}/a.json", "--checkpoint {}/a.abbepart",
                               "-o {}/b.exr", "-o {}/b.abbepart"}) {
      const std::string options = fmt::format(fmt::runtime(output), place);
      const std::string command =
          options.starts_with("-o ") ? ABBE_BINARY " render ball.json --spp 10000000 --quiet " : render;
      EXPECT_EQ(here(command + options).code, 5) << options;
    }
    ASSERT_EQ(here(ABBE_BINARY " render ball.json --quiet -o p.abbepart").code, 0);
    EXPECT_EQ(here(fmt::format(ABBE_BINARY " merge p.abbepart -o {}/a.exr", place)).code, 5);
  }
}

// The tasks of a job array run at the same time. A file that they share, other than the scene, would be
// locked by one of them.
TEST(Outputs, APartIsAllThatItsRenderWrites) {
  const fs::path folder = scratch() / "alone";
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::string scene = ball_scene();
  scene.insert(1, R"("output": {"image": "film.exr", "display": "picture.png"}, )");
  std::ofstream(folder / "scene.json") << scene;
  const FileLock film(folder / "film.exr");
  const FileLock picture(folder / "picture.png");
  const auto names = [&folder] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  };
  const std::string render = "cd alone && " ABBE_BINARY " render scene.json --quiet ";
  EXPECT_EQ(here(render).code, 5);
  std::set<std::string> expected = names();
  const Outcome run = here(render + "--sample-range 0:4 -o part.abbepart");
  EXPECT_EQ(run.code, 0) << run.err;
  expected.insert("part.abbepart");
  EXPECT_EQ(names(), expected);
  for (const char* picture : {"--display some.png", "--gamut some.png"}) {
    const Outcome refused = here(render + "--sample-range 4:8 -o more.abbepart " + picture);
    EXPECT_EQ(refused.code, 2) << picture;
    EXPECT_NE(refused.err.find("more.abbepart: is a partial film"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(names(), expected);
}

TEST(Outputs, ACheckpointThatIsAFolderIsNoCheckpoint) {
  fs::create_directories(scratch() / "folder.abbepart");
  const Outcome run =
      here(ABBE_BINARY " render " + ball() + " --quiet -o a.exr --checkpoint folder.abbepart --resume");
  EXPECT_EQ(run.code, 5);
  EXPECT_NE(run.err.find("folder.abbepart: is a folder"), std::string::npos) << run.err;
}

TEST(Merge, ReplacesNoPart) {
  const std::string part = ABBE_BINARY " render " + ball() + " --quiet --sample-range ";
  ASSERT_EQ(here(part + "0:4 -o one.abbepart").code, 0);
  ASSERT_EQ(here(part + "4:8 -o two.abbepart").code, 0);
  const std::string one = read_file(file("one.abbepart"));
  EXPECT_EQ(here(ABBE_BINARY " merge one.abbepart ./one.abbepart -o sum.abbepart").code, 4);
  EXPECT_EQ(here(ABBE_BINARY " merge one.abbepart two.abbepart nowhere.abbepart -o sum.abbepart").code, 4);
  EXPECT_EQ(here(ABBE_BINARY " merge two.abbepart one.abbepart -o ./one.abbepart").code, 2);
  EXPECT_EQ(read_file(file("one.abbepart")), one);
  ASSERT_EQ(here(ABBE_BINARY " merge one.abbepart two.abbepart -o sum.abbepart").code, 0);
  ASSERT_EQ(here(ABBE_BINARY " render ball.json --quiet -o all.abbepart").code, 0);
  EXPECT_EQ(read_file(file("sum.abbepart")), read_file(file("all.abbepart")));
}

TEST(Merge, CroppedRangesAddUp) {
  const std::string render = ABBE_BINARY " render " + ball() + " --quiet --crop 3,2,20,9 ";
  ASSERT_EQ(here(render + "--sample-range 0:3 -o a.abbepart").code, 0);
  ASSERT_EQ(here(render + "--sample-range 3:8 -o b.abbepart").code, 0);
  ASSERT_EQ(here(ABBE_BINARY " merge --crop 3,2,20,9 b.abbepart a.abbepart -o sum.exr").code, 0);
  ASSERT_EQ(here(render + "-o whole.exr").code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
}

// Every replicate may then differ. Only the remaining samples are rendered.
TEST(Merge, TenThousandRangesAreGoneOnWith) {
  ASSERT_EQ(
      here(ABBE_BINARY " render " + ball() + " --quiet --spp 20001 --sample-range 0:1 -o one.abbepart").code,
      0);
  std::string ranges = "samples: 0:1";
  for (int i = 1; i < 10000; ++i) ranges += fmt::format(",{}:{}", 2 * i, 2 * i + 1);
  PartFile file_of = read_part_file(file("one.abbepart"));
  file_of.header["samples"] = ranges.substr(9);
  write_part_file(file("many.abbepart"), file_of.header, file_of.bytes);
  const Outcome run = here(ABBE_BINARY
                           " render ball.json --quiet --spp 20001 --sample-range 19990:20001 --resume"
                           " --checkpoint many.abbepart -o many.exr");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_exr(file("many.exr")).metadata.at("samples_per_pixel"), "10006");
}

}  // namespace
}  // namespace abbe::test
