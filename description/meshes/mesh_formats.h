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

/// Cuts a polygon of three corners or more into triangles, two fewer than it has corners, which wind as it
/// does and name its corners by their position. They lie around the first corner where none turns back seen
/// along the polygon's normal, as in any convex one, and where a polygon that is not flat folds over itself;
/// else there is one for each ear. Told, as text, are a flat polygon whose edges cross and one that is not
/// convex with more than 16384 corners.
[[nodiscard]] std::optional<std::string> cut_polygon(const std::vector<Imath::V3d>& corners,
                                                     std::vector<Triangle>& triangles);
/// Adds to `list` what a polygon has at the corners of triangles that `cut_polygon` has made of it.
template <typename Corner>
void add_corners(const std::vector<Corner>& polygon, const std::vector<Triangle>& triangles,
                 std::vector<std::array<Corner, 3>>& list) {
  for (const auto& [a, b, c] : triangles) list.push_back({polygon[a], polygon[b], polygon[c]});
}

/// A file's normal of unit length; zero for one that is zero or not finite.
[[nodiscard]] inline Imath::V3f unit_normal(const Imath::V3d& given) {
  const double length2 = given.length2();
  return length2 > 0 && std::isfinite(length2) ? Imath::V3f(given.normalized()) : Imath::V3f(0);
}

/// The most triangles of a file, counted after nodes have been followed: a small file can name many.
inline constexpr double kMaxTriangles = 67108864;

}  // namespace abbe
