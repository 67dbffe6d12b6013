#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "description.h"
#include "description/meshes/mesh_file.h"

namespace abbe::test {

template <typename T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A triangle of area 2, little-endian.
inline std::string binary_ply() {
  return "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list ushort int vertex_indices\nend_header\n" +
         raw<float>({0, 0, 0, 2, 0, 0, 0, 2, 0}) + raw<std::uint16_t>({3}) + raw<std::int32_t>({0, 1, 2});
}

/// Mesh files in the folder of a test, read alone or as shapes of a scene.
class MeshFileTest : public DescriptionTest {
 protected:
  MeshFile read(const std::string& name, const std::string& bytes,
                FileMaterials materials = FileMaterials::ignored) {
    write(folder_ / name, bytes);
    Diagnostics diagnostics;
    auto file = load_mesh_file(folder_ / name, materials, {}, diagnostics);
    EXPECT_TRUE(file) << diagnostics.text();
    return file.value_or(MeshFile{});
  }
  Mesh mesh(const std::string& name, const std::string& bytes) {
    MeshFile file = read(name, bytes);
    EXPECT_EQ(file.submeshes.size(), 1U);
    return file.submeshes.empty() ? Mesh{} : file.submeshes[0].mesh;
  }
  void expect_refused(const std::string& name, const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
      SCOPED_TRACE(fault.what);
      write(folder_ / name, fault.fragment);
      const Loaded loaded = load(fmt::format(R"({{"shapes": [{{"mesh": "{}"}}]}})", name));
      EXPECT_FALSE(loaded.scene);
      EXPECT_EQ(loaded.diagnostics.code(), fault.code);
      EXPECT_NE(loaded.text().find(fault.message), std::string::npos) << loaded.text();
    }
  }
};

}  // namespace abbe::test
