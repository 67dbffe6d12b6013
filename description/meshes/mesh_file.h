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

/// A material as a mesh file describes it, as far as it can be represented.
struct FileMaterial {
  std::string name;
  LinearRgb color{1, 1, 1};            ///< Diffuse reflectance, in [0, 1].
  std::optional<double> index;         ///< Of a clear dielectric instead, > 0.
  std::vector<std::string> lost = {};  ///< What else the file says, in words.
};

/// The triangles of a file, in its own units, split by material when materials were asked for.
struct MeshFile {
  struct Submesh {
    Mesh mesh;
    std::optional<std::size_t> material;
  };
  std::vector<Submesh> submeshes;
  std::vector<FileMaterial> materials;
  std::vector<std::filesystem::path> others;  ///< Files the file named and that were read.
};

/// Whether triangles are told apart by the file's materials; `named`: without telling what of the file is not
/// read.
enum class FileMaterials { ignored, named, wanted };
/// Whether texture coordinates at the corners of triangles are read. v runs upwards, so that of glTF is
/// turned round.
enum class FileCoordinates { ignored, wanted };

/// Whether files of this extension may bring materials along.
[[nodiscard]] bool brings_materials(const std::filesystem::path& path);

/// Reads a PLY (ASCII or binary), OBJ, glTF or GLB file, told by its extension; polygons are cut into
/// triangles. A submesh whose triangles do not all have texture coordinates has none; where some have vertex
/// normals, the others get their own normal at each corner. Warns of lights and cameras, which are not read.
/// Reports, as input errors at `where`, a file that is missing, not regular or too large, anything malformed,
/// a flat polygon whose edges cross, one of more than 16384 corners that is not convex, a count that promises
/// more than the file holds (before anything is allocated for it), a name of another file that leaves the
/// folder, and whatever `check_mesh` reports. While it reads, `inputs` counts the bytes of the files and what
/// is stored of the meshes: throws Error{resource} for what is too large.
[[nodiscard]] std::optional<MeshFile> load_mesh_file(const std::filesystem::path& path,
                                                     FileMaterials materials, const SourcePosition& where,
                                                     Diagnostics& diagnostics,
                                                     FileCoordinates coordinates = FileCoordinates::ignored,
                                                     Inputs* inputs = nullptr);

/// Reports a vertex that is not finite and a triangle naming a vertex that does not exist, each by index;
/// takes triangles of zero area for slivers, with a warning that counts them. False when the mesh cannot be
/// used.
[[nodiscard]] bool check_mesh(Mesh& mesh, const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
