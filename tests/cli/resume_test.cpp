#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/part_file.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"
#include "tests/source_tree.h"
#include "tests/tier.h"

// Partial films, checkpoints and interruptions from the point of view of a user.

namespace abbe::test {
namespace {

std::string part_of_ball(const std::string& name, const std::string& options) {
  return part_of(ball(), name, options);
}

TEST(Merge, PartsAreTheFileOfTheWholeRender) {
  const std::string whole = part_of_ball("whole", "");
  const std::string parts = part_of_ball("b", "--sample-range 5:8 --threads 1") + " " +
                            part_of_ball("a", "--sample-range 0:2") + " " +
                            part_of_ball("c", "--sample-range 2:5");
  ASSERT_EQ(merged(parts, file("sum.abbepart")).code, 0);
  EXPECT_EQ(read_file(file("sum.abbepart")), read_file(whole));
  ASSERT_EQ(merged(parts, file("sum.exr")).code, 0);
  ASSERT_EQ(abbe("render " + ball() + " --quiet -o " + file("whole.exr")).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
  EXPECT_EQ(read_exr(file("sum.exr")).metadata.at("samples_per_pixel"), "8");
}

TEST(Merge, RefusesPartsOfOtherRenders) {
  const std::string a = part_of_ball("a", "--sample-range 0:2");
  const auto refusal = [&a](const std::string& other) {
    const Outcome run = merged(a + " " + other, file("no.exr"));
    EXPECT_EQ(run.code, 4) << run.err;
    EXPECT_FALSE(std::filesystem::exists(file("no.exr")));
    return run.err;
  };
  const auto names = [](const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
  };
  EXPECT_TRUE(
      names(refusal(part_of_ball("seed", "--seed 3 --sample-range 2:4")), "another seed (got 3, allowed 0)"));
  EXPECT_TRUE(
      names(refusal(part_of_ball("set", "--set /render/max_depth=3 --sample-range 2:4")), "scene_sha256"));
  EXPECT_TRUE(names(refusal(part_of_ball("spp", "--spp 64 --sample-range 2:4")),
                    "another replicates (got 4, allowed 2)"));
  EXPECT_TRUE(
      names(refusal(part_of_ball("path", "--integrator light --sample-range 2:4")), "another integrator"));
  EXPECT_TRUE(names(refusal(a), "has samples that are already included (got 0:2)"));
  PartFile older = read_part_file(part_of_ball("old", "--sample-range 2:4"));
  for (const char* key : {"version", "data_sha256", "exposure_s", "scene_sha256", "seed", "integrator",
                          "replicates", "channel.Y", "build", "instruction_set"}) {
    PartFile other = older;
    ASSERT_TRUE(other.header.contains(key)) << key;
    other.header[key] = "0.0.9";
    write_part_file(file("other.abbepart"), other.header, other.bytes);
    EXPECT_TRUE(names(refusal(file("other.abbepart")), fmt::format("another {} (got 0.0.9", key)));
  }
  PartFile vast = older;  // its sums would have 2^64 bytes, which overflows to its 0 bytes
  vast.header["film"] = "65536 65536 16384 16384 0 0 1";
  std::string planes = "plane";
  for (int i = 1; i < 16384; ++i) planes += ",plane";
  vast.header["sensor_channels"] = planes;
  write_part_file(file("vast.abbepart"), vast.header, "");
  EXPECT_TRUE(names(refusal(file("vast.abbepart")), "vast.abbepart: holds no part of a render"));
  older.header.erase("samples");
  write_part_file(file("old.abbepart"), older.header, older.bytes);
  EXPECT_TRUE(names(refusal(file("old.abbepart")), "holds no part of a render"));
  EXPECT_TRUE(names(refusal(ball()), "not a part file"));
  EXPECT_TRUE(names(refusal("/nowhere/b.abbepart"), "no such file"));
}

TEST(Merge, SaysWhichOfTheStatedSamplesAreMissing) {
  const std::string parts =
      part_of_ball("a", "--sample-range 1:3") + " " + part_of_ball("b", "--sample-range 5:7");
  std::filesystem::remove(file("gaps.exr"));
  const Outcome refused = merged(parts, file("gaps.exr"));
  EXPECT_EQ(refused.code, 4);
  EXPECT_NE(refused.err.find("gaps.exr: samples 0:1,3:5,7:8 are missing"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(file("gaps.exr")));
  const Outcome partial = merged(parts, file("gaps.exr") + " --partial");
  EXPECT_EQ(partial.code, 0) << partial.err;
  EXPECT_NE(partial.err.find("samples 1:3,5:7 of every pixel; missing: samples 0:1,3:5,7:8"),
            std::string::npos);
  EXPECT_EQ(read_exr(file("gaps.exr")).metadata.at("samples_per_pixel"), "4");
  EXPECT_EQ(read_exr(file("gaps.exr")).metadata.at("samples_stated"), "8");
}

// The sum of some parts is a part that records the number of samples of the whole render.
TEST(Merge, AddsUpInATree) {
  const auto sum_of = [](const std::string& parts, const std::string& name) {
    const Outcome run = merged(parts, file(name) + " --partial");
    EXPECT_EQ(run.code, 0) << run.err;
    return file(name);
  };
  const std::string left =
      sum_of(part_of_ball("c", "--sample-range 4:6") + " " + part_of_ball("a", "--sample-range 0:2"),
             "left.abbepart");
  const std::string right =
      sum_of(part_of_ball("b", "--sample-range 2:4") + " " + part_of_ball("d", "--sample-range 6:8"),
             "right.abbepart");
  EXPECT_EQ(merged(left, file("tree.abbepart")).code, 4);
  ASSERT_EQ(merged(right + " " + left, file("tree.abbepart") + " -o " + file("tree.exr")).code, 0);
  EXPECT_EQ(read_file(file("tree.abbepart")), read_file(part_of_ball("whole", "")));
  ASSERT_EQ(abbe("render " + ball() + " --quiet -o " + file("whole.exr")).code, 0);
  EXPECT_EQ(read_file(file("tree.exr")), read_file(file("whole.exr")));
}

// A render that was finished and extended later is complete at the largest number of samples that its parts
// state.
TEST(Merge, TheLargestStatedNumberHolds) {
  const std::string first = part_of_ball("first", "--spp 128");
  const std::string more = part_of_ball("more", "--spp 192 --sample-range 128:160");
  const std::string rest = part_of_ball("rest", "--spp 192 --sample-range 160:192");
  EXPECT_EQ(merged(first, file("sum.abbepart")).code, 0);
  for (const std::string& parts : {first + " " + more, more + " " + first}) {
    const Outcome run = merged(parts, file("no.abbepart"));
    EXPECT_NE(run.err.find("samples 160:192 are missing"), std::string::npos) << run.err;
  }
  EXPECT_EQ(merged(first + " " + rest + " " + more, file("sum.abbepart")).code, 0);
  EXPECT_EQ(read_file(file("sum.abbepart")), read_file(part_of_ball("all", "--spp 192")));
}

// A render with a time limit records no number of samples.
TEST(Merge, WhatTimeEndedIsComplete) {
  const std::string timed = part_of_ball("timed", "--time 0.01s");
  EXPECT_FALSE(read_part_file(timed).header.contains("samples_stated"));
  EXPECT_EQ(merged(timed, file("timed.exr")).code, 0);
}

TEST(Resume, WhatACheckpointHoldsIsTold) {
  const std::string saved = file("saved.abbepart");
  const auto told = [&saved](const std::string& samples, const std::string& unfinished) {
    PartFile part = read_part_file(part_of_ball("one", "--sample-range 0:2"));
    part.header["samples"] = samples;
    if (!unfinished.empty()) part.header["unfinished"] = unfinished;
    write_part_file(saved, part.header, part.bytes);
    const Outcome run =
        abbe("render " + ball() + " --resume --checkpoint " + saved + " -o " + file("on.exr"));
    EXPECT_EQ(run.code, 0) << run.err;
    return run.err.substr(0, run.err.find('\n'));
  };
  const std::string begin = "abbe: " + saved + ": continuing after ";
  EXPECT_EQ(told("0:2", ""), begin + "samples 0:2");
  EXPECT_EQ(told("0:1", "1 2 1"), begin + "samples 0:1 and a part of the next");
  EXPECT_EQ(told("", "0 2 1"), begin + "a part of the first sample");
}

// A file has another name until the process that writes it has finished.
TEST(Merge, ReadsPartsWhileOthersAreWritten) {
  const std::string a = part_of_ball("part-0", "--sample-range 0:4");
  const std::string b = part_of_ball("part-4", "--sample-range 4:8");
  const std::string torn = file(".part-4.abbe-1-0.abbepart");
  std::filesystem::rename(b, torn);
  std::filesystem::resize_file(torn, 1000);
  const Outcome by_pattern = merged(file("part-*.abbepart"), file("early.exr"));
  EXPECT_NE(by_pattern.err.find("samples 4:8 are missing"), std::string::npos) << by_pattern.err;
  const Outcome by_name = merged(a + " " + b + " " + file("part-8.abbepart"), file("early.exr"));
  EXPECT_EQ(by_name.code, 4);
  EXPECT_NE(by_name.err.find(b + ", " + file("part-8.abbepart") + ": no such file"), std::string::npos)
      << by_name.err;
  std::filesystem::remove(torn);
  std::filesystem::remove(a);
}

TEST(Merge, UsageErrors) {
  const std::string render = "render " + ball() + " -o " + file("no.exr") + " ";
  for (const char* options :
       {"--sample-range 4:4", "--sample-range 4", "--sample-range -1:4", "--sample-range 0:9",
        "--sample-range 0:4 --error 3%", "--sample-range 0:4 --time 3s", "--resume", "--checkpoint-every 3s"})
    EXPECT_EQ(abbe(render + options).code, 2) << options;
  EXPECT_EQ(abbe("merge -o " + file("no.exr")).code, 2);
  EXPECT_EQ(merged(part_of_ball("a", "--sample-range 0:2"), file("no.png")).code, 2);
  EXPECT_EQ(merged(part_of_ball("a", "--sample-range 0:2"), "/nowhere/no.exr").code, 5);
}

/// A render with checkpoints that takes about one second.
class Checkpoint : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(checkpoint_);
    std::filesystem::remove(film_);
  }

  [[nodiscard]] std::string command(const std::string& options) const {
    return "render " + scene_ + " --quiet --checkpoint " + checkpoint_ + " --checkpoint-every 0.01s -o " +
           film_ + " --spp " + options;
  }
  // Film of an uninterrupted render, and its time [s].
  double render_calmly() const {
    const Outcome run =
        abbe("render " + scene_ + " --spp 4096 --quiet -o " + calm_ + " --stats " + file("calm.json"));
    EXPECT_EQ(run.code, 0) << run.err;
    return nlohmann::json::parse(read_file(file("calm.json")))["wall_s"];
  }

  const std::string scene_ = ball();
  const std::string checkpoint_ = file("checkpoint.abbepart");
  const std::string film_ = file("film.exr");
  const std::string calm_ = file("calm.exr");
};

TEST_F(Checkpoint, KillsChangeNoBit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> delay(0, 1.3 * render_calmly());
  int kills = 0;
  int interrupted = 0;
  while (kills < (nightly() ? 20 : 4)) {
    // By day few renders are killed, so the first must have a checkpoint.
    const std::string soon = kills == 0 && !nightly()
                                 ? "until [ -e " + checkpoint_ + " ]; do sleep 0.01; done"
                                 : "sleep " + std::to_string(delay(random));
    const Outcome run =
        shell(ABBE_BINARY " " + command("4096 --resume & pid=$!; " + soon + "; kill -9 $pid; wait $pid"));
    kills += run.code == 137 ? 1 : 0;
    if (std::filesystem::exists(film_)) {  // complete or absent
      EXPECT_EQ(read_file(film_), read_file(calm_));
      std::filesystem::remove(film_);
      std::filesystem::remove(checkpoint_);
    } else if (std::filesystem::exists(checkpoint_)) {
      EXPECT_NE(read_part_file(checkpoint_).header.at("samples"), "");
      ++interrupted;
    }
  }
  EXPECT_GT(interrupted, nightly() ? 2 : 0);
  const Outcome last = abbe(command("4096 --resume"));
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(read_file(film_), read_file(calm_));
  for (const auto& entry : std::filesystem::directory_iterator(scratch() / ""))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

TEST_F(Checkpoint, SignalsEndWithAValidOneAndResumeGoesOn) {
  render_calmly();
  const Outcome stopped =
      shell(ABBE_BINARY " " + command("4096 & pid=$!; until [ -e " + checkpoint_ +
                                      " ]; do sleep 0.01; done; kill -TERM $pid; wait $pid"));
  EXPECT_EQ(stopped.code, 143) << stopped.err;
  const PartFile saved = read_part_file(checkpoint_);
  EXPECT_NE(saved.header.at("samples"), "0:4096");
  EXPECT_EQ(read_exr(film_).metadata.at("samples_per_pixel"), saved.header.at("samples").substr(2));
  EXPECT_EQ(abbe(command("4096 --resume")).code, 0);
  EXPECT_EQ(read_file(film_), read_file(calm_));
}

TEST_F(Checkpoint, OthersAreRefusedAndKept) {
  ASSERT_EQ(abbe(command("128 --sample-range 0:64")).code, 0);
  const std::string good = read_file(checkpoint_);
  EXPECT_EQ(abbe(command("128")).code, 5);  // an existing checkpoint is not overwritten
  for (const char* other : {"128 --seed 4", "128 --set /render/max_depth=2", "16", "128 --crop 0,0,3,3"}) {
    const Outcome run = abbe(command("") + other + " --resume");
    EXPECT_EQ(run.code, 4) << other;
    EXPECT_NE(run.err.find("belongs to another render"), std::string::npos) << run.err;
  }
  EXPECT_EQ(read_file(checkpoint_), good);
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  for (const std::string& bad : {good.substr(0, good.size() - 1), flipped, std::string()}) {
    const auto path = scratch().write("checkpoint.abbepart", bad);
    EXPECT_EQ(abbe(command("128 --resume")).code, 4);
    EXPECT_EQ(read_file(path), bad);
  }
}

TEST_F(Checkpoint, TakesMoreSamplesAfterItsOwn) {
  ASSERT_EQ(abbe(command("256 --sample-range 0:100")).code, 0);
  ASSERT_EQ(abbe(command("128 --sample-range 110:120 --resume")).code,
            0);  // the number of replicates is equal
  EXPECT_EQ(read_part_file(checkpoint_).header.at("samples"), "0:100,110:120");
  ASSERT_EQ(abbe(command("256 --resume")).code, 0);
  ASSERT_EQ(abbe("render " + scene_ + " --spp 256 --quiet -o " + calm_).code, 0);
  EXPECT_EQ(read_file(film_), read_file(calm_));
}

TEST_F(Checkpoint, OneThatCannotBeWrittenIsToldAndDoesNotStopTheRender) {
  const Outcome run = shell(ABBE_BINARY " " + command("10000000 & pid=$!; until [ -e ") + checkpoint_ +
                            " ]; do sleep 0.01; done; rm " + checkpoint_ + "; mkdir " + checkpoint_ +
                            "; until grep -q warning " + file("stderr") +
                            " || ! kill -0 $pid; do sleep 0.01; done; kill -TERM $pid; wait $pid");
  EXPECT_NE(run.err.find("warning: the checkpoint was not written: "), std::string::npos) << run.err;
  EXPECT_EQ(run.code, 5) << run.err;  // the last checkpoint must be written
}

TEST_F(Checkpoint, TwoWritersOfOneOutputAreOneTooMany) {
  const std::string picture = file("two.png");
  const std::string stats = file("two.json");
  const std::string second = "; " ABBE_BINARY " render " + scene_ + " --spp 1 --quiet -o ";
  std::string writers =
      "; " ABBE_BINARY " merge " + part_of_ball("two", "--sample-range 0:2") + " -o " + film_ + "; echo $?";
  for (const std::string& output :
       {film_, file("own.exr") + " --display " + picture, file("own.exr") + " --stats " + stats,
        file("own.exr") + " --resume --checkpoint " + checkpoint_})
    writers += second + output + "; echo $?";
  const Outcome run =
      shell(ABBE_BINARY " " +
            command("10000000 --display " + picture + " --stats " + stats + " & pid=$!; until [ -e ") +
            checkpoint_ + " ]; do sleep 0.01; done" + writers + "; kill -9 $pid");
  EXPECT_EQ(run.out, "5\n5\n5\n5\n5\n") << run.err;
  for (const std::string& output : {film_, picture, stats, checkpoint_})
    EXPECT_NE(run.err.find(output + ": another process is writing it"), std::string::npos) << run.err;
}

// A film must contain the requested samples and no others.
TEST(Resume, RefusesACheckpointOfMoreSamplesThanAreAskedFor) {
  const std::string saving =
      " --checkpoint " + file("longer.abbepart") + " -o " + file("longer.exr") + " --quiet";
  ASSERT_EQ(abbe("render " + ball() + saving).code, 0);
  const Outcome fewer = abbe("render " + ball() + saving + " --resume --spp 4");
  EXPECT_EQ(fewer.code, 4);
  EXPECT_NE(fewer.err.find("longer.abbepart: contains samples that are not requested (got 0:8, allowed 0:4)"),
            std::string::npos)
      << fewer.err;
  EXPECT_EQ(abbe("render " + ball() + saving + " --resume").code, 0);
}

}  // namespace
}  // namespace abbe::test
