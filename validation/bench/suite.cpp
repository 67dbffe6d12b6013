#include "validation/bench/suite.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/text.h"
#include "validation/bench/generated_scene.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

void make_landscape(const fs::path& folder) {
  constexpr std::uint32_t kTerrainCells = 724;  // 1 048 352 triangles
  constexpr std::uint32_t kBallRows = 513;      // 1 050 624 triangles
  write_ply(folder / "terrain.ply", make_terrain(kTerrainCells));
  write_ply(folder / "ball.ply", make_bumpy_ball(kBallRows));
}

// The number of sides is large enough for the reflections of the light in neighbouring faces to overlap.
void make_rings(const fs::path& folder) {
  constexpr std::uint32_t kSides = 2048;
  write_ply(folder / "ring.ply", make_ring(kSides));
}

constexpr const char* kBrightRooms = "bright-rooms";

BenchSuite bright_room(const std::string& name, const char* ball, const char* albedo, bool open) {
  BenchSuite suite{
      fmt::format("bright-room-{}-{}-{}", name, albedo, open ? "open" : "closed"),
      fmt::format("a ball of {} in a room of albedo {}{}", name, albedo, open ? ", open on two sides" : ""),
      "bench/bright_room.json",
      {{"/materials/ball", ball}, {"/materials/white/diffuse/reflectance", albedo}}};
  if (open)
    for (const char* wall : {"/shapes/0/material", "/shapes/1/material"})
      suite.settings.push_back({wall, "black"});
  return suite;
}

// Path of the scene file: the shipped file, or a copy in the folder of the generated meshes.
fs::path scene_file(const BenchSuite& suite, const fs::path& cache, Diagnostics& diagnostics) {
  fs::path shipped = data_directory() / suite.scene;
  if (suite.make_meshes == nullptr) return shipped;
  const fs::path folder = cache / suite.name;
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const auto text = read_text(shipped, diagnostics);
  if (!text) return shipped;
  write_atomically(folder / shipped.filename(), text->text);
  suite.make_meshes(folder);
  return folder / shipped.filename();
}

}  // namespace

const std::vector<BenchSuite>& bench_suites() {
  static const std::vector<BenchSuite> suites{
      {"furnace",
       "a closed sphere where every pixel is the same: little noise, many bounces",
       "scenes/furnace.json",
       {{"/sensor/resolution", "[256, 256]"}}},
      {"cornell", "the Cornell box as measured: diffuse light between walls", "scenes/cornell.json"},
      {"cornell-10nm",
       "the Cornell box under a light of 584 to 594 nm",
       "scenes/cornell.json",
       {{"/lights/0/emission", R"({"spectrum": {"band": [584, 594]}, "luminance": 13660.04})"}}},
      {"prism-spot", "a spectrum on a screen, from a spot light aimed at the slit", "scenes/prism_spot.json"},
      {"prism-area", "a spectrum on a screen, from a panel that emits into a half space",
       "scenes/prism_area.json"},
      {"glass-sphere", "the caustic of a ball of glass under a small light", "scenes/glass_sphere.json"},
      {"through-pane",
       "the caustic of a ball of glass, viewed through a pane of thin glass",
       "scenes/glass_sphere.json",
       {{"/materials/pane", R"({"thin_glass": {"ior": "N-BK7"}})"},
        {"/shapes/2",
         R"({"name": "pane", "quad": {"corner": [1.5, 0.1, -6], "edge_u": [4, 0, 2], "edge_v": [0, 4, 0]}, )"
         R"("material": "pane"})"}}},
      {"through-slab",
       "the caustic of a ball of glass, viewed through a dispersive slab of glass",
       "scenes/glass_sphere.json",
       {{"/shapes/2", R"({"name": "slab", "mesh": {)"
                      R"("vertices": [[1.5, 0.1, -6], [5.5, 0.1, -4], [5.5, 4.1, -4], [1.5, 4.1, -6], )"
                      R"([1.4, 0.1, -5.8], [5.4, 0.1, -3.8], [5.4, 4.1, -3.8], [1.4, 4.1, -5.8]], )"
                      R"("triangles": [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], )"
                      R"([1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]}, )"
                      R"("material": "glass"})"}}},
      {"ring", "the caustic of a polished ring on the ground below it", "bench/ring.json", {}, make_rings},
      {"bulb", "a light inside a bulb of glass", "bench/bulb.json"},
      {"beam", "the beam of a spot in fog, seen from the side", "bench/beam.json"},
      {"metals",
       "balls of polished and rough metal under a light and a sky, without polarisation like the other "
       "renderer",
       "bench/metals.json",
       {{"/render/polarisation", "off"}}},
      {"metals-polarised", "balls of polished and rough metal under a light and a sky, with polarisation",
       "bench/metals.json"},
      {"many-lights", "a hall with ten thousand lights", "bench/hall.json", {{"/lights", make_lights(100)}}},
      {"mesh",
       "a terrain and a bumpy ball of 1.05 million triangles each; the ball is diffuse, that of the other "
       "renderers of rough copper",
       "bench/mesh.json",
       {},
       make_landscape}};
  return suites;
}

const std::vector<BenchSuite>& bright_rooms() {
  static const std::vector<BenchSuite> rooms = [] {
    std::vector<BenchSuite> all;
    for (const auto& [name, ball] : {std::pair("silver", R"({"conductor": {"ior": "Ag_Johnson"}})"),
                                     std::pair("gold", R"({"conductor": {"ior": "Au_Johnson"}})"),
                                     std::pair("glass", R"({"dielectric": {"ior": "N-BK7"}})"),
                                     std::pair("mirror", R"({"mirror": {"reflectance": 1}})")})
      for (const char* albedo : {"0.5", "0.8", "0.9", "0.95"})
        for (const bool open : {false, true}) all.push_back(bright_room(name, ball, albedo, open));
    return all;
  }();
  return rooms;
}

std::vector<BenchSuite> choose_suites(const std::vector<std::string>& names) {
  if (names.empty()) return bench_suites();
  std::vector<BenchSuite> all = bench_suites();
  all.insert(all.end(), bright_rooms().begin(), bright_rooms().end());
  std::vector<std::string> known{kBrightRooms};
  for (const BenchSuite& suite : all) known.push_back(suite.name);
  std::vector<BenchSuite> chosen;
  const auto choose = [&chosen](const BenchSuite& suite) {
    const auto same = [&suite](const BenchSuite& other) { return suite.name == other.name; };
    if (std::ranges::none_of(chosen, same)) chosen.push_back(suite);
  };
  for (const std::string& name : names) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end()) throw Error(ErrorCode::usage, "", unknown_name("suite", name, known));
    if (found == known.begin())
      std::ranges::for_each(bright_rooms(), choose);
    else
      choose(all[static_cast<std::size_t>(found - known.begin()) - 1]);
  }
  return chosen;
}

Scene load_suite(const BenchSuite& suite, const fs::path& cache, bool quick) {
  Diagnostics diagnostics;
  const fs::path file = scene_file(suite, cache, diagnostics);
  std::optional<Scene> scene = load_scene(file, suite.settings, diagnostics);
  if (!scene) throw Error(ErrorCode::input, suite.name, diagnostics.text());
  if (quick) {
    constexpr int kCoarser = 4;
    Camera& camera = scene->camera;
    camera.width = std::max(1, camera.width / kCoarser);
    camera.height = std::max(1, camera.height / kCoarser);
    camera.pixel_pitch *= kCoarser;
  }
  return std::move(*scene);
}

}  // namespace abbe
