#include <map>

#include <gtest/gtest.h>

#include "gltf_asset.h"
#include "mesh_files.h"

namespace abbe {
namespace {

using MeshFileTest = test::MeshFileTest;

/// A valid file of every format, by name.
std::map<std::string, std::string> sound_files() {
  return {{"a.glb", test::whole_glb()},
          {"a.gltf", test::Asset().text()},
          {"a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl red\nf 1//1 2//1 -1//1\n"},
          {"text.ply", test::ply(4, 1, test::kSquare + "4 0 1 2 3\n")},
          {"binary.ply", test::binary_ply()}};
}

// Any prefix of a file, and a file with any byte changed, is read or reported, and never crashes the reader.
TEST_F(MeshFileTest, SurvivesDamage) {
  test::write(folder_ / "a.mtl", "newmtl red\nKd 0.8 0.1 0.05\n");
  for (const auto& [name, sound] : sound_files()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(read(name, sound, FileMaterials::wanted).submeshes.size(), 1U);
    std::size_t refused = 0;
    const auto attempt = [&](const std::string& bytes) {
      test::write(folder_ / name, bytes);
      Diagnostics diagnostics;
      const auto file = load_mesh_file(folder_ / name, FileMaterials::wanted, {}, diagnostics);
      EXPECT_NE(file.has_value(), diagnostics.has_errors());
      EXPECT_TRUE(file || diagnostics.code() == ErrorCode::input);
      refused += file ? 0 : 1;
    };
    for (std::size_t i = 0; i < sound.size(); i += 3) attempt(sound.substr(0, i));
    for (std::size_t i = 0; i < sound.size(); ++i) {
      std::string changed = sound;
      changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 0x7F : 0x11));
      attempt(changed);
    }
    EXPECT_GT(refused, sound.size() / 2);
  }
}

}  // namespace
}  // namespace abbe
