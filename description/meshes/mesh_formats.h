#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "description/meshes/mesh_file.h"

namespace abbe {

using Triangle = std::array<std::uint32_t, 3>;

/// One reader per format: the bytes of a file into `file`, or in `fault` what is wrong with them.
struct MeshReading {
  std::filesystem::path path;
  FileMaterials materials;
  FileCoordinates coordinates;
  MeshFile file;
  std::string fault;
  std::vector<std::string> lost;  ///< What of the file is not read, in words.
  HeldMemory held;                ///< By what is read, until it has been.

  /// Remembers the fault; false, so that a reader can end with it.
  bool refuse(std::string what) {
    fault = std::move(what);
    return false;
  }
  /// Makes room in a list for `more` elements, counted before it is asked for. Throws Error{resource} when
  /// there is none left.
  template <typename T>
  void make_room(std::vector<T>& list, std::size_t more) {
    if (list.capacity() - list.size() >= more) return;
    const std::size_t room = std::max(2 * list.capacity(), list.size() + more);
    held.take_more(path.string(), (room - list.capacity()) * sizeof(T));
    list.reserve(room);
  }
};
[[nodiscard]] bool read_ply(std::string&& bytes, MeshReading& reading);
[[nodiscard]] bool read_obj(std::string&& bytes, MeshReading& reading);
/// glTF 2.0, as JSON or GLB. Node transforms are applied, a mirror turning the triangles round.
[[nodiscard]] bool read_gltf(std::string&& bytes, MeshReading& reading);

/// Bytes of a regular file, which `held` counts before they are read; or why there are none.
[[nodiscard]] std::optional<std::string> read_mesh_bytes(const std::filesystem::path& path,
                                                         std::string& bytes, HeldMemory& held);
/// Bytes of a file that `reading`'s file names, which must lie beside it or below.
[[nodiscard]] bool read_named_bytes(const std::string& name, std::string& bytes, MeshReading& reading);

/// Cuts a convex polygon into the fan around its first corner; each corner may be anything.
template <typename Corner>
void add_fan(const std::vector<Corner>& polygon, std::vector<std::array<Corner, 3>>& triangles) {
  for (std::size_t i = 2; i < polygon.size(); ++i)
    triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

/// A file's normal of unit length; zero for one that is zero or not finite.
[[nodiscard]] inline Imath::V3f unit_normal(const Imath::V3d& given) {
  const double length2 = given.length2();
  return length2 > 0 && std::isfinite(length2) ? Imath::V3f(given.normalized()) : Imath::V3f(0);
}

/// The most triangles of a file, counted after nodes have been followed: a small file can name many.
inline constexpr double kMaxTriangles = 67108864;

}  // namespace abbe
