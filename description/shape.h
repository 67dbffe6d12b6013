#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/load_context.h"
#include "io/object_reader.h"
#include "scene/scene.h"

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

/// The same as a shape of a scene.
[[nodiscard]] Shape as_shape(PlainShape shape);
/// The shape of the kind `key`, such as "disc", before any transform; nothing after an error.
[[nodiscard]] std::optional<PlainShape> read_geometry(const JsonValue& json, std::string_view key,
                                                      LoadContext& context);
/// The shape of the kind `key`, placed; of a mesh file, one for each material. None after an error.
[[nodiscard]] std::vector<NamedShape> read_named_shapes(ObjectReader& reader, std::string_view key,
                                                        const std::string& name, LoadContext& context,
                                                        Scene& scene);
/// The patches of a chart in the order of its table, then what surrounds them. None after an error.
[[nodiscard]] std::vector<NamedShape> read_chart(const JsonValue& json, const std::string& name,
                                                 LoadContext& context, Scene& scene);
void read_shapes(const JsonValue& json, LoadContext& context, Scene& scene);

void shift(Mesh& mesh, const Imath::V3d& by);
void shift(Sphere& sphere, const Imath::V3d& by);
void shift(Disc& disc, const Imath::V3d& by);
void shift(Quad& quad, const Imath::V3d& by);
/// Leaves a placed shape where it is: instances may share their placements, which are moved once each.
void shift(PlacedShape& placed, const Imath::V3d& by);

}  // namespace abbe::description
