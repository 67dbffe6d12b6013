#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "description/load_context.h"
#include "description/meshes/mesh_file.h"
#include "io/schema/fields.h"
#include "scene/scene.h"

namespace abbe::description {

void read_materials(const JsonValue& json, LoadContext& context, Scene& scene);
/// Index of the material of that name; an unknown one is reported with the nearest.
[[nodiscard]] std::optional<std::uint32_t> find_material(const schema::Located<std::string>& name,
                                                         LoadContext& context, const Scene& scene);
/// Index of a mesh file's material in the scene, as "FILE:NAME"; what of it is lost is told in one warning.
[[nodiscard]] std::uint32_t add_file_material(const FileMaterial& material, const std::string& file,
                                              const SourcePosition& at, LoadContext& context, Scene& scene);
/// Index of the material of lamps that name none: diffuse, reflecting nothing.
[[nodiscard]] std::uint32_t black_material(LoadContext& context, Scene& scene);

}  // namespace abbe::description
