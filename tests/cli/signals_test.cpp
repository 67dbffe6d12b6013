#include <csignal>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/part_file.h"
#include "io/picture.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/tier.h"

// Signals while a render loads, renders and writes.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

std::string until(const std::string& condition) {
  return "; until " + condition + "; do sleep 0.01; done; ";
}
/// A render in the background with the process number $pid.
std::string started(const std::string& options) {
  return ABBE_BINARY " render " + ball() + " --quiet " + options + " & pid=$!";
}

struct Announcement {
  std::string name;  ///< Name for `kill`.
  int number;
};
const std::vector<Announcement> kAnnouncements{{"HUP", SIGHUP},   {"USR1", SIGUSR1}, {"USR2", SIGUSR2},
                                               {"XCPU", SIGXCPU}, {"ALRM", SIGALRM}, {"PWR", SIGPWR}};

// Terminals, batch systems and limits of CPU time announce the end by these signals, some of them repeatedly.
TEST(Signals, AnnouncementsOfTheEndLeaveAllAsARequestToEndDoes) {
  for (const auto& [name, number] : kAnnouncements) {
    const std::string film = file(name + ".exr");
    const std::string saved = file(name + ".abbepart");
    const Outcome run =
        shell(started("--spp 10000000 -o " + film + " --checkpoint " + saved + " --checkpoint-every 0.01s") +
              until("[ -e " + saved + " ]") + fmt::format("kill -{0} $pid; kill -{0} $pid; wait $pid", name));
    ASSERT_EQ(run.code, 128 + number) << name << '\n' << run.err;
    const std::string samples = read_part_file(saved).header.at("samples");
    EXPECT_EQ("0:" + read_exr(film).metadata.at("samples_per_pixel"), samples) << name;
  }
}

TEST(Signals, AnnouncementsThatTheCallerIgnoresAreIgnored) {
  std::string names;
  for (const auto& [name, number] : kAnnouncements) names += " " + name;
  const Outcome run = shell("trap ''" + names + "; " + started("--time 1s -o " + file("nohup.exr")) +
                            until("[ -e " + file(".nohup.exr.lock") + " ]") + "for name in" + names +
                            "; do kill -$name $pid; done; wait $pid");
  EXPECT_EQ(run.code, 0) << run.err;
}

// One pass over this film takes a thread at least half a second, and its checkpoint exists before. A SIGHUP
// does not count as a second signal.
TEST(Signals, ALongPassIsSavedAtOnceAndTheNextSignalKills) {
  const std::string film = file("long.exr");
  const std::string saved = file("long.abbepart");
  const std::string options = std::string("--spp 2 --threads 1 --set /sensor/resolution=") +
                              (nightly() ? "[1500,1000]" : "[750,500]") + " -o " + film;
  const Outcome run =
      shell(started(options + " --checkpoint " + saved) + until("[ -e " + file(".long.exr.lock") + " ]") +
            "kill -TERM $pid" + until("[ -e " + saved + " ]") +
            "kill -HUP $pid; sleep 0.1; kill -TERM $pid; wait $pid");
  EXPECT_EQ(run.code, 143) << run.err;
  EXPECT_FALSE(fs::exists(film));
  EXPECT_TRUE(read_part_file(saved).header.contains("unfinished"));
  const Outcome merged = abbe("merge " + saved + " -o " + film);
  EXPECT_EQ(merged.code, 4);
  EXPECT_NE(merged.err.find("samples 0:"), std::string::npos) << merged.err;
  const Outcome begun = abbe("merge --partial " + saved + " -o " + file("begun.exr"));
  EXPECT_EQ(begun.code, 0) << begun.err;
  const Outcome resumed = abbe("render " + ball() + " " + options + " --resume --checkpoint " + saved);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  const std::string pieces = read_file(film);
  ASSERT_EQ(abbe("render " + ball() + " --quiet " + options).code, 0);
  EXPECT_TRUE(read_file(film) == pieces);
}

// A signal ends the program as usual before any samples exist.
TEST(Signals, WhileAMeshLoadsLeaveNothing) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1000000\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n";
  for (int i = 0; i < 1000000; ++i) ply += "3 0 1 2\n";
  (void)scratch().write("mesh.ply", ply);
  const auto scene = scratch().write("mesh.json", scene_text(R"("white": {"diffuse": {"reflectance": 0.8}})",
                                                             R"({"mesh": "mesh.ply", "material": "white"})"));
  const fs::path there = scratch() / "loading";
  fs::create_directories(there);
  const Outcome run = shell("cd " + there.string() + "; " ABBE_BINARY " render " + scene.string() +
                            " --quiet --spp 10000000 -o a.exr --checkpoint a.abbepart & pid=$!; sleep 0.1; "
                            "kill -TERM $pid; wait $pid; echo $?; ls -A " +
                            there.string());
  EXPECT_EQ(run.out, "143\n") << run.err;
}

TEST(Signals, WhileOutputsAreWrittenLoseNone) {
  const int width = nightly() ? 1200 : 600;
  const std::string film = file("written.exr");
  const std::string picture = file("written.png");
  const Outcome run = shell(started(fmt::format("--spp 1 --set /sensor/resolution=[{},{}] -o {} --display {}",
                                                width, width * 2 / 3, film, picture)) +
                            "; until [ -e " + film + " ]; do :; done; kill -TERM $pid; wait $pid");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_exr(film).width, width);
  EXPECT_EQ(read_picture(picture).width, width);
}

}  // namespace
}  // namespace abbe::test
