#include <sys/stat.h>

#include <cstring>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/data_directory.h"
#include "io/exr.h"
#include "io/inputs.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// Commands never overwrite their inputs, whatever their names, and use no more memory than allowed.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

/// A folder with a scene and all kinds of files that it names.
class InputFiles : public ::testing::Test {
 protected:
  InputFiles() : folder_(scratch() / "inputs") {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
    write_exr(folder_ / "wall.exr", {2, 1, {{"a", {0.25F, 1}}}, {}});
    write("lamp.csv", "# unit: W/(m2 sr nm)\n# outside: zero\nwavelength_nm,L\n400,1\n700,3\n");
    write("chair.mtl", "newmtl wood\nKd 0.4 0.2 0.1\n");
    write("chair.obj", "mtllib chair.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("wall.json", R"({"abbe": 1, "units": "mm",
      "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -300, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
      "sensor": {"resolution": [8, 6], "observer": "1931"},
      "materials": {"wall": {"diffuse": {"reflectance": {"image": "wall.exr", "weights": {"a": 0.8}}}}},
      "lights": [{"environment": {}, "emission": {"spectrum": "lamp.csv"}}],
      "shapes": [{"mesh": "chair.obj"}, {"sphere": {"center": [0, 0, 0], "radius": 50}, "material": "wall"}],
      "render": {"samples": 2}})");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] Outcome here(const std::string& command) const {
    return shell("cd " + folder_.string() + " && " + command);
  }
  // Commands must not change the file that they would overwrite.
  void expect_kept(const std::string& command, const std::string& input) const {
    const std::string before = read_file(folder_ / input);
    const Outcome run = here(ABBE_BINARY " " + command);
    EXPECT_EQ(run.code, 2) << command << '\n' << run.err;
    EXPECT_NE(run.err.find("is the same file as"), std::string::npos) << command << '\n' << run.err;
    EXPECT_EQ(read_file(folder_ / input), before) << command;
    EXPECT_FALSE(before.empty()) << input;
  }

  // A hundred nodes with one mesh of 10,000 triangles: 360 KB of numbers that become 84 MB.
  void write_repeated_gltf() const {
    constexpr int kVertices = 30000;
    std::string positions(std::size_t{kVertices} * 3 * sizeof(float), '\0');
    for (std::size_t i = 0; i < std::size_t{kVertices} * 3; ++i) {
      const auto x = static_cast<float>(i * i % 97);
      std::memcpy(&positions[i * sizeof x], &x, sizeof x);
    }
    write("many.bin", positions);
    std::string nodes = R"({"mesh": 0})";
    std::string roots = "0";
    for (int i = 1; i < 100; ++i) {
      nodes += R"(, {"mesh": 0})";
      roots += fmt::format(", {}", i);
    }
    write("many.gltf", fmt::format(R"({{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [{}]}}],
      "nodes": [{}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
      "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}}],
      "bufferViews": [{{"buffer": 0, "byteLength": {}}}],
      "buffers": [{{"byteLength": {}, "uri": "many.bin"}}]}})",
                                   roots, nodes, kVertices, positions.size(), positions.size()));
  }

  fs::path folder_;
};

TEST_F(InputFiles, AreNotRenderedOver) {
  fs::create_hard_link(folder_ / "wall.exr", folder_ / "hard.exr");
  fs::create_symlink("wall.exr", folder_ / "soft.exr");
  expect_kept("render wall.json --quiet", "wall.exr");  // default name of the film
  for (const char* name : {"hard.exr", "soft.exr", "sub/../wall.exr", "$PWD/wall.exr"})
    expect_kept(fmt::format("render wall.json --quiet -o {}", name), "wall.exr");
  for (const char* name : {"lamp.csv", "chair.obj", "chair.mtl", "wall.json", "wall.exr"})
    expect_kept(fmt::format("render wall.json --quiet -o a.exr --stats {}", name), name);
  ASSERT_EQ(here(ABBE_BINARY " render wall.json --quiet -o a.exr --stats a.json --display a.png").code, 0);
  EXPECT_EQ(here(ABBE_BINARY " render wall.json --quiet -o a.exr --stats a.json --display a.png").code, 0);
}

TEST_F(InputFiles, TablesAndConfigurationsAreNotRenderedOver) {
  fs::copy(data_directory(), folder_ / "data", fs::copy_options::recursive);
  const std::string before = read_file(folder_ / "data/illuminant/cie_D65.csv");
  const Outcome run = here("ABBE_DATA=$PWD/data " ABBE_BINARY
                           " render wall.json --quiet -o a.exr --stats data/illuminant/cie_D65.csv");
  EXPECT_EQ(run.code, 2) << run.err;
  EXPECT_EQ(read_file(folder_ / "data/illuminant/cie_D65.csv"), before);
  ASSERT_EQ(here(ABBE_BINARY " calibrate --camera observer:1931 -o users").code, 0);
  expect_kept(
      "render wall.json --quiet -o a.exr --display a.png --ocio users/config.ocio "
      "--stats users/config.ocio",
      "users/config.ocio");
}

