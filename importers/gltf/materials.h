#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "importers/gltf/document.h"

namespace abbe::importers::gltf {

// Errors go to `document.importer.diagnostics`; approximations and losses go to `SceneImporter::note`.

/// Distinct names of the file's materials, in its order, as the mesh reader gives them. The last name is that
/// of primitives without a material.
[[nodiscard]] std::vector<std::string> material_names(const Document& document);

/// Converts a material; nullptr is the default material of the format. The result is one of:
/// - a principled surface for metallic-roughness;
/// - a dielectric if it transmits and has a volume with a thickness above 0;
/// - thin glass if it transmits without such a volume.
/// `where` is the position for notes. Notes what Abbe cannot represent. Reports values of wrong types and
/// image files that are missing; the result then has defaults in their place.
[[nodiscard]] spec::Material material_of(const JsonValue* material, const SourcePosition& where,
                                         const Document& document);

/// The emission of a material: `emissiveFactor` times D65, with `emissiveStrength` as the luminance [cd/m2]
/// of white. Nothing if the factor is 0 or `material` is nullptr.
[[nodiscard]] std::optional<spec::Emission> emission_of(const JsonValue* material, const Document& document);

}  // namespace abbe::importers::gltf
