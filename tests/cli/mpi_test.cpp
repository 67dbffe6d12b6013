#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "program.h"
#include "tests/tier.h"

namespace abbe::test {
namespace {

// Allows more processes than processors.
constexpr char kStart[] =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 {} mpirun --oversubscribe --bind-to none "
    "--quiet -n {} {}";

/// Command that renders with this number of processes.
std::string command(int processes, const std::string& arguments) {
  return fmt::format(kStart, "", processes, ABBE_BINARY " render " + arguments);
}

Outcome together(int processes, const std::string& arguments) {
  return shell(command(processes, arguments));
}

class Mpi : public testing::Test {
 protected:
  void SetUp() override {
    if (shell("command -v mpirun").code != 0 || !std::filesystem::exists(ABBE_MPI_MODULE_FILE))
      GTEST_SKIP() << "Open MPI is not installed";
  }
};

/// A scene with this number of pixels in each direction.
std::string scene(const std::string& name, int pixels = 64) {
  return fmt::format("{} --set /sensor/resolution=[{},{}]",
                     (data_directory() / "scenes" / (name + ".json")).string(), pixels, pixels);
}

void expect_same_bits(const std::string& arguments, const std::vector<int>& counts) {
  const auto part = scratch() / "one.abbepart";
  ASSERT_EQ(abbe(fmt::format("render {} --threads 1 --quiet -o {}", arguments, part.string())).code, 0);
  const std::string film = read_file(part);
  for (const int processes : counts) {
    const auto other = scratch() / fmt::format("of-{}.abbepart", processes);
    const Outcome run =
        together(processes, fmt::format("{} --threads 1 --quiet -o {}", arguments, other.string()));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(read_file(other) == film) << arguments << " by " << processes << " processes";
    std::filesystem::remove(other);
  }
  std::filesystem::remove(part);
}

TEST_F(Mpi, AnyNumberOfProcessesGivesTheSameBits) {
  const std::vector<int> all{1, 2, 3, 5};
  expect_same_bits(scene("cornell") + " --spp 12", nightly() ? all : std::vector{3});
  expect_same_bits(scene("prism_spot") + " --spp 12", nightly() ? std::vector{2, 3} : std::vector{2});
}

TEST_F(Mpi, StatsAreOfAllProcesses) {
  const auto film = scratch() / "film.abbepart";
  const std::string arguments = fmt::format("{} --spp {} --threads 1 --quiet -o {} --stats -",
                                            scene("furnace", 16), nightly() ? 1024 : 512, film.string());
  const nlohmann::json alone = abbe("render " + arguments).json();
  const nlohmann::json mpi_group = together(3, arguments).json();
  EXPECT_EQ(alone["processes"], 1);
  EXPECT_EQ(mpi_group["processes"], 3);
  EXPECT_EQ(mpi_group["threads"], 1);
  EXPECT_EQ(mpi_group["paths"], alone["paths"]);
  EXPECT_EQ(mpi_group["rays"], alone["rays"]);
  EXPECT_GT(mpi_group["cpu_s"], 0.75 * alone["cpu_s"].get<double>()) << "for the same work";
}

TEST_F(Mpi, AnErrorAskedForEndsAtTheSameSample) {
  expect_same_bits(scene("cornell") + " --error 24%", nightly() ? std::vector{2, 3} : std::vector{3});
}

TEST_F(Mpi, ALostProcessEndsAllAndLosesNoCheckpoint) {
  const std::string save = (scratch() / "at.abbepart").string();
  const std::string whole =
      fmt::format("{} --spp {} --threads 1 --quiet", scene("cornell"), nightly() ? 200 : 120);
  const std::string saving = fmt::format("{} --checkpoint {} --checkpoint-every 0.1s", whole, save);
  const Outcome lost =
      shell(command(2, saving + " -o " + (scratch() / "lost.exr").string()) + " & pid=$!; while [ ! -e " +
            save + " ]; do sleep 0.05; done; kill -9 $(pgrep -P $pid | tail -n 1); wait $pid");
  EXPECT_NE(lost.code, 0);
  ASSERT_TRUE(std::filesystem::exists(save));
  const auto film = scratch() / "film.abbepart";
  EXPECT_EQ(together(3, saving + " --resume -o " + film.string()).code, 0);
  const auto alone = scratch() / "alone.abbepart";
  EXPECT_EQ(abbe("render " + whole + " -o " + alone.string()).code, 0);
  EXPECT_TRUE(read_file(film) == read_file(alone));
}

void expect_told_once(const Outcome& run, int code, const std::string& complaint) {
  EXPECT_EQ(run.code, code);
  const std::size_t first = run.err.find(complaint);
  ASSERT_NE(first, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find(complaint, first + 1), std::string::npos) << run.err;
}

TEST_F(Mpi, WhatIsWrongIsToldOnce) {
  expect_told_once(together(3, "nowhere.json"), 4, "nowhere.json: error: cannot open the file");
}

/// Renders with two processes that have different command lines, and ends them after a minute.
Outcome apart(const std::string& first, const std::string& second) {
  const std::string shell_of_each = "sh -c 'if [ $OMPI_COMM_WORLD_RANK = 0 ]; then exec " ABBE_BINARY
                                    " render " +
                                    first + "; else exec " ABBE_BINARY " render " + second + "; fi'";
  return shell(fmt::format(kStart, "timeout 60", 2, shell_of_each));
}

// The sum of two different films is no valid film.
TEST_F(Mpi, ProcessesThatRenderSomethingElseAreRefused) {
  const std::string film = (scratch() / "mixed.abbepart").string();
  const std::string start = (scratch() / "start.abbepart").string();
  const std::string each = " --threads 1 --quiet -o " + film;
  const std::string whole = scene("furnace", 16) + " --spp 64";
  ASSERT_EQ(abbe("render " + whole + " --threads 1 --quiet --sample-range 0:3 -o " + start).code, 0);
  for (const std::string& other :
       {scene("furnace", 16) + " --set /materials/wall/diffuse/reflectance=0.7 --spp 64",
        scene("furnace", 20) + " --spp 64", scene("furnace", 16) + " --spp 65", whole + " --seed 7",
        whole + " --sample-range 0:32", whole + " --crop 0,0,8,16", whole + " --integrator light",
        scene("furnace", 16) + " --time 9s", scene("furnace", 16) + " --error 1%", whole + " --aov depth",
        whole + " --checkpoint " + start + " --resume"}) {
    expect_told_once(apart(whole + each, other + each), 4, "mpirun: process 1 does not render the same film");
    EXPECT_FALSE(std::filesystem::remove(film)) << other;
  }
}

TEST_F(Mpi, ProcessesMayDifferInWhatChangesNoFilm) {
  const std::string whole = scene("cornell", 24) + " --spp 64";
  const auto film = scratch() / "first.abbepart";
  const auto alone = scratch() / "alone.abbepart";
  ASSERT_EQ(abbe("render " + whole + " --threads 1 --quiet -o " + alone.string()).code, 0);
  const Outcome run = apart(whole + " --threads 1 --quiet -o " + film.string(),
                            whole + " --threads 2 -o " + (scratch() / "second.abbepart").string());
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(read_file(film) == read_file(alone));
}

TEST_F(Mpi, TheSceneComesFromAFile) {
  const std::string read = " < " + (data_directory() / "scenes/furnace.json").string();
  const std::string film = " --spp 1 --quiet -o " + (scratch() / "read.exr").string() + read;
  expect_told_once(together(2, "-" + film), 2, "<stdin>: is available to the root process only");
  EXPECT_EQ(together(1, "-" + film).code, 0);
}

}  // namespace
}  // namespace abbe::test
