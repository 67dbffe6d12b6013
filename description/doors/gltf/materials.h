#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "description/doors/gltf/document.h"

namespace abbe::doors::gltf {

/// What the reader of meshes calls the materials, and last what has none.
[[nodiscard]] std::vector<std::string> names_of_materials(const Document& document);

/// The material: a metallic and rough surface, or, where it transmits, glass, a pane of it without a volume.
/// What has no counterpart is noted.
[[nodiscard]] spec::Material material_of(const JsonValue* material, const SourcePosition& where,
                                         const Document& document);

/// What a material sends out, if it does.
[[nodiscard]] std::optional<spec::Emission> emission_of(const JsonValue* material, const Document& document);

}  // namespace abbe::doors::gltf
