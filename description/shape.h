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
  schema::Located<std::string> file;
  schema::Located<std::string> of_material;
};
/// A mesh: a file, a part of one, or triangles.
struct Mesh : schema::Located<std::variant<std::string, MeshPart, InlineMesh>> {};
using MaterialName = schema::Located<std::string>;
/// A shape of one material.
template <typename Surface, typename Material, typename Emission>
struct Body {
  Surface surface;
  Material material;
  std::vector<Similarity> transform;
  std::optional<Emission> emission;
  bool two_sided = false;
};
using MeshBody = Body<Mesh, std::optional<MaterialName>, MeshEmission>;  ///< Material of the file if absent.
using PrismBody = Body<Prism, MaterialName, MeshEmission>;
template <typename Surface>
using PlainBody = Body<Surface, MaterialName, AreaLightEmission>;
/// A colour chart.
struct Chart {
  schema::Located<std::string> reflectances;
  Imath::V3d corner{0, 0, 0};
  Imath::V3d edge_u{0, 0, 0};
  Imath::V3d edge_v{0, 0, 0};
  std::optional<Curve> surround;
  SourcePosition where;
};
struct ChartShape {
  Chart chart;
  std::vector<Similarity> transform;
};
struct Instance {
  schema::Located<std::string> of;
  schema::Located<std::vector<Affine>> transform;
  SourcePosition where;
};
struct Shape {
  std::optional<std::string> name;
  std::variant<std::monostate, MeshBody, PlainBody<Sphere>, PlainBody<Disc>, PlainBody<Quad>, PrismBody,
               ChartShape, Instance>
      kind;
  SourcePosition where;
  std::optional<Motion> motion = {};
};
/// Shapes that appear only through instances.
struct Object {
  std::vector<Shape> shapes;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Shape>);
[[nodiscard]] schema::Fields fields(schema::Tag<Object>);

}  // namespace abbe::spec

namespace abbe::description {

/// A shape in metres, with its name and material index.
struct NamedShape {
  std::string name;
  PlainShape shape;
  std::uint32_t material;
};

/// Prepares a mesh whose material has a medium inside. Removes repeated triangles and vertex normals, and
/// makes the winding consistent and outward, with a warning. A mesh that is not closed after that is a
/// warning, or an error with --strict. Other meshes only lose their zero-area triangles. `name` is the name
/// of the mesh in messages.
void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context);

/// Builds the parts of a shape that is not an instance, with its transform applied. A mesh file has one part
/// for each material. Empty after an error.
[[nodiscard]] std::vector<NamedShape> build_parts(const spec::Shape& shape, const std::string& name,
                                                  LoadContext& context, Scene& scene);
/// Emission of a shape; nullptr if it does not emit.
[[nodiscard]] const spec::Emission* emission_of(const spec::Shape& shape);
/// Builds a colour chart: the patches in the order of its table, then the surround. Empty after an error.
[[nodiscard]] std::vector<NamedShape> build(const spec::Chart& chart, const std::string& name,
                                            LoadContext& context, Scene& scene);
/// Adds all shapes to the scene.
void build_shapes(const std::vector<spec::Shape>& shapes, LoadContext& context, Scene& scene);
/// Builds the objects that instances place, into `context.objects`.
void build_objects(const std::vector<schema::Named<spec::Object>>& objects, LoadContext& context,
                   Scene& scene);
/// Adds the shapes of an object at the placement of the instance, with its motion.
void add_instance(const spec::Instance& instance, const PoseAndMotion& moving, const std::string& name,
                  LoadContext& context, Scene& scene);
/// Shape at its pose when the shutter opens. A moving shape becomes an instance of a prototype, and so does a
/// rotated shape whose geometry alone would lose its axes. An emitter that does not move stays a plain shape,
/// because lights sample positions on it.
[[nodiscard]] abbe::Shape shape_at_opening(PlainShape shape, bool emits, const Material& material,
                                           const PoseAndMotion& moving, LoadContext& context);

// Translate a shape by a vector [m].
void shift(Mesh& mesh, const Imath::V3d& by);
void shift(Sphere& sphere, const Imath::V3d& by);
void shift(Disc& disc, const Imath::V3d& by);
void shift(Quad& quad, const Imath::V3d& by);
/// Does nothing: instances may have a placement in common, and each placement is translated once elsewhere.
void shift(PlacedShape& placed, const Imath::V3d& by);

}  // namespace abbe::description
