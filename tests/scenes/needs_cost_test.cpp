#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <unistd.h>

#include <fmt/format.h>

#include "tests/cli/program.h"

// What a scene does not need costs nothing. Instructions are counted under Valgrind, inside the function that
// traces a batch of camera paths, so that the counts depend on the program alone: not on the machine, its
// load or its clock.

namespace abbe {
namespace {

constexpr int kSide = 32;
constexpr int kSamples = 8;
constexpr int kPaths = kSide * kSide * kSamples;

// A lit room without a hole, perhaps with a sphere and what that is made of.
struct Room {
  std::string camera = R"({"pinhole": {"focal_length": 0.02}})";
  std::string sphere = "";
  std::string matter = "";
  std::string filters = "";
};
std::string text_of(const Room& room) {
  Room r = room;
  r.camera.pop_back();
  return fmt::format(R"({{
  "abbe": 1,
  "camera": {}, "from": [0, -1.5, 1], "to": [0, 1, 1], "up": [0, 0, 1]}},
  "sensor": {{"resolution": [{}, {}], "pixel_pitch_um": 500, "observer": "1931"{}}},
  "materials": {{"grey": {{"diffuse": {{"reflectance": "cornell_box_walls:white"}}}}{}}},
  "lights": [{{"quad": {{"corner": [-0.4, 0, 1.9], "edge_u": [0, 0.8, 0], "edge_v": [0.8, 0, 0]}},
    "emission": {{"illuminant": "D65", "luminance": 100}}}}],
  "shapes": [
    {{"quad": {{"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}}, "material": "grey"}},
    {{"quad": {{"corner": [-2, -2, 2], "edge_u": [0, 4, 0], "edge_v": [4, 0, 0]}}, "material": "grey"}},
    {{"quad": {{"corner": [-2, -2, 0], "edge_u": [0, 4, 0], "edge_v": [0, 0, 2]}}, "material": "grey"}},
    {{"quad": {{"corner": [2, -2, 0], "edge_u": [0, 0, 2], "edge_v": [0, 4, 0]}}, "material": "grey"}},
    {{"quad": {{"corner": [-2, -2, 0], "edge_u": [0, 0, 2], "edge_v": [4, 0, 0]}}, "material": "grey"}},
    {{"quad": {{"corner": [-2, 2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 2]}}, "material": "grey"}}{}
  ],
  "render": {{"integrator": "path", "samples": {}, "max_depth": 6, "polarisation": "off"}}
}})",
                     r.camera, kSide, kSide, r.filters, r.matter, r.sphere, kSamples);
}

struct Profile {
  double instructions_per_path = 0;
  std::set<std::string> functions;

  [[nodiscard]] bool ran(const std::string& name) const {
    for (const std::string& function : functions)
      if (function.find(name) != std::string::npos) return true;
    return false;
  }
};

Profile profile(const Room& room) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("abbe_needs_{}", ::getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "room.json") << text_of(room);
  const std::string command = fmt::format(
      "cd {} && valgrind -q --tool=callgrind --callgrind-out-file=counts --compress-strings=no "
      "--compress-pos=no "
      "'--toggle-collect=abbe::PathTracer::trace_batch(*' {} render room.json -o room.exr --threads 1 "
      "--quiet",
      folder.string(), ABBE_BINARY);
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  Profile result;
  std::ifstream counts(folder / "counts");
  // Lines of a position and a cost follow the function they belong to, but for the one after `calls`.
  std::string function;
  bool of_callee = false;
  for (std::string line; std::getline(counts, line);) {
    if (line.starts_with("fn=")) function = line.substr(3);
    if (line.starts_with("totals: ")) result.instructions_per_path = std::stod(line.substr(8)) / kPaths;
    const bool cost = !line.empty() && std::isdigit(static_cast<unsigned char>(line.front()));
    if (cost && !of_callee && !line.ends_with(" 0")) result.functions.insert(function);
    of_callee = line.starts_with("calls=");
  }
  std::filesystem::remove_all(folder);
  return result;
}

const Profile& plain() {
  static const Profile profiled = profile({});
  return profiled;
}

constexpr const char* kGlass = R"(, "glass": {"dielectric": {"ior": "N-BK7"}})";

// Polarisation apart, which paths carry from their start wherever a scene may ask for it. Balls outside the
// room, so that geometry costs both alike: Embree keeps spheres apart from triangles.
TEST(NeedsCost, MatterThatPathsDoNotMeetCostsThemNothing) {
  const auto ball = [](const char* material) {
    return profile(
        {.sphere = fmt::format(R"(, {{"sphere": {{"center": [9, 0, 1], "radius": 0.5}}, "material": "{}"}})",
                               material),
         .matter = kGlass});
  };
  const double grey = ball("grey").instructions_per_path;
  const double glass = ball("glass").instructions_per_path;
  std::printf("%.1f instructions per path with a grey ball outside the room, %.1f with one of glass\n", grey,
              glass);
  EXPECT_GT(grey, 1000);
  EXPECT_NEAR(glass / grey, 1, 0.01);
}

TEST(NeedsCost, OnlyWhatIsNeededRuns) {
  const Profile glass =
      profile({.sphere = R"(, {"sphere": {"center": [0.5, 0.5, 1], "radius": 0.5}, "material": "glass"})",
               .matter = kGlass});
  for (const char* name :
       {"DielectricBsdf::sample", "relative_index", "RefractiveIndex::absorption_per_m", "Sphere>"}) {
    EXPECT_FALSE(plain().ran(name)) << name;
    EXPECT_TRUE(glass.ran(name)) << name;
  }
}

TEST(NeedsCost, OnlyFiltersThatShiftAreWeighedByTheAngle) {
  const Profile tilting =
      profile({.filters = R"(, "filters": [{"transmittance": {"band": [400, 700]}, "effective_index": 2}])"});
  EXPECT_FALSE(plain().ran("FilmResponse::weight_unpolarised"));
  EXPECT_TRUE(tilting.ran("FilmResponse::weight_unpolarised"));
}

TEST(NeedsCost, APinholeDrawsNoLensPoint) {
  const Profile lens = profile(
      {.camera = R"({"thin_lens": {"focal_length": 0.02, "f_number": 1000, "focus_distance": 1000}})"});
  std::printf("%.1f instructions per path through a pinhole, %.1f through a lens\n",
              plain().instructions_per_path, lens.instructions_per_path);
  EXPECT_LT(plain().instructions_per_path, lens.instructions_per_path - 100);
}

}  // namespace
}  // namespace abbe