// The colours of pictures are fitted to the patches of this table, those of films are not.
TEST_F(InputFiles, FilmsAndPartsNeedNoChart) {
  fs::copy(data_directory(), folder_ / "data", fs::copy_options::recursive);
  ASSERT_EQ(fs::remove(folder_ / "data/reflectance/colorchecker24_babelcolor_average.csv"), true);
  for (const char* file : {"a.exr", "a.abbepart"}) {
    const Outcome run = here(fmt::format(
        "ABBE_DATA=$PWD/data " ABBE_BINARY
        " render wall.json --quiet --spp 1 -o {} --set "
        R"('/sensor={{"resolution":[2,1],"channels":{{"a":{{"band":[400,500]}},"b":{{"band":[500,600]}},"c":{{"band":[600,700]}}}}}}')",
        file));
    EXPECT_EQ(run.code, 0) << run.err;
  }
}

TEST_F(InputFiles, AreKeptByEveryCommand) {
  ASSERT_EQ(here(ABBE_BINARY " render wall.json --quiet -o one.abbepart --sample-range 0:1").code, 0);
  ASSERT_EQ(here(ABBE_BINARY " render wall.json --quiet -o two.abbepart --sample-range 1:2").code, 0);
  fs::create_hard_link(folder_ / "one.abbepart", folder_ / "hard.abbepart");
  expect_kept("merge one.abbepart two.abbepart -o hard.abbepart", "one.abbepart");
  ASSERT_EQ(here(ABBE_BINARY " render wall.json --quiet -o film.exr").code, 0);
  fs::create_hard_link(folder_ / "film.exr", folder_ / "hard.exr");
  expect_kept("develop film.exr -o hard.exr", "film.exr");
  fs::create_directories(folder_ / "maps");
  fs::copy_file(folder_ / "film.exr", folder_ / "maps/relative_error.png");
  expect_kept("compare film.exr maps/relative_error.png --maps maps", "maps/relative_error.png");
  write("paint.json", R"({"diffuse": {"reflectance": 0.5}})");
  expect_kept("lab paint.json --plot sub/../paint.json", "paint.json");
  expect_kept("lab wall.json:wall --plot wall.exr", "wall.exr");
  fs::create_directories(folder_ / "users");
  write("users/report.json", "{}");
  expect_kept("calibrate --camera users/report.json -o users", "users/report.json");
  write("users/bench.json", "{}");
  expect_kept("bench cornell --baseline users/bench.json -o users", "users/bench.json");
}

TEST_F(InputFiles, HaveTheirValuesReplacedForEveryCommandThatReadsAScene) {
  const auto told = [this](const std::string& command) {
    const Outcome run = here(ABBE_BINARY " " + command);
    EXPECT_EQ(run.code, 0) << run.err;
    return run.out + read_file(folder_ / "a.svg");
  };
  for (const char* command :
       {"info wall.json", "info wall.json --json", "convert wall.json",
        "trace wall.json --lambda 550 --origin 0,-300,0 --dir 0,1,0", "draw wall.json --rays 0 -o a.svg"}) {
    const std::string before = told(command);
    EXPECT_NE(told(command + std::string(" --set /sensor/resolution=[7,5] --set /shapes/1/sphere/radius=70")),
              before)
        << command;
    EXPECT_EQ(told(command), before) << command;
  }
}

TEST_F(InputFiles, TakeNoMoreMemoryThanAllowed) {
  const auto refused = [this](const std::string& command, const std::string& what) {
    const Outcome run = here(ABBE_BINARY " " + command);
    EXPECT_EQ(run.code, 6) << command << '\n' << run.err;
    EXPECT_NE(run.err.find(what), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--max-memory"), std::string::npos) << run.err;
  };
  const Image large{1000, 1000, {{"a", std::vector<float>(1000000, 0.5F)}}, {}};
  write_exr(folder_ / "wall.exr", large);
  for (const char* command : {"render", "info"})
    refused(fmt::format("{} wall.json --max-memory 3M", command), "wall.exr");
  refused("lab wall.json:wall --max-memory 3M", "wall.exr");
  refused("render wall.json --quiet -o a.exr --set /sensor/resolution=[1000,1000] --max-memory 20M", "film");
  refused("compare wall.exr wall.exr --max-memory 6M", "wall.exr");
  // Memory of a mesh is counted while it is read: a small file may expand to much data or name large files.
  const auto with_mesh = [this](const char* name) {
    write("mesh.json", fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [2, 2], "observer": "1931"}},
      "materials": {{"wall": {{"diffuse": {{"reflectance": 0.5}}}}}},
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "shapes": [{{"mesh": "{}", "material": "wall"}}]}})",
                                   name));
  };
  write_repeated_gltf();
  with_mesh("many.gltf");
  refused("info mesh.json --max-memory 20M", "many.gltf");
  EXPECT_LT(fs::file_size(folder_ / "many.gltf"), 10000U);
  fs::resize_file(folder_ / "many.bin", 30000000);
  refused("info mesh.json --max-memory 20M", "many.bin");
  std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 200000; ++i) corners += fmt::format(" {}", 1 + i % 3);
  write("fan.obj", corners + "\n");
  with_mesh("fan.obj");
  refused("info mesh.json --max-memory 2M", "fan.obj");
  // The header declares the size. The file contains no pixels.
  fs::resize_file(folder_ / "wall.exr", fs::file_size(folder_ / "wall.exr") / 2);
  refused("render wall.json --max-memory 3M", "wall.exr");
  EXPECT_EQ(here(ABBE_BINARY " render wall.json --quiet -o a.exr").code, 4);
  write_exr(folder_ / "wall.exr", large);
  EXPECT_EQ(here(ABBE_BINARY " render wall.json --quiet -o a.exr --max-memory 20M").code, 0);
  ASSERT_EQ(here(ABBE_BINARY " render wall.json --quiet -o a.abbepart").code, 0);
  refused("merge a.abbepart -o b.exr --max-memory 1k", "a.abbepart");
  refused("develop a.exr -o b.exr --max-memory 1k", "a.exr");
}

