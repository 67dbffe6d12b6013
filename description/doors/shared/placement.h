#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <ImathMatrix.h>

#include "description/doors/shared/door.h"
#include "scene/shapes/shape.h"

// Matrices are for row vectors, as everywhere in the tree.
namespace abbe::doors {

/// The matrix of 16 numbers, rows one after the other, for column vectors.
[[nodiscard]] Imath::M44d from_rows(const std::vector<double>& rows);
/// The matrix by which space is scaled along the axes.
[[nodiscard]] Imath::M44d scaling(const Imath::V3d& by);
[[nodiscard]] Imath::M44d translation(const Imath::V3d& by);
/// A right-handed rotation about an axis that is not 0.
[[nodiscard]] Imath::M44d rotation(const Imath::V3d& axis, double deg);
/// Whether it turns right hands into left ones.
[[nodiscard]] bool mirrors(const Imath::M44d& matrix);

/// A mesh file as it is.
struct MeshFileSurface {
  std::filesystem::path file;
};
/// A shape of another renderer's scene.
struct GivenShape {
  std::variant<spec::Sphere, spec::Disc, spec::Quad, spec::InlineMesh, MeshFileSurface> surface;
  Imath::M44d to_world;
  bool turned = false;  ///< Whether its front is where the surface's back is.
  /// Whether u of a disc is the distance from its middle and v the azimuth, not u the azimuth and v from the
  /// rim inwards.
  bool u_outwards = false;
  std::optional<std::string> name;
  std::string material;
  std::optional<spec::Emission> emission;
  bool two_sided = false;
  SourcePosition where;
};

/// Turns a shape that emits where the normals at the corners of its triangles are behind most of their area:
/// they say there which side is the front. That they are on both sides is noted.
void heed_normals(const Mesh& mesh, GivenShape& given, Door& door);

/// Whether shapes are of the scene, or of an object, where none may be an instance.
enum class Among { scene, object };

/// Adds the shape where its matrix puts it: analytic surfaces as they are where the matrix keeps their form,
/// triangles with their vertices moved, all else as an object of its own and an instance of it; what emits or
/// is of an object, and cannot stay what it is, becomes triangles, which is noted, as is matter within what
/// is turned. In a mirror the front stays the image of the front.
void place(GivenShape shape, Among among, std::vector<spec::Shape>& shapes, Door& door);

/// Adds an instance of an object.
void place_instance(const std::string& object, const Imath::M44d& to_world, const SourcePosition& where,
                    Door& door);

/// The surface that a line of points (r, z) sweeps around z, from the azimuth 0 to that angle [degrees]; its
/// front is where (increasing azimuth) x (along the line) points. u runs with the azimuth, v along the line.
[[nodiscard]] spec::InlineMesh swept(const std::vector<Imath::V2d>& line, double azimuth_deg);
/// A sphere of triangles between two heights, around z.
[[nodiscard]] spec::InlineMesh swept_sphere(double radius, double low, double high, double azimuth_deg);

}  // namespace abbe::doors
