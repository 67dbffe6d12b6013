#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathMatrix.h>

#include "description/importers/shared/scene_importer.h"
#include "scene/shapes/shape.h"

// Matrices apply to row vectors, as everywhere in Abbe.
namespace abbe::importers {

/// The matrix of 16 numbers, which are its rows for column vectors.
[[nodiscard]] Imath::M44d from_rows(const std::vector<double>& rows);
/// A scaling along the axes.
[[nodiscard]] Imath::M44d scaling(const Imath::V3d& by);
[[nodiscard]] Imath::M44d translation(const Imath::V3d& by);
/// A right-handed rotation about a nonzero axis.
[[nodiscard]] Imath::M44d rotation(const Imath::V3d& axis, double deg);
/// True if the matrix changes handedness.
[[nodiscard]] bool mirrors(const Imath::M44d& matrix);

/// A mesh file.
struct MeshFileSurface {
  std::filesystem::path file;
};
/// A shape of the source scene.
struct ImportedShape {
  std::variant<spec::Sphere, spec::Disc, spec::Quad, spec::InlineMesh, MeshFileSurface> surface;
  Imath::M44d to_world;
  bool reversed = false;  ///< True if its front is the back of `surface`.
  /// Texture coordinates of a disc. True: u is the distance from the center and v the azimuth. False: u is
  /// the azimuth and v runs from the rim inwards.
  bool u_is_radial = false;
  std::optional<std::string> name;
  std::string material;
  std::optional<spec::Emission> emission;
  bool two_sided = false;
  SourcePosition where;
};

/// Reverses an emitting shape if the vertex normals are behind the triangles for most of their area, since
/// vertex normals decide which side is the front. Notes if normals are on both sides.
void orient_by_normals(const Mesh& mesh, ImportedShape& shape, SceneImporter& importer);

/// Container of a shape: the scene, or an object, which may not contain instances.
enum class ShapeOwner { scene, object };

/// Adds a shape transformed by its matrix:
/// - An analytic surface or a mesh file stays what it is if the matrix preserves its form.
/// - Triangles are added with transformed vertices.
/// - Any other surface becomes an object and an instance of it.
/// - If it emits or belongs to an object, it becomes triangles instead, which is noted.
/// Notes a medium inside a reversed shape. After a reflection the front is the reflected front.
void append_shape(ImportedShape shape, ShapeOwner owner, std::vector<spec::Shape>& shapes,
                  SceneImporter& importer);

/// Adds an instance of an object.
void append_instance(const std::string& object, const Imath::M44d& to_world, const SourcePosition& where,
                     SceneImporter& importer);

/// The surface of revolution of a polyline of points (r, z) about z, from azimuth 0 to `azimuth_deg`. Its
/// front is along (increasing azimuth) x (along the line). u follows the azimuth, v the line.
[[nodiscard]] spec::InlineMesh swept(const std::vector<Imath::V2d>& line, double azimuth_deg);
/// A triangulated sphere around z between the heights `low` and `high`.
[[nodiscard]] spec::InlineMesh swept_sphere(double radius, double low, double high, double azimuth_deg);

}  // namespace abbe::importers
