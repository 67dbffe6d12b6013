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
#include "io/inputs.h"

namespace abbe {

/// Indices of the three corners of a triangle, counted from 0.
using Triangle = std::array<std::uint32_t, 3>;

/// Thrown by readers for a file that they refuse, with an error message without the path.
struct MeshFault {
  std::string text;
};

/// The state of reading a mesh file. A reader fills `file`, or throws MeshFault.
struct MeshReading {
  std::filesystem::path path;
  FileMaterials materials;
  FileCoordinates coordinates;
  MeshFile file;
  std::vector<std::string> ignored;  ///< Content of the file that is not read, in words, for warnings.
  MemoryReservation memory;          ///< Memory of the data, until the file has been read.

  /// Reserves room for `more` further elements in `list`, and counts the memory before it is allocated.
  /// Throws Error{resource} if the memory limit is exceeded.
  template <typename T>
  void make_room(std::vector<T>& list, std::size_t more) {
    if (list.capacity() - list.size() >= more) return;
    const std::size_t room = std::max(2 * list.capacity(), list.size() + more);
    memory.reserve(path.string(), (room - list.capacity()) * sizeof(T));
    list.reserve(room);
  }
};

// Each reader takes the whole contents `bytes` of a file and adds its submeshes and materials to
// `reading.file`. It throws MeshFault, and Error{resource} if the memory limit is exceeded. The vertices are
// not yet checked; see `check_mesh`.

/// Reads PLY, ASCII or binary, uncompressed.
void read_ply(std::string&& bytes, MeshReading& reading);
/// Reads OBJ and, if materials are requested, the .mtl files that it names.
void read_obj(std::string&& bytes, MeshReading& reading);
/// Reads glTF 2.0, as JSON or GLB, and the buffer files that it names. Node transforms are applied; a mirror
/// reverses the winding of triangles.
void read_gltf(std::string&& bytes, MeshReading& reading);

/// Reads the bytes of a regular file of at most 4 GiB into `bytes`, which must be empty; a .ply.gz is
/// decompressed. Returns nothing on success, otherwise an error message without the path. `memory` counts the
/// bytes first. Throws Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<std::string> read_mesh_bytes(const std::filesystem::path& path,
                                                         std::string& bytes, MemoryReservation& memory);
/// Reads the bytes of another file that the mesh file names into `bytes`, which must be empty, and adds its
/// path to `reading.file.others`. `name` is relative to the folder of the mesh file. Throws MeshFault for a
/// file outside that folder and its subfolders, and for one that cannot be read or exceeds 4 GiB.
void read_named_bytes(const std::string& name, std::string& bytes, MeshReading& reading);

/// Cuts a polygon of n >= 3 corners into n - 2 triangles with its winding, which replace the contents of
/// `triangles`. They are a fan around the first corner if no triangle of the fan turns back, as in every
/// convex polygon. A polygon that is not flat and folds over itself also gives a fan. Otherwise its ears are
/// cut. Returns nothing on success, and an error message for a flat polygon whose edges cross and one of more
/// than 16384 corners that is not convex; `triangles` is then not usable.
[[nodiscard]] std::optional<std::string> cut_polygon(const std::vector<Imath::V3d>& corners,
                                                     std::vector<Triangle>& triangles);
/// Adds to `list` one entry per triangle that `cut_polygon` made: the attributes at its corners. `polygon`
/// has the attribute of each corner of the polygon.
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

/// Decompresses the file `path` [RFC1952] and appends the result to `bytes`, whose growth is reserved in
/// `memory` first. Returns nothing on success, and otherwise an error message without the path. It is an
/// error if `bytes` exceed `limit` in all, because a small file may unpack to any length. Throws
/// Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                                         std::string& bytes, MemoryReservation& memory);

}  // namespace abbe
