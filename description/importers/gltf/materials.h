#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "description/importers/gltf/document.h"

namespace abbe::importers::gltf {

/// Names of the materials as used by the mesh reader, and finally the name for primitives without a material.
[[nodiscard]] std::vector<std::string> material_names(const Document& document);

/// The material: a metallic-roughness surface or, if it transmits, a dielectric; without a volume, thin
/// glass. Notes what Abbe cannot represent.
[[nodiscard]] spec::Material material_of(const JsonValue* material, const SourcePosition& where,
                                         const Document& document);

/// The emission of a material; nothing if it does not emit.
[[nodiscard]] std::optional<spec::Emission> emission_of(const JsonValue* material, const Document& document);

}  // namespace abbe::importers::gltf
