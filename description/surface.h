#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/shapes/shape.h"

namespace abbe::spec {

struct Sphere {
  Imath::V3d center{0, 0, 0};
  double radius = 0;
};
struct Disc {
  Imath::V3d center{0, 0, 0};
  Imath::V3d normal{0, 0, 0};
  double radius = 0;
};
struct Quad {
  Imath::V3d corner{0, 0, 0};
  Imath::V3d edge_u{0, 0, 0};
  Imath::V3d edge_v{0, 0, 0};
  SourcePosition where;
};
struct Prism {
  double apex_deg = 0;
  double side = 0;
  double length = 0;
};
/// Triangles given in the scene file itself.
struct InlineMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> uv;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Sphere>);
[[nodiscard]] schema::Fields fields(schema::Tag<Disc>);
[[nodiscard]] schema::Fields fields(schema::Tag<Quad>);
[[nodiscard]] schema::Fields fields(schema::Tag<Prism>);
[[nodiscard]] schema::Fields fields(schema::Tag<InlineMesh>);

}  // namespace abbe::spec

namespace abbe::description {

// Each `build` returns the surface in metres, before its transform.
[[nodiscard]] Sphere build(const spec::Sphere& sphere, const LoadContext& context);
[[nodiscard]] Disc build(const spec::Disc& disc, const LoadContext& context);
/// Returns nothing after an error: parallel edges.
[[nodiscard]] std::optional<Quad> build(const spec::Quad& quad, const LoadContext& context);
[[nodiscard]] Mesh build(const spec::Prism& prism, const LoadContext& context);
/// Returns nothing after an error: a triangle with a vertex that does not exist, or texture coordinates that
/// do not match the vertices in number.
[[nodiscard]] std::optional<Mesh> build(const spec::InlineMesh& mesh, const LoadContext& context);

}  // namespace abbe::description
