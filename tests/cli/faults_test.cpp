#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/part_file.h"
#include "io/picture.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// Effects of the machine on a render: full disks, signals, lack of memory, closed streams, foreign locales.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

/// An empty folder for the outputs of a test.
fs::path folder(const std::string& name) {
  fs::remove_all(scratch() / name);
  fs::create_directories(scratch() / name);
  return scratch() / name;
}
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Files that a render writes, by option. One of them may be on another disk.
using OutputFiles = std::vector<std::pair<std::string, std::string>>;
const OutputFiles kOutputs{{"-o", "film.exr"}, {"--display", "picture.png"}, {"--stats", "stats.json"}};
constexpr const char* kCheckpoint = "state.abbepart";

std::string render_command(const OutputFiles& outputs) {
  std::string command = ABBE_BINARY " render " + ball() + " --quiet";
  for (const auto& [option, name] : outputs) command += " " + option + " " + name;
  return command;
}
/// Outputs of an earlier render, without the checkpoint, which a render replaces only on request.
void put_old(const fs::path& there) {
  for (const auto& [option, name] : kOutputs) std::ofstream(there / name) << "old";
}

TEST(FullDisk, NoOldOutputIsLost) {
  const fs::path there = folder("full");
  put_old(there);
  for (const char* film : {"film.exr", "film.abbepart"}) {
    std::ofstream(there / film) << "old";
    OutputFiles outputs = kOutputs;
    outputs.front().second = film;
    // A partial film has no picture.
    if (fs::path(film).extension() == ".abbepart") outputs.erase(outputs.begin() + 1);
    outputs.emplace_back("--checkpoint", kCheckpoint);
    const Outcome run = shell("cd " + there.string() + "; (ulimit -f 0; " + render_command(outputs) +
                              "; echo $?) 2>&1 | cat");
    EXPECT_TRUE(run.out.ends_with("\n5\n")) << run.out;
    EXPECT_NE(run.out.find(std::string(film) + ": "), std::string::npos) << run.out;
    for (const auto& [option, name] : outputs)
      if (name != kCheckpoint) {
        EXPECT_EQ(read_file(there / name), "old") << name;
      }
  }
  EXPECT_EQ(names_in(there),
            (std::vector<std::string>{"film.abbepart", "film.exr", "picture.png", "stats.json"}));
}

// A film of 10 kB and sums of 36 kB do not fit. The picture and the statistics fit and must be written.
TEST(FullDisk, AnOutputThatFailsTakesNoOtherWithIt) {
  const fs::path there = folder("nearly_full");
  put_old(there);
  OutputFiles outputs = kOutputs;
  outputs.emplace_back("--checkpoint", kCheckpoint);
  const Outcome run = shell("cd " + there.string() + "; ulimit -f 8; " + render_command(outputs));
  EXPECT_EQ(run.code, 5) << run.err;
  EXPECT_EQ(read_file(there / "film.exr"), "old");
  EXPECT_EQ(read_picture(there / "picture.png").width, 24);
  EXPECT_EQ(nlohmann::json::parse(read_file(there / "stats.json"))["samples_per_pixel"], 8);
  for (const char* name : {"state.abbepart: ", "film.exr: "})
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
}

// A disk of 1 MB that is full, for one output after the other. Where the system does not allow mounting, the
// limits above replace it.
TEST(FullDisk, OfASmallFileSystem) {
  if (shell("unshare -Urm true").code != 0) return;
  OutputFiles all = kOutputs;
  all.emplace_back("--checkpoint", kCheckpoint);
  for (std::size_t full = 0; full < all.size(); ++full) {
    const fs::path there = folder("small_disk");
    fs::create_directory(there / "disk");
    OutputFiles outputs = all;
    const std::string name = all[full].second;
    outputs[full].second = "disk/" + name;
    const Outcome run =
        shell("cd " + there.string() +
              "; unshare -Urm sh -c 'mount -t tmpfs -o size=1M none disk; printf old > disk/" + name +
              "; dd if=/dev/zero of=disk/rest bs=4k 2>/dev/null; " +
              (name == kCheckpoint ? "rm disk/state.abbepart; " : "") + render_command(outputs) +
              "; echo $?; ls -A disk; head -c 9 disk/" + name + "'");
    const std::string left = name == kCheckpoint ? "rest\n"
                             : name < "rest"     ? name + "\nrest\nold"
                                                 : "rest\n" + name + "\nold";
    EXPECT_EQ(run.out, "5\n" + left) << run.err;
    EXPECT_NE(run.err.find("disk/" + name + ": "), std::string::npos) << run.err;
    for (const auto& [option, other] : all) EXPECT_EQ(fs::exists(there / other), other != name) << other;
  }
}

