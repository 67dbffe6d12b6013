#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "scene/shapes/shape.h"
#include "spectral/rgb.h"

namespace abbe {

/// A material of a mesh file, as far as Abbe can represent it.
struct FileMaterial {
  std::string name;
  LinearRgb color{1, 1, 1};     ///< Diffuse reflectance, in [0, 1].
  std::optional<double> index;  ///< Refractive index > 0 of a clear dielectric, which replaces `color`.
  std::vector<std::string> ignored = {};  ///< Features of the material that are not represented, in words.
};

/// The triangles of a file, in its own units, split by material if materials were requested.
struct MeshFile {
  struct Submesh {
    Mesh mesh;
    std::optional<std::size_t> material;
  };
  std::vector<Submesh> submeshes;
  std::vector<FileMaterial> materials;
  std::vector<std::filesystem::path> others;  ///< Files that the file names and that were read.
};

/// Mode in which the materials of the file are read. `wanted` splits triangles by material; `named` does so
/// without warnings about ignored content.
enum class FileMaterials { ignored, named, wanted };
/// Mode in which texture coordinates at the corners of triangles are read. v increases upwards; that of glTF
/// is converted.
enum class FileCoordinates { ignored, wanted };

/// True if files of this extension may contain materials.
[[nodiscard]] bool may_have_materials(const std::filesystem::path& path);

/// Reads a PLY (ASCII or binary), OBJ, glTF or GLB file, recognised by its extension. Polygons are cut into
/// triangles. A submesh with texture coordinates at only some of its triangles gets none. If only some
/// corners of a submesh have vertex normals, its other triangles get their geometric normals. Warns of lights
/// and cameras, which are not read.
/// Reports as input errors at `where`:
/// - a file that is missing, not regular, too large or malformed;
/// - a flat polygon whose edges cross, and a polygon of more than 16384 corners that is not convex;
/// - a count larger than the file can hold, before memory is allocated for it;
/// - a name of another file outside the folder;
/// - the errors of `check_mesh`.
/// `inputs` counts the bytes of the files and of the meshes while they are read. Throws Error{resource} for
/// what is too large.
[[nodiscard]] std::optional<MeshFile> load_mesh_file(const std::filesystem::path& path,
                                                     FileMaterials materials, const SourcePosition& where,
                                                     Diagnostics& diagnostics,
                                                     FileCoordinates coordinates = FileCoordinates::ignored,
                                                     Inputs* inputs = nullptr);

/// Checks a mesh. Reports, by index, a vertex that is not finite and a triangle with a vertex that does not
/// exist. Moves triangles of zero area to `slivers` and warns of their number. False if the mesh cannot be
/// used.
[[nodiscard]] bool check_mesh(Mesh& mesh, const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
