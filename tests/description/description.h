#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fmt/format.h>

#include "description/load.h"
#include "io/exr.h"
#include "io/json.h"
#include "tests/description/examples.h"

namespace abbe::test {

inline void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string ply(int vertices, int faces, const std::string& body) {
  return fmt::format(
             "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
             "z\n"
             "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
             vertices, faces) +
         body;
}

inline const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

struct Loaded {
  std::optional<Scene> scene;
  Diagnostics diagnostics;

  [[nodiscard]] std::string text() const { return diagnostics.text(); }
  const Scene* operator->() const { return &scene.value(); }
};

struct Fault {
  const char* what;
  std::string fragment;
  ErrorCode code;
  const char* message;
};

class DescriptionTest : public ::testing::Test {
 protected:
  DescriptionTest() : folder_(fs::temp_directory_path() / fmt::format("abbe_description_{}", ::getpid())) {
    fs::create_directories(folder_);
    write(folder_ / "bench.ply", ply(4, 1, kSquare + "4 0 1 2 3\n"));
    write(folder_ / "chair.mtl", "newmtl wood\nKd 0.4 0.2 0.1\n");
    write(folder_ / "chair.obj", "mtllib chair.mtl\nusemtl wood\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_exr(folder_ / "sky.exr", {2, 1, {{"Y", {1, 2}}}, {}});
    write_exr(folder_ / "paint.exr", {2, 1, {{"a", {0.25F, 1}}, {"b", {0.5F, 0}}}, {}});
    write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
    write_exr(folder_ / "normals.exr", {1, 1, {{"R", {0.5F}}, {"G", {0.8F}}, {"B", {0.9F}}}, {}});
    write(folder_ / "lamp.csv", "# unit: W/(m2 sr nm)\n# outside: zero\nwavelength_nm,L\n400,1\n700,3\n");
    write(folder_ / "downlight.ies",
          "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n300 0\n");
    write(folder_ / "filter.csv",
          "# unit: transmittance\n# outside: zero\nwavelength_nm,T\n500,0.2\n600,0.4\n");
  }
  ~DescriptionTest() override { fs::remove_all(folder_); }

  // Loads a scene exactly as written.
  Loaded load_text(const std::string& text, const std::vector<Override>& overrides = {}) {
    Loaded loaded;
    write(folder_ / "scene.json", text);
    loaded.scene = load_scene(folder_ / "scene.json", overrides, loaded.diagnostics);
    return loaded;
  }

  // Loads a scene with the members of `fragment`, completed by the keys that a scene needs.
  Loaded load(const std::string& fragment, const std::vector<Override>& overrides = {}) {
    return load_text(completed(fragment), overrides);
  }

  // The curve of a reflectance.
  Curve curve(const std::string& json) {
    const Loaded loaded =
        load(fmt::format(R"({{"materials": {{"m": {{"diffuse": {{"reflectance": {}}}}}}}}})", json));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.scene ? std::get<DiffuseMaterial>(loaded->materials.at(0).model).reflectance.curve()
                        : Curve(-1.0);
  }

  // The emission of a light; `kind` is its member that gives the geometry.
  Curve emission(const std::string& kind, const std::string& json) {
    const Loaded loaded = load(fmt::format(R"({{"lights": [{{{}, "emission": {}}}]}})", kind, json));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.scene ? loaded->lights.at(0).emission.curve() : Curve(-1.0);
  }

  Shape shape(const std::string& members) {
    const Loaded loaded = load(fmt::format(
        R"({{"materials": {{"m": {{"diffuse": {{"reflectance": 0}}}}}}, "shapes": [{{{}, "material": "m"}},
            {{"sphere": {{"center": [0, 0, 0], "radius": 100}}, "material": "m"}}]}})",
        members));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.scene ? loaded->shapes.at(0).shape : Shape(Sphere{{0, 0, 0}, 0});
  }

  // Expects that each fault is an error with its message, and the only error.
  void expect_refused(const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
      SCOPED_TRACE(fault.what);
      const Loaded loaded = load(fault.fragment);
      EXPECT_FALSE(loaded.scene);
      ASSERT_TRUE(loaded.diagnostics.has_errors());
      EXPECT_EQ(loaded.diagnostics.code(), fault.code) << loaded.text();
      EXPECT_NE(loaded.text().find(fault.message), std::string::npos)
          << loaded.text() << "lacks " << fault.message;
      EXPECT_EQ(std::ranges::count_if(
                    loaded.diagnostics.all(),
                    [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; }),
                1)
          << loaded.text();
    }
  }

  fs::path folder_;
};

inline std::string painted(const std::string& reflectance) {
  return fmt::format(R"({{"materials": {{"m": {{"diffuse": {{"reflectance": {}}}}}}}}})", reflectance);
}
inline std::string shaped(const std::string& members) {
  return fmt::format(
      R"({{"materials": {{"m": {{"diffuse": {{"reflectance": 0}}}}}}, "shapes": [{{{}, "material": "m"}}]}})",
      members);
}
inline std::string sensed(const std::string& members) {
  return fmt::format(R"({{"sensor": {{{}}}}})", members);
}
inline std::string metered(const std::string& members) {
  return fmt::format(R"({{"meters": {{"m": {{{}}}}}}})", members);
}
inline std::string lit(const std::string& emission) {
  return fmt::format(R"({{"lights": [{{"point": {{"at": [0, 0, 1]}}, "emission": {}}}]}})", emission);
}

}  // namespace abbe::test