// The address space starts with the minimum for the program and grows until it renders.
TEST(Memory, TooLittleExitsWith6) {
  constexpr int kStepKb = 20000;
  const auto within = [](int kb, const std::string& arguments) {
    return shell(fmt::format("ulimit -v {}; exec " ABBE_BINARY " {}", kb, arguments));
  };
  int kb = 200000;
  while (within(kb, "--version").code != 0) kb += kStepKb;
  int refusals = 0;
  for (int code = 6; code != 0; kb += kStepKb) {
    fs::remove(file("a.exr"));
    const Outcome run = within(kb, "render " + ball() + " --quiet --threads 4 -o " + file("a.exr"));
    code = run.code;
    ASSERT_TRUE(code == 0 || code == 6) << kb << " kB: " << code << '\n' << run.err;
    EXPECT_EQ(fs::exists(file("a.exr")), code == 0);
    refusals += code == 6 ? 1 : 0;
  }
  EXPECT_GT(refusals, 0);
}

// Tracing paths again with all rays recorded, as `bench` does, would need 600 MB here.
TEST(Memory, StatsTraceNoPathsAgain) {
  const auto scene = scratch().write("deep.json", R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, 0, 0], "to": [0, 1, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [4, 3], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 1}}},
    "lights": [{"point": {"at": [0, 0, 0.5]}, "emission": {"spectrum": 1}}],
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "white"}],
    "render": {"samples": 2, "max_depth": 200, "roulette_depth": -1}})");
  const Outcome run = shell("ulimit -v 1000000; " ABBE_BINARY " render " + scene.string() +
                            " --quiet --threads 1 --stats - -o " + file("deep.exr"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(run.json()["embree_replay_share"].is_null());
}

// Lamps with the same spectrum, each of which would take 30 kB with a copy of its own.
TEST(Memory, ManyLampsTakeLittle) {
  std::string lamps;
  for (int i = 0; i < 20000; ++i)
    lamps += fmt::format(
        R"({}{{"point": {{"at": [{}, 3, 0]}}, "emission": {{"illuminant": "A", "intensity": {}}}}})",
        i == 0 ? "" : ",\n", i % 100, 1 + i % 1000);
  std::string scene = ball_scene();
  scene.insert(scene.find("\"lights\": [") + 11, lamps + ",");
  const auto path = scratch().write("lamps.json", scene);
  const Outcome run = shell("ulimit -v 1000000; " ABBE_BINARY " render " + path.string() +
                            " --quiet --threads 1 -o " + file("lamps.exr"));
  EXPECT_EQ(run.code, 0) << run.err;
}

// Too little memory for the film, and too little address space for the stacks of the threads.
TEST(Memory, TooLargeDemandsExitWith6) {
  fs::remove(file("a.exr"));
  const std::string render =
      "ulimit -v 1000000; " ABBE_BINARY " render " + ball() + " --quiet -o " + file("a.exr");
  for (const char* options : {" --set /sensor/resolution=[8000,8000]", " --threads 500"}) {
    const Outcome run = shell(render + options);
    EXPECT_EQ(run.code, 6) << options << '\n' << run.err;
    EXPECT_FALSE(fs::exists(file("a.exr")));
  }
}

TEST(Threads, AnyNumberGivesTheSameFile) {
  const auto sums = [](const std::string& threads) {
    const Outcome run =
        abbe("render " + ball() + " --quiet -o " + file("threads.abbepart") + " --threads " + threads);
    EXPECT_EQ(run.code, 0) << run.err;
    return read_file(file("threads.abbepart"));
  };
  const std::string one = sums("1");
  EXPECT_GT(one.size(), 24U * 16 * 3 * 2 * 16);
  for (const char* threads : {"0", "2", "64"}) EXPECT_EQ(sums(threads), one) << threads;
}

// A camera that sees a hundred nanometres of a floor, which a lamp illuminates from a picometre above. The
// values exceed the range of a film of this scene.
TEST(Samples, ThoseTheFilmCannotHoldAreCountedAndTheirPixelsKept) {
  const auto scene = scratch().write("near.json", R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 2e-4}, "from": [0, 1e-3, 2e-3], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [8, 6], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 0.8}}},
    "lights": [{"point": {"at": [0, 1e-12, 0]}, "emission": {"illuminant": "D65", "intensity": 1}}],
    "shapes": [{"quad": {"corner": [-1e3, 0, -1e3], "edge_u": [0, 0, 2e3], "edge_v": [2e3, 0, 0]}, "material": "white"}],
    "render": {"samples": 8}})");
  const std::string render =
      "render " + scene.string() + " --quiet -o " + file("near.exr") + " --stats " + file("near.stats");
  const Outcome run = abbe(render);
  EXPECT_EQ(run.code, 0) << run.err;
  const std::size_t dropped = nlohmann::json::parse(read_file(file("near.stats")))["nonfinite_samples"];
  EXPECT_GT(dropped, 0U);
  EXPECT_LT(dropped, 8U * 6 * 8);
  EXPECT_NE(run.err.find(fmt::format(
                "warning: {} samples were dropped: not finite, or larger than the film can hold", dropped)),
            std::string::npos)
      << run.err;
  const Image image = read_exr(file("near.exr"));
  float largest = 0;
  for (const float value : image.find("Y")->values) {
    EXPECT_TRUE(std::isfinite(value));
    largest = std::max(largest, value);
  }
  EXPECT_GT(largest, 0);
  EXPECT_EQ(abbe(render + " --strict").code, 70);
  EXPECT_EQ(read_exr(file("near.exr")).find("Y")->values, image.find("Y")->values);
}

