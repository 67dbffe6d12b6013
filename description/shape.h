#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "description/emission.h"
#include "description/load_context.h"
#include "description/motion.h"
#include "description/surface.h"
#include "description/transform.h"
#include "scene/scene.h"

namespace abbe::spec {

/// The triangles of a mesh file to which the file gives one of its own materials.
struct MeshPart {
  schema::Located<std::string> file;         ///< An OBJ, glTF 2.0 or GLB file.
  schema::Located<std::string> of_material;  ///< Name of the material in the file.
};
/// A mesh: the name of a file, a part of a file, or triangles.
struct Mesh : schema::Located<std::variant<std::string, MeshPart, InlineMesh>> {};
/// Name of a material of the scene file.
using MaterialName = schema::Located<std::string>;
/// A shape of one material.
template <typename Surface, typename Material, typename Emission>
struct Body {
  Surface surface;
  Material material;                  ///< Name of its material.
  std::vector<Similarity> transform;  ///< Steps of its transform, of which the first is applied first.
  std::optional<Emission> emission;   ///< Emission of its front; none if absent.
  bool two_sided = false;             ///< True if its back emits too.
};
using MeshBody = Body<Mesh, std::optional<MaterialName>, MeshEmission>;  ///< Material of the file if absent.
/// A shape whose irradiance on an axis is not a formula, so that its emission cannot be given by that.
template <typename Surface>
using SolidBody = Body<Surface, MaterialName, MeshEmission>;
/// A `PlainSurface` as a shape.
template <typename Surface>
using PlainBody = Body<Surface, MaterialName, AreaLightEmission>;
/// A colour chart of six patches a row. It faces edge_u x edge_v, the side of the reader.
struct Chart {
  /// A table with one patch per column, row by row from the top left.
  schema::Located<std::string> reflectances;
  Imath::V3d corner{0, 0, 0};     ///< Lower left corner for the reader [scene units].
  Imath::V3d edge_u{0, 0, 0};     ///< Edge from the corner along the rows.
  Imath::V3d edge_v{0, 0, 0};     ///< Edge from the corner upwards.
  std::optional<Curve> surround;  ///< Reflectance of the surround; 0.035 if absent.
  SourcePosition where;
};
/// A colour chart with its transform.
struct ChartShape {
  Chart chart;
  std::vector<Similarity> transform;
};
/// An object placed in the scene.
struct Instance {
  schema::Located<std::string> of;                 ///< Name of the object.
  schema::Located<std::vector<Affine>> transform;  ///< Steps, of which the first is applied first.
  SourcePosition where;
};
/// A shape of a scene file. `std::monostate` means that none has been read.
struct Shape {
  std::optional<std::string> name;  ///< If absent, messages call it "shape N", counted from 0.
  Joined<std::variant<std::monostate, MeshBody>, Each<PlainBody, PlainSurface>::type,
         Each<SolidBody, SolidSurface>::type, std::variant<ChartShape, Instance>>::type kind;
  SourcePosition where;
  std::optional<Motion> motion = {};  ///< Motion relative to the described pose; at rest if absent.
};
/// Shapes that appear only through instances. They may be neither instances nor charts, and neither emit nor
/// move.
struct Object {
  std::vector<Shape> shapes;
};
// Key tables and forms by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Shape>);
[[nodiscard]] schema::Fields fields(schema::Tag<Object>);

}  // namespace abbe::spec

namespace abbe::description {

// Functions report errors to `context.diagnostics`. Those that read files throw Error{resource} if the memory
// limit of `context.inputs` is exceeded.

/// A shape in metres, in the coordinates of the scene file.
struct NamedShape {
  std::string name;
  PlainShape shape;
  std::uint32_t material;  ///< Index in `Scene::materials`.
};

/// Prepares a mesh with `material` for rendering. If that has a medium inside, repeated triangles are removed
/// and the winding is made consistent and outward, with a warning, and vertex normals are dropped. A mesh
/// that is not closed after that is a warning, or an error if the diagnostics are strict; so are dropped
/// vertex normals of an interface. Any other mesh only loses `slivers`, its triangles of zero area. `name` is
/// the name of the mesh in messages, which are reported at `where`.
void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context);

/// Builds the parts of a shape, with its transform but not its motion applied. A mesh file without a material
/// in the scene has one part for each of its own materials, which are added to `scene`. A chart has one part
/// for each patch and one for the surround. Empty after an error, and for an instance.
[[nodiscard]] std::vector<NamedShape> build_parts(const spec::Shape& shape, const std::string& name,
                                                  LoadContext& context, Scene& scene);
/// Emission of a shape, as a pointer into it; nullptr if it does not emit.
[[nodiscard]] const spec::Emission* emission_of(const spec::Shape& shape);
/// Builds a colour chart, without its transform: the patches in the order of its table, then the surround.
/// Adds their materials to `scene`. Empty after an error: a table that cannot be read, or parallel edges.
[[nodiscard]] std::vector<NamedShape> build(const spec::Chart& chart, const std::string& name,
                                            LoadContext& context, Scene& scene);
/// Adds all shapes to `scene.shapes`, charts also to `scene.charts` and emitters to `scene.lights`. Materials
/// and objects must have been built. A shape that cannot be built is left out.
void build_shapes(const std::vector<spec::Shape>& shapes, LoadContext& context, Scene& scene);
/// Builds the objects that instances place, into `context.objects`. Materials must have been built. Reports
/// shapes that an object may not contain.
void build_objects(const std::vector<schema::Named<spec::Object>>& objects, LoadContext& context,
                   Scene& scene);
/// Adds the parts of an object to `scene.shapes`, at the placement of the instance called `name` and with the
/// motion `moving`. Reports a malformed transform and an unknown object, and adds nothing then.
void add_instance(const spec::Instance& instance, const PoseAndMotion& moving, const std::string& name,
                  LoadContext& context, Scene& scene);
/// Shape at its pose when the shutter opens. A moving shape becomes an instance of a prototype around its
/// center. So does a shape at rest whose geometry alone would lose the axes of its description: a rotated
/// sphere or disc, or a displaced medium with a grid. An emitter (`emits`) that does not move stays a plain
/// shape, because lights sample positions on it. `context.placements` records the instance, to be recentred
/// with the scene.
[[nodiscard]] abbe::Shape shape_at_opening(PlainShape shape, bool emits, const Material& material,
                                           const PoseAndMotion& moving, LoadContext& context);

}  // namespace abbe::description
