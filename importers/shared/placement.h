#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathMatrix.h>

#include "importers/shared/scene_importer.h"
#include "scene/shapes/shape.h"

// Matrices apply to row vectors, as everywhere in Abbe: p' = p M, with the translation in the last row.
namespace abbe::importers {

/// The matrix whose rows, written for column vectors, are 16 numbers. Missing numbers are those of the
/// identity.
[[nodiscard]] Imath::M44d from_rows(const std::vector<double>& rows);
/// A scaling along x, y and z by the factors `by`.
[[nodiscard]] Imath::M44d scaling(const Imath::V3d& by);
[[nodiscard]] Imath::M44d translation(const Imath::V3d& by);
/// A right-handed rotation by `deg` degrees about an axis through the origin, of any length except 0.
[[nodiscard]] Imath::M44d rotation(const Imath::V3d& axis, double deg);
/// Camera-to-world matrix of a view from one point to another, with z along the view, x along `up` x z and y
/// = z x x. Nothing if the view direction is zero or parallel to `up`.
[[nodiscard]] std::optional<Imath::M44d> looking_at(const Imath::V3d& from, const Imath::V3d& target,
                                                    const Imath::V3d& up);
/// True if the matrix changes handedness: the determinant of its linear part is negative.
[[nodiscard]] bool mirrors(const Imath::M44d& matrix);

/// The triangles of a PLY, OBJ or glTF file, without its materials.
struct MeshFileSurface {
  std::filesystem::path file;
};
/// A shape of the source scene.
struct ImportedShape {
  /// The surface in its own coordinates, before `to_world`.
  Joined<spec::MovableSurface, std::variant<MeshFileSurface>>::type surface;
  Imath::M44d to_world;   ///< Matrix to the written scene, or to the object that contains it.
  bool reversed = false;  ///< True if its front is the back of `surface`.
  /// Texture coordinates of a disc that is replaced by triangles. True: u is the distance from the center as
  /// a fraction of the radius, v the azimuth. False: u is the azimuth and v runs from the rim inwards.
  bool u_is_radial = false;
  std::optional<std::string> name;         ///< Name in the written scene; unnamed if absent.
  std::string material;                    ///< Name of a material of `SceneImporter::scene`.
  std::optional<spec::Emission> emission;  ///< Emission of the front; nothing if it does not emit.
  bool two_sided = false;                  ///< True if the back emits too.
  SourcePosition where;
};

/// Inverts `shape.reversed` if the vertex normals of its triangles `mesh` are behind them for most of their
/// area: vertex normals decide which side emits. Notes normals on both sides. Does nothing without such
/// normals, and for a shape that does not emit or is two-sided.
void orient_by_normals(const Mesh& mesh, ImportedShape& shape, SceneImporter& importer);

/// Container of a shape: the scene, or an object, which may not contain instances.
enum class ShapeOwner { scene, object };

/// Adds a shape, transformed by its matrix, to `shapes`, which belongs to an owner of the kind `owner`:
/// - An analytic surface or a mesh file stays what it is if the matrix preserves its form.
/// - Triangles are added with transformed vertices.
/// - Any other surface becomes an object of `importer.scene` and an instance of it.
/// - A surface of the last kind that emits or belongs to an object becomes triangles instead, which is noted.
/// After a reflection the front is the reflected front. Notes a medium inside a reversed shape. Triangles
/// without texture coordinates lose their images, which is noted. Reports a mesh file that cannot be read;
/// the shape may then be missing.
void append_shape(ImportedShape shape, ShapeOwner owner, std::vector<spec::Shape>& shapes,
                  SceneImporter& importer);

/// Adds an instance of the object called `object` to `importer.scene.shapes`. The name is not checked.
void append_instance(const std::string& object, const Imath::M44d& to_world, const SourcePosition& where,
                     SceneImporter& importer);

using spec::swept;
using spec::swept_sphere;

}  // namespace abbe::importers