// A pipe whose reader has closed it does not end a render, and a file never gets the number of a closed
// stream.
TEST(Streams, ClosedOrFullOnesEndNoRender) {
  for (const char* streams : {">&-", "2>&-", "2>/dev/full", "<&- >&- 2>&-", "2>&1 | true"}) {
    const std::string film = file("streams.exr");
    fs::remove(film);
    // `true` ends before the first line of progress.
    const Outcome run = shell("{ sleep 0.1; " ABBE_BINARY " render " + ball() + " -o " + film +
                              "; echo $? > " + file("code") + "; } " + streams);
    EXPECT_EQ(read_file(file("code")), "0\n") << streams << '\n' << run.err;
    ASSERT_TRUE(fs::exists(film)) << streams;
    EXPECT_EQ(read_exr(film).width, 24) << streams;
  }
}

TEST(Streams, AnAnswerThatNobodyGetsExitsWith5) {
  for (const char* streams : {">&-", "<&- >&- 2>&-", ">/dev/full 2>&-"}) {
    (void)shell("{ sleep 0.1; " ABBE_BINARY " query --list; echo $? > " + file("code") + "; } " + streams);
    EXPECT_EQ(read_file(file("code")), "5\n") << streams;
  }
}

// The reader ends early, as `head` does. `true` ends before the first word.
TEST(Streams, AReaderMayLeave) {
  for (const char* question : {"query --list", "query ior N-BK7 --at 500 --json", "help"}) {
    const Outcome run = shell(
        fmt::format("{{ sleep 0.1; " ABBE_BINARY " {}; echo $? > {}; }} | true", question, file("code")));
    EXPECT_EQ(read_file(file("code")), "0\n") << question;
    EXPECT_EQ(run.err, "") << question;
  }
}

// A locale with decimal commas and grouped thousands.
TEST(Locale, ChangesNothing) {
  const fs::path there = folder("locale");
  ASSERT_EQ(shell("localedef -i de_DE -f UTF-8 " + (there / "de_DE.UTF-8").string()).code, 0);
  const std::string german = "export LOCPATH=" + there.string() + " LC_ALL=de_DE.UTF-8; ";
  ASSERT_EQ(shell(german + "bash -c 'printf %.1f 1,5'").out, "1,5");
  for (const std::string arguments :
       {"query ior N-BK7 --at 486.1327,587.5618 --json", "query color --illuminant D65 --observer 1931",
        "query delta-e 50,2.6772,-79.7751 50,0,-82.7485",
        "calibrate --camera Nikon_D5100 --objective XYZ --json"}) {
    const Outcome plain = abbe(arguments);
    ASSERT_EQ(plain.code, 0) << plain.err;
    EXPECT_EQ(shell(german + ABBE_BINARY + " " + arguments).out, plain.out);
  }
  const auto written = [&](const std::string& environment, const std::string& name) {
    const fs::path to = folder(name);
    const Outcome run = shell(environment + "cd " + to.string() + "; " ABBE_BINARY " render " + ball() +
                              " --quiet --threads 1 --set /render/samples=2.0e1 --set /sensor/exposure_s=1.5 "
                              "-o film.exr --display a.png "
                              "--checkpoint sums.abbepart --stats stats.json; " ABBE_BINARY
                              " calibrate --camera Nikon_D5100 --objective XYZ -o nikon >/dev/null");
    EXPECT_EQ(run.code, 0) << run.err;
    return to;
  };
  const fs::path plain = written("", "plain");
  const fs::path other = written(german, "german");
  for (const char* name : {"film.exr", "a.png", "sums.abbepart"})
    EXPECT_EQ(read_file(other / name), read_file(plain / name)) << name;
  EXPECT_EQ(shell("diff -r " + (plain / "nikon").string() + " " + (other / "nikon").string()).out, "");
  EXPECT_EQ(nlohmann::json::parse(read_file(other / "stats.json"))["scene_sha256"],
            nlohmann::json::parse(read_file(plain / "stats.json"))["scene_sha256"]);
}

}  // namespace
}  // namespace abbe::test
