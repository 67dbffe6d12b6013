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

/// The state of reading a mesh file. A reader fills `file`, or describes what is wrong in `fault`.
struct MeshReading {
  std::filesystem::path path;
  FileMaterials materials;
  FileCoordinates coordinates;
  MeshFile file;
  std::string fault;
  std::vector<std::string> ignored;  ///< Content of the file that is not read, in words.
  MemoryReservation memory;          ///< Memory of the data, until the file has been read.

  /// Records the fault. Returns false, so that a reader can return the result.
  bool refuse(std::string what) {
    fault = std::move(what);
    return false;
  }
  /// Reserves room for `more` elements, and counts the memory before it is allocated. Throws Error{resource}
  /// if the limit is exceeded.
  template <typename T>
  void make_room(std::vector<T>& list, std::size_t more) {
    if (list.capacity() - list.size() >= more) return;
    const std::size_t room = std::max(2 * list.capacity(), list.size() + more);
    memory.reserve(path.string(), (room - list.capacity()) * sizeof(T));
    list.reserve(room);
  }
};
/// Read a PLY or an OBJ file. False after a fault.
[[nodiscard]] bool read_ply(std::string&& bytes, MeshReading& reading);
[[nodiscard]] bool read_obj(std::string&& bytes, MeshReading& reading);
/// Reads glTF 2.0, as JSON or GLB. False after a fault. Node transforms are applied; a mirror reverses the
/// winding of triangles.
[[nodiscard]] bool read_gltf(std::string&& bytes, MeshReading& reading);

/// Reads the bytes of a regular file; `memory` counts them first. Returns a fault, or nothing on success.
[[nodiscard]] std::optional<std::string> read_mesh_bytes(const std::filesystem::path& path,
                                                         std::string& bytes, MemoryReservation& memory);
/// Reads the bytes of another file that the mesh file names. It must be in the same folder or below it.
[[nodiscard]] bool read_named_bytes(const std::string& name, std::string& bytes, MeshReading& reading);

/// Cuts a polygon of n >= 3 corners into n - 2 triangles with its winding; they refer to corners by index.
/// The result is a fan around the first corner in two cases: if no triangle of the fan turns back as seen
/// along the normal, which holds for every convex polygon; and if a polygon that is not flat folds over
/// itself. Otherwise the polygon is cut by its ears.
/// Returns the fault of a flat polygon whose edges cross, or of a polygon of more than 16384 corners that is
/// not convex.
[[nodiscard]] std::optional<std::string> cut_polygon(const std::vector<Imath::V3d>& corners,
                                                     std::vector<Triangle>& triangles);
/// Adds to `list` the attributes at the corners of the triangles that `cut_polygon` made.
template <typename Corner>
void add_corners(const std::vector<Corner>& polygon, const std::vector<Triangle>& triangles,
                 std::vector<std::array<Corner, 3>>& list) {
  for (const auto& [a, b, c] : triangles) list.push_back({polygon[a], polygon[b], polygon[c]});
}

/// A normal of a file, scaled to unit length; zero if it is zero or not finite.
[[nodiscard]] inline Imath::V3f unit_normal(const Imath::V3d& given) {
  const double length2 = given.length2();
  return length2 > 0 && std::isfinite(length2) ? Imath::V3f(given.normalized()) : Imath::V3f(0);
}

/// Largest number of triangles of a file, counted after nodes are expanded: a small file can repeat a mesh
/// many times.
inline constexpr double kMaxTriangles = 67108864;

}  // namespace abbe
