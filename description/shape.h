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

/// The triangles of a file that it makes of one of its own materials.
struct MeshPart {
  schema::Located<std::string> file;
  schema::Located<std::string> of_material;
};
/// A file, a part of one, or triangles.
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
using MeshBody =
    Body<Mesh, std::optional<MaterialName>, MeshEmission>;  ///< Of the file's material when absent.
using PrismBody = Body<Prism, MaterialName, MeshEmission>;
template <typename Surface>
using PlainBody = Body<Surface, MaterialName, LampEmission>;
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
/// Shapes for instances to place.
struct Object {
  std::vector<Shape> shapes;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Shape>);
[[nodiscard]] schema::Fields fields(schema::Tag<Object>);

}  // namespace abbe::spec

namespace abbe::description {

/// A shape as read, in metres.
struct NamedShape {
  std::string name;
  PlainShape shape;
  std::uint32_t material;
};

/// Makes a mesh the surface of the matter that its material may be: closed, facing outward, without vertex
/// normals. Says what it puts right, and what it cannot as what strictness refuses; `name` is that of the
/// mesh there.
void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context);

/// The parts of a shape that is no instance, placed: of a mesh file, one for each material. None after an
/// error.
[[nodiscard]] std::vector<NamedShape> build_parts(const spec::Shape& shape, const std::string& name,
                                                  LoadContext& context, Scene& scene);
/// What a shape emits, if it does.
[[nodiscard]] const spec::Emission* emission_of(const spec::Shape& shape);
/// The patches of a chart in the order of its table, then what surrounds them. None after an error.
[[nodiscard]] std::vector<NamedShape> build(const spec::Chart& chart, const std::string& name,
                                            LoadContext& context, Scene& scene);
void build_shapes(const std::vector<spec::Shape>& shapes, LoadContext& context, Scene& scene);
void build_objects(const std::vector<schema::Named<spec::Object>>& objects, LoadContext& context,
                   Scene& scene);
/// Adds the shapes of an object, placed, in motion.
void add_instance(const spec::Instance& instance, const Moving& moving, const std::string& name,
                  LoadContext& context, Scene& scene);
/// The shape where it is when the shutter opens; one that moves, or keeps axes, is the one of a prototype.
/// What `emits` and stands still is a shape by itself, since places on it are drawn.
[[nodiscard]] abbe::Shape in_motion(PlainShape shape, bool emits, const Material& material,
                                    const Moving& moving, LoadContext& context);

void shift(Mesh& mesh, const Imath::V3d& by);
void shift(Sphere& sphere, const Imath::V3d& by);
void shift(Disc& disc, const Imath::V3d& by);
void shift(Quad& quad, const Imath::V3d& by);
/// Leaves a placed shape where it is: instances may share their placements, which are moved once each.
void shift(PlacedShape& placed, const Imath::V3d& by);

}  // namespace abbe::description
