#include "description/shape.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr char kTransform[] = "Where the shape is moved, by steps in order.";

// What all shapes of a material have beside their own key.
template <typename S>
Fields describe_shape(std::string_view name, Field own) {
  using E = typename decltype(S::emission)::value_type;
  return describe<S>(
      name, "",
      {std::move(own),
       field("material", &S::material, text(),
             "Name of its material; an OBJ or glTF mesh may bring its own."),
       field("transform", &S::transform, similarity_steps(), kTransform).or_default(),
       field("emission", &S::emission, thing<E>(), "What its surface sends out."),
       field("two_sided", &S::two_sided, boolean(), "Whether it emits from both sides.").or_default()});
}

Kind mesh() {
  return forms<Mesh::Wrapped>("mesh", "a mesh", form<std::string>(Json::text, text()),
                              form<InlineMesh>(Json::any, thing<InlineMesh>()));
}

}  // namespace

static const Fields& fields(Tag<MeshShape>) {
  static const Fields kFields = describe_shape<MeshShape>(
      "mesh_shape",
      field("mesh", &MeshShape::mesh, mesh(), "The shape is a PLY, OBJ, glTF or GLB file, or triangles."));
  return kFields;
}
static const Fields& fields(Tag<SurfaceShape<Sphere>>) {
  using S = SurfaceShape<Sphere>;
  static const Fields kFields = describe_shape<S>(
      "sphere_shape", field("sphere", &S::surface, thing<Sphere>(), "The shape is a sphere."));
  return kFields;
}
static const Fields& fields(Tag<SurfaceShape<Disc>>) {
  using S = SurfaceShape<Disc>;
  static const Fields kFields =
      describe_shape<S>("disc_shape", field("disc", &S::surface, thing<Disc>(), "The shape is a disc."));
  return kFields;
}
static const Fields& fields(Tag<SurfaceShape<Quad>>) {
  using S = SurfaceShape<Quad>;
  static const Fields kFields = describe_shape<S>(
      "quad_shape", field("quad", &S::surface, thing<Quad>(), "The shape is a parallelogram."));
  return kFields;
}
static const Fields& fields(Tag<PrismShape>) {
  static const Fields kFields = describe_shape<PrismShape>(
      "prism_shape", field("prism", &PrismShape::prism, thing<Prism>(), "The shape is a prism."));
  return kFields;
}

static const Fields& fields(Tag<Chart>) {
  static const Fields kFields = describe<Chart>(
      "chart", "A colour chart: six patches a row, from the top left, on a dark surround.",
      {field("reflectances", &Chart::reflectances, text(),
             "A table of data/reflectance, or FILE.csv: a patch per column."),
       field("corner", &Chart::corner, point(), "Position of its lower left, as the reader sees it."),
       field("edge_u", &Chart::edge_u, point(), "Along the rows."),
       field("edge_v", &Chart::edge_v, point(), "Upwards."),
       field("surround", &Chart::surround, curve(), "Reflectance of its surround, 0.035 when absent.")});
  return kFields;
}
static const Fields& fields(Tag<ChartShape>) {
  static const Fields kFields = describe<ChartShape>(
      "chart_shape", "",
      {field("chart", &ChartShape::chart, thing<Chart>(), "The shape is a colour chart."),
       field("transform", &ChartShape::transform, similarity_steps(), kTransform).or_default()});
  return kFields;
}

static const Fields& fields(Tag<Instance>) {
  static const Fields kFields = describe<Instance>(
      "instance", "An object placed in the scene.",
      {field("of", &Instance::of, text(), "Name of the object."),
       field("transform", &Instance::transform, affine_steps(), "Where it is placed, by steps in order.")
           .or_default()});
  return kFields;
}

const Fields& fields(Tag<Shape>) {
  static const Fields kFields = describe<Shape>(
      "shape", "A shape.",
      {field("name", &Shape::name, text(), "For messages."),
       one_of(&Shape::kind, beside<MeshShape>("mesh"), beside<SurfaceShape<Sphere>>("sphere"),
              beside<SurfaceShape<Disc>>("disc"), beside<SurfaceShape<Quad>>("quad"),
              beside<PrismShape>("prism"), beside<ChartShape>("chart"),
              under<Instance>("instance", thing<Instance>(), "The shape is an object placed here."))});
  return kFields;
}

const Fields& fields(Tag<Object>) {
  static const Fields kFields =
      describe<Object>("object", "Shapes that appear only where an instance puts them.",
                       {field("shapes", &Object::shapes, list<Shape>(thing<Shape>(), "shapes", 1),
                              "Its shapes, of which none is an instance or a chart, and none emits.")});
  return kFields;
}

Kind shapes() {
  return list<Shape>(thing<Shape>(), "shapes", 0);
}
Kind objects() {
  return by_name<Object>(thing<Object>(), "an object of objects by name", 0);
}

}  // namespace abbe::spec