/// Files without content on a disk: reading them would block or never end.
std::vector<std::pair<std::string, fs::path>> special_files() {
  const fs::path fifo = scratch() / "special_fifo";
  fs::remove(fifo);
  EXPECT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  return {{"fifo", fifo}, {"zero", "/dev/zero"}, {"kernel", "/proc/kmsg"}};
}

TEST_F(InputFiles, SpecialFilesAreRefusedAtOnce) {
  for (const char* scene : {"render wall.json --quiet --spp 1 -o film.exr", "convert wall.json -o copy.json"})
    ASSERT_EQ(here(ABBE_BINARY + std::string(" ") + scene).code, 0);
  const std::string image = " --set /materials/wall/diffuse/reflectance/image=";
  const std::vector<std::pair<std::string, std::string>> uses{
      {".json", "info {}"},
      {".xml", "convert {}"},
      {".pbrt", "convert {}"},
      {".gltf", "convert {}"},
      {".exr", "info wall.json" + image + "{}"},
      {".png", "info wall.json" + image + "{}"},
      {".hdr", "info wall.json" + image + "{}"},
      {".ply", "info wall.json --set /shapes/0/mesh={} --set /shapes/0/material=wall"},
      {".obj", "info wall.json --set /shapes/0/mesh={}"},
      {".csv", "info wall.json --set /lights/0/emission/spectrum={}"},
      {".npy",
       R"(info wall.json --set '/materials/fog={"medium":{"grid":{"densities":"{}","from":[0,0,0],"to":[1,1,1]}}}')"},
      {".abbepart", "merge {} -o merged.exr"},
      {".exr", "develop {} --display a.png"},
      {".ocio", "develop film.exr --display a.png --ocio {}"},
      {".dng", "mtf {}"},
      {".csv", "calibrate --camera {}"},
      {".json", "calibrate --series {}"},
      {".zmx", "lens {}"},
      {".yml", "query ior {} --at 500"},
      {".exr", "compare {} film.exr"},
      {".tif", "mtf {}"}};
  for (const auto& [name, special] : special_files())
    for (const auto& [extension, use] : uses) {
      fs::remove(folder_ / (name + extension));
      fs::create_symlink(special, folder_ / (name + extension));
      std::string command = use;
      command.replace(command.find("{}"), 2, name + extension);
      const Outcome run = here("timeout 5 " ABBE_BINARY " " + command);
      const std::string said = command + '\n' + run.err.substr(0, 400);
      if (name == "kernel") {  // texts are read as long as they do not block
        EXPECT_TRUE(run.code == 3 || run.code == 4) << run.code << ": " << said;
        continue;
      }
      EXPECT_EQ(run.code, 4) << said;
      EXPECT_NE(run.err.find("not a regular file"), std::string::npos) << said;
    }
}

// Scenes read from a pipe, by "-", and from a file with the name of the stream.
TEST_F(InputFiles, StandardInputIsReadAsBefore) {
  EXPECT_EQ(here("cat wall.json | " ABBE_BINARY " info -").code, 0);
  EXPECT_EQ(here(ABBE_BINARY " info /dev/stdin < wall.json").code, 4) << "it names files beside itself";
  const fs::path alone = scratch().write("alone.json", ball_scene());
  EXPECT_EQ(shell(ABBE_BINARY " info /dev/stdin < " + alone.string()).code, 0);
}

TEST(Memory, AmountsAreToldInUnitsThatTell) {
  EXPECT_EQ(bytes_text(999), "999 B");
  EXPECT_EQ(bytes_text(1000), "1.0 kB");
  EXPECT_EQ(bytes_text(999'960), "1.0 MB");
  EXPECT_EQ(bytes_text(84'300'000), "84.3 MB");
  EXPECT_EQ(bytes_text(2'000'000'000), "2.0 GB");
  const std::string said = abbe("render " + ball() + " --max-memory 1k -o " + file("m.exr")).err;
  EXPECT_NE(said.find("of 1.0 kB in all"), std::string::npos) << said;
}

}  // namespace
}  // namespace abbe::test
