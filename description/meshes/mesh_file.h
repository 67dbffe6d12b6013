#pragma once

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
  std::string name;             ///< Name in the file. Those of glTF are made distinct.
  LinearRgb color{1, 1, 1};     ///< Diffuse reflectance as a linear Rec.709 colour, in [0, 1].
  std::optional<double> index;  ///< Refractive index > 0 of a clear dielectric, which replaces `color`.
  std::vector<std::string> ignored = {};  ///< Features of the material that are not represented, in words.
};

/// The triangles of a file, in its own unit of length, split by material if materials were requested.
struct MeshFile {
  /// The triangles of one material, or all triangles if materials were not requested.
  struct Submesh {
    Mesh mesh;
    std::optional<std::size_t> material;  ///< Index in `materials`; nothing for triangles without a material.
  };
  std::vector<Submesh> submeshes;             ///< At least one; none is empty.
  std::vector<FileMaterial> materials;        ///< Order of the file; empty if not requested.
  std::vector<std::filesystem::path> others;  ///< Other files that the file names and that were read.
};

/// Mode in which the materials of the file are read.
enum class FileMaterials {
  ignored,  ///< All triangles form one submesh without a material.
  named,    ///< Triangles are split by material, without warnings about lights and cameras.
  wanted    ///< Triangles are split by material.
};
/// Mode in which texture coordinates at the corners of triangles are read: not at all, or if the file has
/// them. v increases upwards. Those of PLY files are not read.
enum class FileCoordinates { ignored, wanted };

/// True for the extensions .obj, .gltf and .glb, in either case: such files may contain materials.
[[nodiscard]] bool may_have_materials(const std::filesystem::path& path);

/// Reads a PLY (ASCII or binary, also as .ply.gz), OBJ, glTF or GLB file, recognised by its extension.
/// Polygons are cut into triangles; the transforms of glTF nodes are applied. A submesh with texture
/// coordinates at only some of its triangles gets none. If only some corners of a submesh have vertex
/// normals, its other triangles get their geometric normals. Vertex normals have unit length. Warns of lights
/// and cameras, which are not read. Reports with ErrorCode::input at `where`, and returns nothing for:
/// - a file that is missing, not regular, above 4 GiB, of an unknown extension or malformed;
/// - a flat polygon whose edges cross, and a polygon of more than 16384 corners that is not convex;
/// - a count larger than the file can hold, before memory is allocated for it;
/// - a name of another file outside the folder;
/// - the errors of `check_mesh`.
/// `inputs`, if given, counts the bytes of the files and of the meshes while they are read. Throws
/// Error{resource} if its memory limit is exceeded.
[[nodiscard]] std::optional<MeshFile> load_mesh_file(const std::filesystem::path& path,
                                                     FileMaterials materials, const SourcePosition& where,
                                                     Diagnostics& diagnostics,
                                                     FileCoordinates coordinates = FileCoordinates::ignored,
                                                     Inputs* inputs = nullptr);

/// Checks a mesh. Moves triangles of zero area to `mesh.slivers` and warns of their number. Reports with
/// ErrorCode::input at `where`, and returns false for:
/// - a vertex that is not finite, by its index;
/// - a triangle with a vertex that does not exist, by its index;
/// - a mesh without a triangle of nonzero area.
[[nodiscard]] bool check_mesh(Mesh& mesh, const SourcePosition& where, Diagnostics& diagnostics);

}  // namespace abbe
